#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <queue>
#include <utility>
#include <vector>

#include "casepush/model/push_plan.h"
#include "casepush/planning/clearance_field.h"
#include "casepush/world/sweep_checker.h"
#include "patience.h"

namespace casepush {

/// What an object's way to its goal is looked for with.
struct OutlineProblem {
  const SweepChecker& sweeps;  ///< With height classes that know the object.
  std::shared_ptr<const Footprint> object;
  double radius_m;  ///< Circumscribed about the object's origin.
  Pose2 map_T_start;
  Pose2 map_T_goal;
  GoalTolerance tolerance;
  double lenient_m;  ///< Nothing counts as occupied while the object is as near to its start.
  double step_m;     ///< From one pose of a push that has to be free to the next, at most,
  double step_rad;   ///< and by how much it turns meanwhile.
};

/// Looks for a way of an object's outline from start to goal region over cells of the map and 128
/// headings, whatever cases there are, with everything in the map and without obstacles.
///
/// It errs on one side only: a place and heading count as blocked where the object would overlap
/// something wherever in the cell it stood and whichever of the headings it had. So a gap must be
/// too narrow by more than about a cell for it to be noticed, and whatever pushes can do, the
/// search can. It goes on from both ends at once until they meet or one of them is shut in.
class OutlineFlood {
 public:
  /// All but the problem's values must outlive it.
  OutlineFlood(const OutlineProblem& problem, const ClearanceField& clearance,
               const Patience& patience);

  /// There is certainly no way. False also if patience or memory ran out.
  bool isShutOut() const { return shut_ >= 0; }
  /// Is it the start that no way leads out of, or the goal that none leads into? @pre isShutOut()
  bool isStartShutIn() const { return shut_ == kFromStart; }
  /// Does a way lead there from the end that is shut in? @pre isShutOut()
  bool hasReached(const Eigen::Vector2d& point_m) const;

 private:
  static constexpr int kFromStart = 0;
  static constexpr int kFromGoal = 1;

  /// One bit for each heading.
  struct Headings {
    std::array<std::uint64_t, 2> words{0, 0};

    bool any() const { return (words[0] | words[1]) != 0; }
    void set(int heading) { words[heading / 64] |= std::uint64_t{1} << heading % 64; }
    Headings turned(int by) const;  ///< By one, forth or back.
  };
  friend Headings operator&(const Headings& a, const Headings& b) {
    return {{a.words[0] & b.words[0], a.words[1] & b.words[1]}};
  }
  friend Headings operator|(const Headings& a, const Headings& b) {
    return {{a.words[0] | b.words[0], a.words[1] | b.words[1]}};
  }
  friend Headings operator~(const Headings& a) { return {{~a.words[0], ~a.words[1]}}; }

  struct Cell {
    bool is_known = false;
    Headings free;
    std::array<Headings, 2> reached;  ///< From either end.
    std::array<Headings, 2> waiting;  ///< Of those, what was not gone on from.
  };
  static constexpr int kPage = 16;
  using Page = std::array<Cell, kPage * kPage>;

  /// The cells to go on from, the nearest to the other end first.
  struct Front {
    Eigen::Vector2d towards_m;
    std::priority_queue<std::pair<float, int>, std::vector<std::pair<float, int>>, std::greater<>>
        cells;
  };

  void run();
  void beginAtStart();
  void beginAtGoal();
  void reach(int end, int x, int y, const Headings& headings);
  void advance(int end);
  Headings spread(Headings headings) const;
  Cell& at(int x, int y);
  Headings freeAt(int x, int y) const;
  Eigen::Vector2d centre(int x, int y) const;

  OutlineProblem problem_;
  const ClearanceField& clearance_;
  const Patience& patience_;
  const CollisionChecker::Columns& columns_;
  Sweep outline_;
  int step_cells_;
  int step_headings_;
  int pages_across_;
  std::vector<std::unique_ptr<Page>> pages_;
  std::array<Front, 2> fronts_;
  int known_cells_ = 0;
  bool met_ = false;
  int shut_ = -1;
};

}  // namespace casepush
