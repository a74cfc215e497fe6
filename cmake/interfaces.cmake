# Messages, services and actions of the package.
add_message_files(FILES
  BodyPose.msg
  Case.msg
  CaseArray.msg
  CaseStep.msg
  Contact.msg
  ContactArray.msg
  ExecutorState.msg
  Octomap.msg
  PlacedObject.msg
  PlannedPush.msg
  PoseGaussian.msg
  PushConfiguration.msg
  PushPlan.msg
  PushReport.msg
  TagDetection.msg
  TagDetectionArray.msg
  TrackedObject.msg
  TrackedObjectArray.msg)
add_service_files(FILES ExportCases.srv ImportCases.srv Reset.srv SetPoses.srv)
add_action_files(FILES ExecutePush.action LearnObject.action PlanPush.action PushObject.action)
generate_messages(DEPENDENCIES actionlib_msgs geometry_msgs std_msgs)
