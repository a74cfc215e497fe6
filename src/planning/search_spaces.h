#pragma once

#include <ompl/base/SpaceInformation.h>

#include <memory>
#include <mutex>
#include <vector>

#include "casepush/planning/push_checker.h"

namespace casepush {

/// OMPL's space of the object's poses on one map. To make one takes longer than many a search, so
/// they are kept and lent to one search at a time.
class SearchSpace {
 public:
  /// @param columns  Whose extent bounds it.
  explicit SearchSpace(const CollisionChecker::Columns& columns);
  SearchSpace(const SearchSpace&) = delete;
  SearchSpace& operator=(const SearchSpace&) = delete;

  /// Whose isFree() tells which poses are valid. Must outlive all that is asked from then on.
  void use(PushChecker* checker) { checker_ = checker; }

  const ompl::base::SpaceInformationPtr& information() const { return information_; }

 private:
  PushChecker* checker_ = nullptr;
  ompl::base::SpaceInformationPtr information_;
};

/// The spaces of maps of one extent that nobody has borrowed. Thread-safe.
class SearchSpaces {
 public:
  std::unique_ptr<SearchSpace> borrow(const CollisionChecker::Columns& columns);
  void giveBack(std::unique_ptr<SearchSpace> space);

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<SearchSpace>> spaces_;
};

}  // namespace casepush
