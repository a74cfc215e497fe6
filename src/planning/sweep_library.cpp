#include "sweep_library.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <tuple>
#include <utility>

namespace casepush {
namespace {

/// What was not wanted for so many searches is forgotten.
constexpr std::uint64_t kKeptFor = 16;
constexpr double kNearlyFull = 0.75;
constexpr std::size_t kSteps = 2000;  // To make a sweep or free one, for Patience.

bool same(const std::vector<Pose2>& a, const std::vector<Pose2>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].x() != b[i].x() || a[i].y() != b[i].y() || a[i].yaw() != b[i].yaw()) return false;
  }
  return true;
}

bool same(const std::vector<Track>& a, const std::vector<Track>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].body != b[i].body || !same(a[i].start_T_body, b[i].start_T_body)) return false;
  }
  return true;
}

std::size_t hashOf(const std::vector<Track>& tracks) {
  std::size_t hash = 0;
  const auto mix = [&hash](double value) {
    hash = (hash ^ std::hash<double>{}(value)) * 0x9e3779b97f4a7c15ULL;
    hash ^= hash >> 29;
  };
  for (const Track& track : tracks) {
    for (const Pose2& pose : track.start_T_body) {
      mix(pose.x());
      mix(pose.y());
      mix(pose.yaw());
    }
  }
  return hash;
}

std::vector<Track> tracksOf(const PreparedCase& push_case,
                            const std::shared_ptr<const Footprint>& object,
                            const std::shared_ptr<const Footprint>& robot) {
  std::vector<Pose2> ends = push_case.start_T_sigma;
  ends.push_back(push_case.start_outcome.mean);
  return {{object, std::move(ends), Track::Kind::kSeparate},
          {robot, push_case.robot_path, Track::Kind::kPath},
          {object, push_case.object_path, Track::Kind::kPath}};
}

}  // namespace

SweepLibrary::Entry& SweepLibrary::entryOf(std::vector<Track> tracks,
                                           const std::shared_ptr<const HeightClasses>& classes) {
  const std::size_t hash = hashOf(tracks);
  const auto [first, last] = entries_.equal_range(hash);
  for (auto entry = first; entry != last; ++entry) {
    if (entry->second.classes == classes && same(entry->second.sweep->tracks(), tracks)) {
      return entry->second;
    }
  }
  Entry entry;
  entry.classes = classes;
  entry.sweep = std::make_shared<const Sweep>(std::move(tracks), classes, memory_);
  return entries_.emplace(hash, std::move(entry))->second;
}

void SweepLibrary::forgetUnused(const Patience& patience) {
  for (auto entry = entries_.begin(); entry != entries_.end() && !patience.isOver();) {
    const bool is_used = entry->second.last_use + kKeptFor >= uses_;
    if (!is_used) patience.isOverAfter(kSteps);
    entry = is_used ? std::next(entry) : entries_.erase(entry);
  }
}

void SweepLibrary::makeRoom(const Patience& patience) {
  std::vector<Entries::iterator> oldest;
  for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
    Entry& own = entry->second;
    const std::size_t bytes = own.sweep->bytes();
    if (bytes != own.bytes) own.last_growth = uses_;
    own.bytes = bytes;
    if (bytes > 0) oldest.push_back(entry);
  }
  const auto nearly_full = static_cast<std::size_t>(kNearlyFull * memory_->limit());
  if (memory_->used() < nearly_full) return;
  std::sort(oldest.begin(), oldest.end(), [](const auto& a, const auto& b) {
    return std::tie(a->second.last_use, a->second.last_growth) <
           std::tie(b->second.last_use, b->second.last_growth);
  });
  // What another search still works with is freed when that ends.
  std::size_t used = memory_->used();
  for (const auto& entry : oldest) {
    if (used <= memory_->limit() / 2 || patience.isOverAfter(kSteps)) break;
    used -= std::min(used, entry->second.bytes);
    Entry fresh = entry->second;
    fresh.sweep = std::make_shared<const Sweep>(fresh.sweep->tracks(), fresh.classes, memory_);
    fresh.bytes = 0;
    entry->second = std::move(fresh);
  }
}

bool SweepLibrary::attach(const std::shared_ptr<const HeightClasses>& classes,
                          const std::shared_ptr<const Footprint>& object,
                          const std::shared_ptr<const Footprint>& robot,
                          std::vector<PreparedCase>* cases, const Patience& patience) {
  const std::lock_guard<std::mutex> lock(mutex_);
  makeRoom(patience);
  ++uses_;
  for (PreparedCase& push_case : *cases) {
    if (patience.isOverAfter(kSteps)) return false;
    Entry& entry = entryOf(tracksOf(push_case, object, robot), classes);
    entry.last_use = uses_;
    push_case.sweep = entry.sweep;
  }
  forgetUnused(patience);
  return true;
}

}  // namespace casepush
