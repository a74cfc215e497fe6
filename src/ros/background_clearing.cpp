#include "casepush/ros/background_clearing.h"

#include <atomic>
#include <chrono>
#include <future>
#include <utility>

namespace casepush {
namespace {

class ClearingJob {
 public:
  ClearingJob(std::shared_ptr<const PushPlanner> planner,
              std::shared_ptr<const std::vector<Case>> cases, ClearingRequest request)
      : result_(std::async(
            std::launch::async, [this, planner = std::move(planner), cases = std::move(cases),
                                 request = std::move(request)] {
              return planner->clear(request, *cases, [this] { return stop_.load(); });
            })) {}
  ClearingJob(const ClearingJob&) = delete;
  ClearingJob& operator=(const ClearingJob&) = delete;
  ~ClearingJob() { stop_ = true; }  // The future waits for the thread.

  std::optional<ClearingResult> poll() {
    const bool is_done =
        result_.valid() && result_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    return is_done ? std::optional<ClearingResult>(result_.get()) : std::nullopt;
  }

 private:
  std::atomic<bool> stop_{false};
  std::future<ClearingResult> result_;
};

}  // namespace

BeginClearing searchInBackground(PlannerSource planner, CaseSource cases) {
  return [planner = std::move(planner),
          cases = std::move(cases)](const ClearingRequest& request) -> PendingClearing {
    return
        [job = std::make_shared<ClearingJob>(planner(), cases(), request)] { return job->poll(); };
  };
}

}  // namespace casepush
