# Messages, services and actions of the package. Their names differ from those of the domain types:
# roscpp puts the generated classes into namespace casepush as well.
add_message_files(FILES
  AprilTagDetection.msg
  AprilTagDetectionArray.msg
  BodyContact.msg
  BodyContactArray.msg
  BodyPose.msg
  ExecutedPush.msg
  ExecutorState.msg
  ObjectGoal.msg
  ObjectLoad.msg
  ObjectLoadArray.msg
  ObjectPose.msg
  Octomap.msg
  Plan.msg
  PlanStep.msg
  Pose2DWithCovariance.msg
  PushCase.msg
  PushCaseArray.msg
  PushSample.msg
  PushableObject.msg
  PushableObjectArray.msg
  RearrangedObject.msg
  TaskSummary.msg
  TrialPush.msg)
add_service_files(FILES
  ExportCases.srv
  ImportCases.srv
  Reset.srv
  SaveMap.srv
  SetLoad.srv
  SetPoses.srv
  StartDemonstration.srv
  StepSimulation.srv
  StopDemonstration.srv)
add_action_files(FILES ExecutePush.action LearnObject.action PlanPush.action PushObject.action
                       Rearrange.action)
generate_messages(DEPENDENCIES actionlib_msgs geometry_msgs std_msgs)
