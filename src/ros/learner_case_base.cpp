// How LearnerNode keeps the case base and shows it.
#include <casepush/PushCaseArray.h>

#include <algorithm>
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/ros/conversions.h"
#include "casepush/ros/learner_node.h"
#include "casepush/ros/markers.h"
#include "casepush/ros/names.h"
#include "casepush/ros/push_conversions.h"

namespace casepush {
namespace {

constexpr double kMarkersMoveM = 0.05;

}  // namespace

void LearnerNode::onReport(const ExecutedPush& message) {
  if (!message.adapted || message.case_id <= 0) {
    return;
  }
  try {
    const std::string notice = adaptBy(fromMessage(message));
    if (!notice.empty()) {
      ROS_WARN("%s", notice.c_str());
    }
    publishCases();
    noteStored("");
  } catch (const InputError& error) {
    ROS_ERROR("push report %u is not learnt from: %s", message.sequence, error.what());
    noteStored(error.what());
  }
}

void LearnerNode::noteStored(const std::string& failure) {
  const std::lock_guard<std::mutex> lock(base_mutex_);
  store_failure_ = failure;
}

std::string LearnerNode::adaptBy(const PushReport& report) {
  const std::lock_guard<std::mutex> lock(base_mutex_);
  return adapting_.learnFrom(report);
}

std::int64_t LearnerNode::addDemonstrated(const Case& push_case) {
  std::int64_t id = 0;
  {
    const std::lock_guard<std::mutex> lock(base_mutex_);
    Case demonstrated = push_case;
    demonstrated.context = adapting_.context(push_case.object);
    id = base_.add(demonstrated, std::nullopt, parameters_.adapting.floor);
  }
  publishCases();
  return id;
}

bool LearnerNode::onExport(ExportCases::Request& request, ExportCases::Response& response) {
  const std::lock_guard<std::mutex> lock(base_mutex_);
  try {
    base_.exportYaml(request.file);
    response.count = static_cast<std::uint32_t>(base_.count());
    response.success = true;
  } catch (const InputError& error) {
    response.message = error.what();
  }
  return true;
}

bool LearnerNode::onImport(ImportCases::Request& request, ImportCases::Response& response) {
  try {
    const std::lock_guard<std::mutex> lock(base_mutex_);
    response.count = static_cast<std::uint32_t>(base_.importYaml(request.file));
    response.success = true;
  } catch (const InputError& error) {
    response.message = error.what();
  }
  publishCases();
  return true;
}

void LearnerNode::publishCases() {
  {
    const std::lock_guard<std::mutex> lock(base_mutex_);
    cases_.publish(toMessage(adapting_.cases(), ros::Time::now().toSec()));
  }
  publishMarkers();
}

void LearnerNode::publishMarkersIfMoved() {
  std::unique_lock<std::mutex> lock(state_mutex_);
  const std::optional<ObjectState> object = objects_.find(shown_object_);
  const bool moved = object && distance(object->map_T_object, shown_at_) > kMarkersMoveM;
  lock.unlock();
  if (moved) {
    publishMarkers();
  }
}

void LearnerNode::publishMarkers() {
  std::unique_lock<std::mutex> lock(state_mutex_);
  const std::optional<ObjectState> object = objects_.find(shown_object_);
  if (!object) {
    return;
  }
  shown_at_ = object->map_T_object;
  lock.unlock();
  const std::lock_guard<std::mutex> base_lock(base_mutex_);
  markers_.publish(caseMarkers(adapting_.cases(object->model), object->map_T_object));
}

void LearnerNode::reportDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, server_.isActive() ? "learning"
                                                        : demonstrations_.isRecording()
                                                            ? "recording a demonstration"
                                                            : "idle");
  status.add("case base", parameters_.case_base);
  const std::lock_guard<std::mutex> lock(base_mutex_);
  status.add("cases", base_.count());
  if (!store_failure_.empty()) {
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::ERROR,
                        "the last push was not learnt from: " + store_failure_);
  }
  for (const auto& [object, number] : adapting_.noticed()) {
    status.mergeSummaryf(diagnostic_msgs::DiagnosticStatus::OK,
                         "%s: noticed change %d of load or floor", object.c_str(), number);
  }
}

}  // namespace casepush
