#include "room_landmarks.h"

#include <cstddef>
#include <limits>

#include "grid_flood.h"

namespace casepush {
namespace {

// A cell from which most of the room is reached, supposedly: the middle one of the widest.
int seedOf(const std::vector<HalfSteps>& half_steps) {
  std::vector<int> widest;
  int least = std::numeric_limits<std::uint8_t>::max();
  for (std::size_t cell = 0; cell < half_steps.size(); ++cell) {
    const int own = half_steps[cell].straight;
    if (own == 0 || own > least) continue;
    if (own < least) widest.clear();
    least = own;
    widest.push_back(static_cast<int>(cell));
  }
  return widest.empty() ? 0 : widest[widest.size() / 2];
}

}  // namespace

RoomLandmarks::RoomLandmarks(const std::vector<HalfSteps>& half_steps, int stride, int longest_step,
                             const Patience& patience)
    : lengths_(half_steps.size()) {
  constexpr std::size_t kSteps = 4;  // Of a cell with its neighbours.
  GridFlood flood(static_cast<int>(half_steps.size()), stride, longest_step);
  const auto spreadFrom = [&](int cell) {
    flood.clear();
    flood.begin(cell);
    flood.spread(
        [&half_steps](int from, int to, bool is_diagonal) {
          return HalfSteps::step(half_steps[from], half_steps[to], is_diagonal);
        },
        [&patience](int, int) { return !patience.isOverAfter(kSteps); });
  };
  const int seed = seedOf(half_steps);
  spreadFrom(seed);
  std::vector<int> apart = flood.distance();  // from the next landmark so far, or the seed
  for (int k = 0; k < kCount && !patience.isOver(); ++k) {
    int farthest = seed;
    for (std::size_t cell = 0; cell < apart.size(); ++cell) {
      if (apart[cell] != GridFlood::kUnreached && apart[cell] > apart[farthest]) {
        farthest = static_cast<int>(cell);
      }
    }
    spreadFrom(farthest);
    for (std::size_t cell = 0; cell < apart.size(); ++cell) {
      const int length = flood.distance()[cell];
      lengths_[cell][k] = std::min(length, kNoWay);
      apart[cell] = k == 0 ? length : std::min(apart[cell], length);
    }
  }
}

}  // namespace casepush
