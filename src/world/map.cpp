#include "casepush/world/map.h"

#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "casepush/common/atomic_file.h"
#include "casepush/common/check.h"
#include "casepush/common/input_error.h"
#include "map_bounds.h"
#include "map_points.h"
#include "map_stream.h"

namespace casepush {
namespace {

std::string readWhole(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw InputError(file.string(), "there is no such map file");
  }
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  if (stream.peek() != std::ifstream::traits_type::eof()) content << stream.rdbuf();
  if (stream.bad() || !stream.is_open()) throw InputError(file.string(), "cannot be read");
  return content.str();
}

/// Compact form of a map: occupied or free, children alike merged.
octomap::OcTree compact(const octomap::OcTree& tree) {
  octomap::OcTree copy(tree);
  if (copy.size() > 0) {
    copy.toMaxLikelihood();
    copy.prune();
  }
  return copy;
}

/// Lowest corner and size of the leaf.
template <typename Iterator>
std::pair<Eigen::Vector3d, double> leafCorner(const Iterator& leaf, double resolution_m) {
  constexpr int kKeyOfZero = 32768;
  const octomap::OcTreeKey key = leaf.getIndexKey();
  const Eigen::Vector3d corner(int{key[0]} - kKeyOfZero, int{key[1]} - kKeyOfZero,
                               int{key[2]} - kKeyOfZero);
  return {corner * resolution_m, (1 << (16 - static_cast<int>(leaf.getDepth()))) * resolution_m};
}

}  // namespace

Map::Map(double resolution_m) {
  checkResolution(resolution_m, "map");
  tree_ = std::make_unique<octomap::OcTree>(resolution_m);
}

Map::Map(std::unique_ptr<octomap::OcTree> tree) : tree_(std::move(tree)) {}
Map::~Map() = default;
Map::Map(Map&&) noexcept = default;
Map& Map::operator=(Map&&) noexcept = default;

Map Map::load(const std::filesystem::path& file) {
  const std::string where = file.string();
  std::istringstream stream(readWhole(file));
  const MapHeader header = readMapHeader(stream, where);
  Map map(header.resolution_m);
  if (header.nodes == 0) throw InputError(where, "holds an empty map, must hold occupied space");
  const auto data = stream.tellg();
  const unsigned long nodes = countMapNodes(stream, header.binary, where);
  if (nodes != header.nodes) {
    throw InputError(where, "is damaged: it holds " + std::to_string(nodes) +
                                " nodes, its header says " + std::to_string(header.nodes));
  }
  stream.seekg(data);
  if (header.binary) {
    map.tree_->readBinaryData(stream);
  } else {
    map.tree_->readData(stream);
  }
  CASEPUSH_CHECK(map.tree_->calcNumNodes() == nodes, map.tree_->calcNumNodes() << " " << nodes);
  return map;
}

Map Map::fromBinary(double resolution_m, const std::vector<std::int8_t>& data) {
  const std::string where = "octomap message";
  checkResolution(resolution_m, where);
  Map map(resolution_m);
  if (data.empty()) return map;
  std::istringstream stream(std::string(data.begin(), data.end()));
  countMapNodes(stream, true, where);
  if (static_cast<std::size_t>(stream.tellg()) != data.size()) {
    throw InputError(where, "is damaged: it has " + std::to_string(data.size()) +
                                " bytes, its octree ends after " + std::to_string(stream.tellg()));
  }
  stream.seekg(0);
  map.tree_->readBinaryData(stream);
  return map;
}

std::vector<std::int8_t> Map::toBinary() const {
  if (empty()) return {};
  std::ostringstream stream;
  compact(*tree_).writeBinaryData(stream);
  const std::string bytes = stream.str();
  return {bytes.begin(), bytes.end()};
}

void Map::save(const std::filesystem::path& file) const {
  std::ostringstream stream;
  // OctoMap's own writeBinary() chats on stderr.
  const octomap::OcTree tree = compact(*tree_);
  stream << "# Octomap OcTree binary file\nid OcTree\nsize " << tree.size() << "\nres "
         << tree.getResolution() << "\ndata\n";
  if (!empty()) tree.writeBinaryData(stream);
  writeFileAtomically(file, stream.str());
}

void Map::addSurvey(const std::vector<Eigen::Vector3f>& map_points) {
  for (const auto& point : map_points) {
    octomap::OcTreeKey key;
    if (!point.allFinite() || !tree_->coordToKeyChecked(toOctomap(point), key)) {
      throw InputError("map survey", "point " + describe(point) + " is not finite or too far away");
    }
  }
  for (const auto& point : map_points) {
    tree_->setNodeValue(toOctomap(point), tree_->getClampingThresMaxLog(), true);
  }
  if (map_points.empty()) return;
  tree_->updateInnerOccupancy();
  tree_->prune();
}

Map Map::copy() const { return Map(std::make_unique<octomap::OcTree>(*tree_)); }

double Map::resolution() const { return tree_->getResolution(); }

bool Map::empty() const { return tree_->size() == 0; }

std::vector<Map::Voxel> Map::occupied() const {
  std::vector<Voxel> voxels;
  for (auto leaf = tree_->begin_leafs(); leaf != tree_->end_leafs(); ++leaf) {
    if (!tree_->isNodeOccupied(*leaf)) continue;
    const auto [corner, size] = leafCorner(leaf, resolution());
    const Eigen::Vector3d centre = corner.array() + size / 2.0;
    voxels.push_back({centre.cast<float>(), static_cast<float>(size)});
  }
  return voxels;
}

Eigen::Vector3d Map::min() const {
  CASEPUSH_CHECK(!empty(), "an empty map has no bounds");
  return knownCells(*tree_).low.cast<double>() * resolution();
}

Eigen::Vector3d Map::max() const {
  CASEPUSH_CHECK(!empty(), "an empty map has no bounds");
  return knownCells(*tree_).high.cast<double>() * resolution();
}

}  // namespace casepush
