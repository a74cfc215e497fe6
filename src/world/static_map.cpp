#include "casepush/world/static_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>

#include "casepush/common/input_error.h"
#include "casepush/world/point_cloud.h"

namespace casepush {
namespace {

constexpr std::int64_t kMostCells = std::int64_t{1} << 28;
constexpr double kTolerance_m = 1e-4;
using Cell = Eigen::Vector3i;

/// A block of cells: [low, high).
struct Block {
  Cell low{0, 0, 0};
  Cell high{0, 0, 0};

  std::int64_t volume() const { return (high - low).cast<std::int64_t>().prod(); }
};

/// The cells that a voxel covers and that count, in units of the map's resolution.
class Filter {
 public:
  Filter(const Map& map, const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m, double floor_m)
      : resolution_m_(map.resolution()) {
    for (int i = 0; i < 2; ++i) {
      low_(i) = static_cast<int>(std::ceil(min_m(i) / resolution_m_ - 0.5));
      high_(i) = static_cast<int>(std::floor(max_m(i) / resolution_m_ - 0.5)) + 1;
    }
    low_.z() = static_cast<int>(std::floor((floor_m + kTolerance_m) / resolution_m_));
    high_.z() = std::numeric_limits<int>::max();
  }

  Block blockOf(const Map::Voxel& voxel) const {
    const Eigen::Vector3d corner =
        voxel.centre_m.cast<double>().array() - 0.5 * static_cast<double>(voxel.size_m);
    const int size = static_cast<int>(std::lround(voxel.size_m / resolution_m_));
    Block block;
    block.low = (corner / resolution_m_).array().round().cast<int>();
    block.high = (block.low.array() + size).min(high_.array());
    block.low = block.low.cwiseMax(low_);
    return block;
  }

 private:
  double resolution_m_;
  Cell low_;
  Cell high_;
};

/// Occupied cells, from which blocks can be taken.
class Grid {
 public:
  explicit Grid(const Block& bounds)
      : bounds_(bounds),
        size_(bounds.high - bounds.low),
        filled_(static_cast<std::size_t>(bounds.volume()), false) {}

  void set(const Block& block, bool filled) {
    visit(block, [&](std::size_t index) {
      filled_[index] = filled;
      return true;
    });
  }

  bool isFull(const Block& block) const {
    const bool inside = (block.low.array() >= bounds_.low.array()).all() &&
                        (block.high.array() <= bounds_.high.array()).all();
    return inside && visit(block, [&](std::size_t index) { return filled_[index]; });
  }

  /// The largest of the blocks that grow from a cell axis by axis, in any order of the axes.
  Block growFrom(const Cell& cell) const {
    Block best{cell, cell.array() + 1};
    std::array<int, 3> order{0, 1, 2};
    do {
      Block block{cell, cell.array() + 1};
      for (const int axis : order) {
        Block next = block;
        for (;;) {
          next.low(axis) = block.high(axis);
          next.high(axis) = block.high(axis) + 1;
          if (!isFull(next)) break;
          ++block.high(axis);
        }
      }
      if (block.volume() > best.volume()) best = block;
    } while (std::next_permutation(order.begin(), order.end()));
    return best;
  }

  std::vector<Block> takeAll() {
    std::vector<Block> blocks;
    for (std::size_t index = 0; index < filled_.size(); ++index) {
      if (!filled_[index]) continue;
      const int rest = static_cast<int>(index % static_cast<std::size_t>(size_.x() * size_.y()));
      const int layer = static_cast<int>(index / static_cast<std::size_t>(size_.x() * size_.y()));
      const Cell cell = bounds_.low + Cell(rest % size_.x(), rest / size_.x(), layer);
      blocks.push_back(growFrom(cell));
      set(blocks.back(), false);
    }
    return blocks;
  }

 private:
  /// Calls `visitor(index)` for each cell until it returns false.
  template <typename Visitor>
  bool visit(const Block& block, const Visitor& visitor) const {
    for (int z = block.low.z(); z < block.high.z(); ++z) {
      for (int y = block.low.y(); y < block.high.y(); ++y) {
        for (int x = block.low.x(); x < block.high.x(); ++x) {
          const Cell c = Cell(x, y, z) - bounds_.low;
          const std::size_t row =
              static_cast<std::size_t>(c.z()) * static_cast<std::size_t>(size_.y()) +
              static_cast<std::size_t>(c.y());
          if (!visitor(row * static_cast<std::size_t>(size_.x()) +
                       static_cast<std::size_t>(c.x()))) {
            return false;
          }
        }
      }
    }
    return true;
  }

