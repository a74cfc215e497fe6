#include <cmath>
#include <fstream>
#include <istream>
#include <limits>

#include "casepush/common/input_error.h"
#include "casepush/common/yaml_reader.h"
#include "casepush/world/occupancy_grid.h"

namespace casepush {
namespace {

constexpr int kMostPixels = 1 << 14;  // along each side

/// Grey values, row by row from the top.
struct Image {
  int width = 0;
  int height = 0;
  int white = 0;
  std::vector<int> pixels;
};

/// The next number of a PGM header or of an ASCII image; # begins a comment.
int readNumber(std::istream& stream, const std::string& where, int low, int high) {
  stream >> std::ws;
  while (stream.peek() == '#') {
    stream.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    stream >> std::ws;
  }
  long value = 0;
  if (!(stream >> value)) throw InputError(where, "is truncated or damaged: a number is missing");
  if (value < low || value > high) {
    throw InputError(where, "is damaged: it has " + std::to_string(value) + " where " +
                                std::to_string(low) + " to " + std::to_string(high) +
                                " is expected");
  }
  return static_cast<int>(value);
}

Image readPgm(const std::filesystem::path& file) {
  const std::string where = file.string();
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw InputError(where, "there is no such image file");
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(where, "cannot be read");
  char magic[2] = {};
  stream.read(magic, 2);
  const bool binary = magic[1] == '5';
  if (!stream || magic[0] != 'P' || !(binary || magic[1] == '2')) {
    throw InputError(where, "is no grey image of type PGM (P2 or P5); convert it");
  }
  Image image;
  image.width = readNumber(stream, where, 1, kMostPixels);
  image.height = readNumber(stream, where, 1, kMostPixels);
  image.white = readNumber(stream, where, 1, 255);
  if (binary) stream.get();  // The one blank after the header.
  const std::size_t count = static_cast<std::size_t>(image.width) * image.height;
  if (binary) {
    std::vector<char> bytes(count);
    if (!stream.read(bytes.data(), static_cast<std::streamsize>(count))) {
      throw InputError(where, "is truncated: pixels are missing");
    }
    for (const char byte : bytes) image.pixels.push_back(static_cast<unsigned char>(byte));
  } else {
    for (std::size_t i = 0; i < count; ++i) {
      image.pixels.push_back(readNumber(stream, where, 0, image.white));
    }
  }
  return image;
}

/// What map_server makes of a pixel.
class PixelRule {
 public:
  explicit PixelRule(YamlReader& yaml)
      : mode_(yaml.text("mode", "trinary")),
        negate_(yaml.integer("negate", 0, 1, 0) == 1),
        occupied_(yaml.number("occupied_thresh", 0.0, 1.0, 0.65)),
        free_(yaml.number("free_thresh", 0.0, 1.0, 0.196)) {
    if (mode_ != "trinary" && mode_ != "scale" && mode_ != "raw") {
      throw InputError(yaml.where("mode"), "is '" + mode_ + "', must be trinary, scale or raw");
    }
    if (free_ > occupied_) {
      throw InputError(yaml.where("free_thresh"), "is greater than occupied_thresh");
    }
  }

  std::int8_t value(int pixel, int white) const {
    if (mode_ == "raw") return static_cast<std::int8_t>(pixel <= 100 ? pixel : -1);
    const double bright = static_cast<double>(pixel) / white;
    const double occupied = negate_ ? bright : 1.0 - bright;
    if (occupied > occupied_) return 100;
    if (occupied < free_) return 0;
    if (mode_ == "trinary") return -1;
    const double ratio = (occupied - free_) / (occupied_ - free_);
    return static_cast<std::int8_t>(1.0 + std::floor(98.0 * ratio));
  }

 private:
  std::string mode_;
  bool negate_;
  double occupied_;
  double free_;
};

}  // namespace

OccupancyGrid loadOccupancyGrid(const std::filesystem::path& yaml_file) {
  YamlReader yaml = YamlReader::fromFile(yaml_file);
  OccupancyGrid grid;
  const std::filesystem::path image_file = yaml_file.parent_path() / yaml.text("image");
  grid.resolution_m = yaml.number("resolution", 0.001, 10.0);
  const std::vector<double> origin = yaml.numbers("origin", 3);
  grid.map_T_grid = Pose2(origin[0], origin[1], origin[2]);
  const PixelRule rule(yaml);
  yaml.finish();
  const Image image = readPgm(image_file);
  grid.width = image.width;
  grid.height = image.height;
  grid.cells.reserve(image.pixels.size());
  for (int row = image.height - 1; row >= 0; --row) {
    for (int column = 0; column < image.width; ++column) {
      const int pixel = image.pixels[static_cast<std::size_t>(row) * image.width + column];
      grid.cells.push_back(rule.value(pixel, image.white));
    }
  }
  return grid;
}

}  // namespace casepush
