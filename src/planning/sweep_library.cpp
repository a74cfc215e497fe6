#include "sweep_library.h"

#include <functional>
#include <utility>

namespace casepush {
namespace {

/// What was not wanted for so many searches is forgotten: masks of one sweep take half a megabyte.
constexpr std::uint64_t kKeptFor = 16;

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

void SweepLibrary::attach(const std::shared_ptr<const HeightClasses>& classes,
                          const std::shared_ptr<const Footprint>& object,
                          const std::shared_ptr<const Footprint>& robot,
                          std::vector<PreparedCase>* cases) {
  if (cases->size() > kMost) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  ++uses_;
  for (PreparedCase& push_case : *cases) {
    std::vector<Track> tracks = tracksOf(push_case, object, robot);
    const std::size_t hash = hashOf(tracks);
    const auto [first, last] = entries_.equal_range(hash);
    auto found = first;
    while (found != last &&
           !(found->second.classes == classes && same(found->second.sweep->tracks(), tracks))) {
      ++found;
    }
    if (found == last) {
      auto sweep = std::make_shared<const Sweep>(std::move(tracks), classes);
      found = entries_.emplace(hash, Entry{classes, std::move(sweep)});
    }
    found->second.last_use = uses_;
    push_case.sweep = found->second.sweep;
  }
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    entry = entry->second.last_use + kKeptFor < uses_ ? entries_.erase(entry) : std::next(entry);
  }
}

}  // namespace casepush
