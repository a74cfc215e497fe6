#include "casepush/model/world_model.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "casepush/common/input_error.h"
#include "yaml_pose.h"

namespace casepush {
namespace {

constexpr double kLargestCoordinate_m = 1000.0;
constexpr double kLargestExtent_m = 500.0;
constexpr double kLargestHeight_m = 100.0;

/// Reads one world; every name in it (boxes, objects, the robot) is taken once.
class WorldReader {
 public:
  explicit WorldReader(const std::filesystem::path& file)
      : reader_(YamlReader::fromFile(file)), folder_(file.parent_path()) {
    world_.name = file.stem().string();
    world_.file = file.string();
    names_.insert("robot");
  }

  WorldModel read() {
    readBounds(reader_.child("bounds"));
    if (std::optional<YamlReader> floor = reader_.optionalChild("floor")) {
      world_.floor.friction = floor->number("friction", 0.01, 2.0);
      world_.floor.rolling_lever_arm_m = floor->number("rolling_lever_arm_m", 0.0, 0.05);
      floor->finish();
    }
    for (YamlReader& entry : reader_.children("boxes")) {
      readBox(entry);
    }
    if (reader_.has("static_map")) {
      readStaticMap();
    }
    if (std::optional<YamlReader> cloud = reader_.optionalChild("point_cloud")) {
      readPointCloud(*cloud);
    }
    for (YamlReader& entry : reader_.children("objects")) {
      readObject(entry);
    }
    readRobot(reader_.child("robot"));
    if (std::optional<YamlReader> goal = reader_.optionalChild("goal")) {
      world_.goal = readPoseInside(*goal);
      goal->finish();
    }
    reader_.finish();
    return std::move(world_);
  }

 private:
  void readBounds(YamlReader reader) {
    const std::vector<double> min_m = reader.numbers("min", 2);
    const std::vector<double> max_m = reader.numbers("max", 2);
    reader.finish();
    for (int i = 0; i < 2; ++i) {
      const double extent_m = max_m[i] - min_m[i];
      if (extent_m < 0.5 || extent_m > kLargestExtent_m ||
          std::abs(min_m[i]) > kLargestCoordinate_m || std::abs(max_m[i]) > kLargestCoordinate_m) {
        throw InputError(reader.where(),
                         "max must exceed min by 0.5 m to 500 m, both within 1000 m of the origin");
      }
      world_.min_m(i) = min_m[i];
      world_.max_m(i) = max_m[i];
    }
  }

