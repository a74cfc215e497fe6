#include "casepush/world/sweep.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include "casepush/common/check.h"
#include "sweep_hulls.h"
#include "sweep_mask.h"

namespace casepush {
namespace {

constexpr double kBin_rad = 2.0 * M_PI / Sweep::kHeadings;
constexpr int kMasks = Sweep::kHeadings / 4;
static_assert(Sweep::kHeadings == Footprint::kHeadings, "masks for the headings of footprints");

}  // namespace

struct Sweep::Data {
  std::vector<Track> tracks;
  std::vector<std::vector<Stop>> stops;  // of each track
  std::shared_ptr<const HeightClasses> classes;
  std::vector<SweptShape> covering;
  std::vector<SweptShape> covered;
  double resolution_m = 0.0;
  double reach_m = 0.0;
  std::mutex mutex;
  std::array<std::atomic<const SweepMask*>, kMasks> ready{};
  std::array<SweepMask::Pointer, kMasks> masks;
  std::optional<SweepHulls> hulls;
  std::atomic<std::size_t> bytes{0};

  std::shared_ptr<MaskMemory> memory;

  ~Data() {
    if (memory) memory->give(bytes);
  }

  void count(std::size_t added_bytes) {
    bytes += added_bytes;
    if (memory) memory->take(added_bytes);
  }

  const SweepMask* make(std::size_t bin) {
    const std::lock_guard<std::mutex> lock(mutex);
    if (masks[bin]) return masks[bin].get();
    if (memory && memory->isFull()) return nullptr;
    if (covering.empty()) {
      covering = coveringShapes(tracks, *classes);
      covered = coveredShapes(tracks, *classes);
      hulls.emplace(covering, resolution_m);
      count(bytesOf(covering) + bytesOf(covered) + hulls->bytes());
    }
    masks[bin] = makeSweepMask(covering, covered, classes->count(),
                               static_cast<double>(bin) * kBin_rad, kBin_rad / 2.0, resolution_m);
    count(masks[bin]->bytes());
    ready[bin].store(masks[bin].get(), std::memory_order_release);
    return masks[bin].get();
  }
};

Sweep::Sweep(std::vector<Track> tracks, std::shared_ptr<const HeightClasses> classes,
             std::shared_ptr<MaskMemory> memory)
    : data_(std::make_unique<Data>()) {
  CASEPUSH_CHECK(!tracks.empty(), "no tracks");
  data_->resolution_m = tracks.front().body->resolution();
  for (const Track& track : tracks) {
    CASEPUSH_CHECK(!track.start_T_body.empty(), "a track without poses");
    CASEPUSH_CHECK(track.body->resolution() == data_->resolution_m, "bodies of two resolutions");
    data_->stops.emplace_back();
    for (const Pose2& pose : track.start_T_body) {
      data_->stops.back().push_back({pose.position(), std::cos(pose.yaw()), std::sin(pose.yaw())});
      data_->reach_m = std::max(data_->reach_m, pose.position().norm() + track.body->reach());
    }
  }
  data_->tracks = std::move(tracks);
  data_->classes = std::move(classes);
  data_->memory = std::move(memory);
}

Sweep::~Sweep() = default;

const std::vector<Track>& Sweep::tracks() const { return data_->tracks; }

const std::vector<Sweep::Stop>& Sweep::stops(std::size_t track) const {
  return data_->stops[track];
}

const SweepHulls& Sweep::hulls() const { return *data_->hulls; }

std::size_t Sweep::bytes() const { return data_->bytes; }

double Sweep::reach() const { return data_->reach_m; }

int Sweep::heading(double yaw_rad) {
  // Shifted by whole turns to where rounding towards zero rounds down.
  const int heading = static_cast<int>(yaw_rad * (1.0 / kBin_rad) + (0.5 + 4 * kHeadings));
  return static_cast<int>(static_cast<unsigned>(heading) & (kHeadings - 1));
}

Sweep::Turned Sweep::mask(double yaw_rad) const {
  const auto at = static_cast<unsigned>(heading(yaw_rad));
  const unsigned bin = at % kMasks;
  const SweepMask* ready = data_->ready[bin].load(std::memory_order_acquire);
  return {ready != nullptr ? ready : data_->make(bin), static_cast<int>(at / kMasks)};
}

}  // namespace casepush
