#pragma once

#include <cstdint>

/// Every name that the nodes share: topics with their queue sizes, services, actions and frames.
/// docs/ros_api.md explains them.
namespace casepush::names {

struct Topic {
  const char* name;
  std::uint32_t queue_size;
};

// Sensors and actuator.
constexpr Topic kClock{"/clock", 10};
constexpr Topic kOdometry{"odom", 10};
constexpr Topic kTagDetections{"tag_detections", 100};
constexpr Topic kPoints{"points", 10};
constexpr Topic kSurvey{"survey", 1};  ///< Latched.
constexpr Topic kGrid{"map", 1};       ///< Latched.
constexpr Topic kCommandVelocity{"cmd_vel", 1};

// A person who drives.
constexpr Topic kJoy{"joy", 10};
constexpr Topic kTeleopVelocity{"teleop_cmd_vel", 1};

// Ground truth, for judging only.
constexpr Topic kTrueObjects{"ground_truth/objects", 10};
constexpr Topic kTrueLoads{"ground_truth/loads", 1};  ///< Latched.
constexpr Topic kContacts{"contacts", 100};

// What the robot knows.
constexpr Topic kObjects{"objects", 10};
constexpr Topic kCases{"cases", 1};          ///< Latched.
constexpr Topic kOctomap{"map/octomap", 1};  ///< Latched.
constexpr Topic kPlan{"plan", 1};            ///< Latched.
constexpr Topic kPushReports{"push_reports", 1000};
constexpr Topic kTaskSummaries{"task_summaries", 100};
constexpr Topic kExecutorState{"executor/state", 10};  ///< Latched.
constexpr Topic kStops{"executor/stops", 10};

// For RViz; all latched.
constexpr Topic kRobotMarkers{"robot/markers", 1};
constexpr Topic kObjectMarkers{"objects/markers", 1};
constexpr Topic kMapMarkers{"map/markers", 1};
constexpr Topic kCaseMarkers{"cases/markers", 1};
constexpr Topic kPlanMarkers{"plan/markers", 1};
constexpr Topic kTreeMarkers{"plan/tree", 1};

// Services.
constexpr const char* kResetService = "sim/reset";
constexpr const char* kSetPoseService = "sim/set_pose";
constexpr const char* kSetLoadService = "sim/set_load";
constexpr const char* kStepService = "sim/step";
constexpr const char* kStopService = "stop";
constexpr const char* kSaveMapService = "save_map";
constexpr const char* kExportCasesService = "cases/export";
constexpr const char* kImportCasesService = "cases/import";
constexpr const char* kStartDemonstrationService = "demonstration/start";
constexpr const char* kStopDemonstrationService = "demonstration/stop";

// Actions.
constexpr const char* kLearnObjectAction = "learn_object";
constexpr const char* kPlanPushAction = "plan_push";
constexpr const char* kPushObjectAction = "push_object";
constexpr const char* kRearrangeAction = "rearrange";
constexpr const char* kExecutePushAction = "execute_push";

// Frames (REP 105).
constexpr const char* kMapFrame = "map";
constexpr const char* kOdomFrame = "odom";
constexpr const char* kBaseFrame = "base_link";

}  // namespace casepush::names
