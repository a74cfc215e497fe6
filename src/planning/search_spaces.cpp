#include "search_spaces.h"

#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/util/Console.h>

#include <utility>

#include "se2_state.h"

namespace casepush {

namespace ob = ompl::base;

SearchSpace::SearchSpace(const CollisionChecker::Columns& columns) {
  ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);  // It writes to where results go.
  ob::RealVectorBounds bounds(2);
  bounds.setLow(0, columns.origin_m.x());
  bounds.setLow(1, columns.origin_m.y());
  bounds.setHigh(0, columns.origin_m.x() + columns.width * columns.resolution_m);
  bounds.setHigh(1, columns.origin_m.y() + columns.height * columns.resolution_m);
  const auto se2 = std::make_shared<ob::SE2StateSpace>();
  se2->setBounds(bounds);
  information_ = std::make_shared<ob::SpaceInformation>(se2);
  information_->setStateValidityChecker(
      [this](const ob::State* state) { return checker_->isFree(poseOf(state)); });
  information_->setup();
}

std::unique_ptr<SearchSpace> SearchSpaces::borrow(const CollisionChecker::Columns& columns) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (spaces_.empty()) return std::make_unique<SearchSpace>(columns);
  std::unique_ptr<SearchSpace> space = std::move(spaces_.back());
  spaces_.pop_back();
  return space;
}

void SearchSpaces::giveBack(std::unique_ptr<SearchSpace> space) {
  const std::lock_guard<std::mutex> lock(mutex_);
  spaces_.push_back(std::move(space));
}

}  // namespace casepush