  void readBox(YamlReader& reader) {
    StaticBox box;
    box.name = takeName(reader, "name");
    const std::vector<double> size_m = reader.numbers("size_m", 3);
    const std::vector<double> xyz_m = reader.numbers("xyz", 3);
    box.box.size_m << size_m[0], size_m[1], size_m[2];
    if (box.box.size_m.minCoeff() <= 0.0 || box.box.size_m.maxCoeff() > kLargestExtent_m) {
      throw InputError(reader.where("size_m"), "must be above 0 and at most 500 m");
    }
    box.map_T_box.translation() << xyz_m[0], xyz_m[1], xyz_m[2];
    checkPlace(box, reader.where("xyz"));
    const double yaw_rad = reader.has("yaw_deg") ? readAngle(reader, "yaw_deg", -360, 360) : 0.0;
    box.map_T_box.rotate(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
    reader.finish();
    world_.boxes.push_back(std::move(box));
  }

  /// Boxes may stick out of the bounds, as walls do, but not stand elsewhere.
  void checkPlace(const StaticBox& box, const std::string& where) const {
    const Eigen::Vector3d& xyz_m = box.map_T_box.translation();
    const Eigen::Array2d grown_m = Eigen::Array2d::Constant(box.box.size_m.head<2>().maxCoeff());
    const Eigen::Array2d low_m = world_.min_m.array() - grown_m;
    const Eigen::Array2d high_m = world_.max_m.array() + grown_m;
    const Eigen::Array2d xy_m = xyz_m.head<2>().array();
    if ((xy_m < low_m).any() || (xy_m > high_m).any()) {
      std::ostringstream text;
      text << "(" << xy_m.x() << ", " << xy_m.y()
           << ") is far outside of the world; must be within (" << low_m.x() << ", " << low_m.y()
           << ") to (" << high_m.x() << ", " << high_m.y() << ")";
      throw InputError(where, text.str());
    }
    if (std::abs(xyz_m.z()) > kLargestHeight_m) {
      std::ostringstream text;
      text << "z is " << xyz_m.z() << "; must be within " << kLargestHeight_m << " m of 0";
      throw InputError(where, text.str());
    }
  }

  /// A relative path starts at the world's own folder.
  void readStaticMap() {
    const std::filesystem::path file = reader_.text("static_map");
    if (file.extension() != ".bt" && file.extension() != ".ot") {
      throw InputError(reader_.where("static_map"),
                       "is '" + file.string() + "'; must be an OctoMap file, .bt or .ot");
    }
    world_.static_map = folder_ / file;
  }

  void readPointCloud(YamlReader& reader) {
    PointCloudFile cloud;
    cloud.file = reader.text("file");
    if (cloud.file.extension() != ".pcd" && cloud.file.extension() != ".xyz") {
      throw InputError(reader.where("file"),
                       "is '" + cloud.file.string() + "'; must be a point cloud, .pcd or .xyz");
    }
    cloud.file = folder_ / cloud.file;
    cloud.resolution_m = reader.number("resolution_m", 0.01, 0.5, cloud.resolution_m);
    if (reader.has("height_m")) {
      const std::vector<double> height_m = reader.numbers("height_m", 2);
      cloud.low_m = height_m[0];
      cloud.high_m = height_m[1];
      if (!(0.0 <= cloud.low_m && cloud.low_m < cloud.high_m && cloud.high_m <= kLargestHeight_m)) {
        throw InputError(reader.where("height_m"),
                         "must be [low, high] with 0 <= low < high <= 100 m");
      }
    }
    reader.finish();
    world_.point_cloud = std::move(cloud);
  }

  void readObject(YamlReader& reader) {
    ObjectPlacement object;
    object.id = takeName(reader, "id");
    checkObjectId(object.id, reader.where("id"));
    object.model = reader.text("model");
    object.map_T_object = readPoseInside(reader);
    object.tag_offset = reader.integer("tag_offset", 0, 586, 0);
    if (std::optional<YamlReader> load = reader.optionalChild("load")) {
      object.load = readLoad(*load);
    }
    reader.finish();
    world_.objects.push_back(std::move(object));
  }

  /// Whether the object can carry it there is found out when both are put together.
  static Load readLoad(YamlReader& reader) {
    Load load;
    load.mass_kg = reader.number("mass_kg", 0.0, kLargestLoad_kg);
    const std::vector<double> xy_m = reader.numbers("xy", 2);
    load.object_p_centre_m << xy_m[0], xy_m[1];
    if (reader.has("height_m")) {
      load.height_m = reader.number("height_m", 0.0, kLargestHeight_m);
    }
    if (reader.has("size_m")) {
      const std::vector<double> size_m = reader.numbers("size_m", 3);
      load.size_m << size_m[0], size_m[1], size_m[2];
    }
    reader.finish();
    return load;
  }

  void readRobot(YamlReader reader) {
    world_.robot = reader.text("model");
    world_.map_T_robot = readPoseInside(reader);
    reader.finish();
  }

  Pose2 readPoseInside(YamlReader& reader) {
    const Pose2 pose = readPose2(reader);
    if (!world_.contains(pose)) {
      std::ostringstream text;
      text << "(" << pose.x() << ", " << pose.y() << ") is outside of the world; must be within ("
           << world_.min_m.x() << ", " << world_.min_m.y() << ") to (" << world_.max_m.x() << ", "
           << world_.max_m.y() << ")";
      throw InputError(reader.where("xy"), text.str());
    }
    return pose;
  }

  std::string takeName(YamlReader& reader, const std::string& key) {
    std::string name = reader.text(key);
    if (!names_.insert(name).second) {
      throw InputError(reader.where(key), "'" + name + "' is taken; names must differ");
    }
    return name;
  }

  YamlReader reader_;
  std::filesystem::path folder_;
  WorldModel world_;
  std::set<std::string> names_;
};

}  // namespace

bool WorldModel::contains(const Pose2& map_T_x) const {
  return map_T_x.isFinite() && map_T_x.x() >= min_m.x() && map_T_x.x() <= max_m.x() &&
         map_T_x.y() >= min_m.y() && map_T_x.y() <= max_m.y();
}

std::string WorldModel::where() const { return file.empty() ? "world " + name : file; }

void checkObjectId(const std::string& id, const std::string& where) {
  constexpr std::size_t kLongest = 64;
  const auto isPlain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  const bool good = !id.empty() && id.size() <= kLongest && isPlain(id.front()) &&
                    std::all_of(id.begin(), id.end(), [&](char c) {
                      return isPlain(c) || c == '_' || c == '-' || c == '.';
                    });
  if (!good) {
    std::string shown = id.substr(0, kLongest);  // On one line, whatever is in it.
    std::replace_if(
        shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    throw InputError(where, "'" + shown +
                                "' is no good id; must be 1 to 64 letters, digits, '_', '-' or "
                                "'.', the first a letter or digit");
  }
}

WorldModel loadWorldModel(const std::filesystem::path& yaml_file) {
  return WorldReader(yaml_file).read();
}

}  // namespace casepush
