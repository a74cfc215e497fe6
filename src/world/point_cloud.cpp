#include "casepush/world/point_cloud.h"

#include <fstream>

#include "casepush/common/input_error.h"
#include "pcd_file.h"
#include "point_text.h"

namespace casepush {

std::vector<Eigen::Vector3f> loadPointCloud(const std::filesystem::path& file) {
  const std::string where = file.string();
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw InputError(where, "there is no such file");
  if (!std::filesystem::is_regular_file(file, error)) throw InputError(where, "is no regular file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(where, "cannot be read");
  std::vector<Eigen::Vector3f> points =
      file.extension() == ".pcd" ? readPcd(stream, where) : readXyz(stream, where);
  if (points.empty()) throw InputError(where, "holds no points");
  return points;
}

}  // namespace casepush
