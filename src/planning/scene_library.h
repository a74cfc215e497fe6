#pragma once

#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "casepush/model/push_plan.h"
#include "casepush/world/sweep_checker.h"
#include "goal_guide.h"

namespace casepush {

/// What stands around, prepared for one object to be pushed.
struct Scene {
  SweepChecker sweeps;
  std::vector<HalfSteps> room;  ///< Of ObjectRoom::halfSteps().
};

/// Keeps the scenes of the last requests: most find everything where it was. Thread-safe.
class SceneLibrary {
 public:
  using Obstacles = std::vector<PlacedObject>;

  /// The scene for these very obstacles, from `make` if it is not known.
  std::shared_ptr<const Scene> get(const std::string& model, const Obstacles& obstacles,
                                   const std::function<Scene()>& make);

 private:
  static constexpr std::size_t kKept = 4;

  struct Entry {
    std::string model;
    Obstacles obstacles;
    std::shared_ptr<const Scene> scene;
  };

  std::mutex mutex_;
  std::list<Entry> entries_;  // The one used last comes first.
};

}  // namespace casepush