  Block bounds_;
  Cell size_;
  std::vector<bool> filled_;
};

std::vector<Block> countingBlocks(const Map& map, const Filter& filter) {
  std::vector<Block> blocks;
  for (const Map::Voxel& voxel : map.occupied()) {
    const Block block = filter.blockOf(voxel);
    if ((block.low.array() < block.high.array()).all()) blocks.push_back(block);
  }
  return blocks;
}

Block hull(const std::vector<Block>& blocks) {
  Block bounds = blocks.front();
  for (const Block& block : blocks) {
    bounds.low = bounds.low.cwiseMin(block.low);
    bounds.high = bounds.high.cwiseMax(block.high);
  }
  return bounds;
}

void addBoxes(WorldModel& world, const Map& map, double floor_m, const std::string& name,
              const std::filesystem::path& file) {
  const std::vector<StaticBox> boxes = boxesOf(map, world.min_m, world.max_m, name, floor_m);
  if (boxes.empty()) {
    throw InputError(file.string(), "holds nothing above the floor within the bounds of world " +
                                        world.name + "; is it in the same frame?");
  }
  std::set<std::string> names;
  for (const StaticBox& box : boxes) names.insert(box.name);
  for (const StaticBox& box : world.boxes) names.insert(box.name);
  for (const ObjectPlacement& object : world.objects) names.insert(object.id);
  if (names.size() != boxes.size() + world.boxes.size() + world.objects.size()) {
    throw InputError("world " + world.name,
                     "names like '" + name + "_1' are taken by its " +
                         (name == "static_map" ? "static map" : "point cloud") +
                         "; rename the others");
  }
  world.boxes.insert(world.boxes.end(), boxes.begin(), boxes.end());
}

}  // namespace

std::vector<StaticBox> boxesOf(const Map& map, const Eigen::Vector2d& min_m,
                               const Eigen::Vector2d& max_m, const std::string& name,
                               double floor_m) {
  const std::vector<Block> voxels = countingBlocks(map, Filter(map, min_m, max_m, floor_m));
  if (voxels.empty()) return {};
  const Block bounds = hull(voxels);
  if (bounds.volume() > kMostCells) {
    throw InputError(name, "spreads over " + std::to_string(bounds.volume()) +
                               " cells, must be at most " + std::to_string(kMostCells) +
                               "; use a coarser map or narrower bounds");
  }
  Grid grid(bounds);
  for (const Block& voxel : voxels) grid.set(voxel, true);
  std::vector<StaticBox> boxes;
  for (const Block& block : grid.takeAll()) {
    StaticBox box;
    box.name = name + "_" + std::to_string(boxes.size() + 1);
    box.box.size_m = (block.high - block.low).cast<double>() * map.resolution();
    box.map_T_box.translation() = (block.low + block.high).cast<double>() * map.resolution() / 2.0;
    boxes.push_back(std::move(box));
  }
  return boxes;
}

Map mapOf(const PointCloudFile& cloud, const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m) {
  std::vector<Eigen::Vector3f> points = loadPointCloud(cloud.file);
  const Eigen::AlignedBox3d wanted(Eigen::Vector3d(min_m.x(), min_m.y(), cloud.low_m),
                                   Eigen::Vector3d(max_m.x(), max_m.y(), cloud.high_m));
  points.erase(std::remove_if(points.begin(), points.end(),
                              [&](const Eigen::Vector3f& point) {
                                return !wanted.contains(point.cast<double>());
                              }),
               points.end());
  Map map(cloud.resolution_m);
  map.addSurvey(points);
  return map;
}

WorldModel withStaticMap(WorldModel world) {
  if (world.static_map) {
    const std::filesystem::path file = *world.static_map;
    world.static_map.reset();
    addBoxes(world, Map::load(file), 0.05, "static_map", file);
  }
  if (world.point_cloud) {
    const PointCloudFile cloud = *world.point_cloud;
    world.point_cloud.reset();
    addBoxes(world, mapOf(cloud, world.min_m, world.max_m), cloud.low_m, "point_cloud", cloud.file);
  }
  return world;
}

WorldModel loadWorld(const Catalog& catalog, const std::string& name_or_file) {
  return withStaticMap(catalog.world(name_or_file));
}

}  // namespace casepush
