#include "case_blobs.h"

#include <array>
#include <cstdint>
#include <cstring>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "stored numbers are little-endian");

constexpr std::size_t kWord = sizeof(double);

// FNV-1a over words instead of bytes; any change of one word changes it.
std::uint64_t checksum(const char* bytes, std::size_t size) {
  std::uint64_t sum = 0xcbf29ce484222325;
  for (std::size_t at = 0; at < size; at += kWord) {
    std::uint64_t word;
    std::memcpy(&word, bytes + at, kWord);
    sum = (sum ^ word) * 0x100000001b3;
    sum ^= sum >> 29;  // High bits would never reach the low ones.
  }
  return sum;
}

class Encoder {
 public:
  explicit Encoder(std::size_t numbers) { bytes_.reserve((numbers + 1) * kWord); }

  template <std::size_t n>
  void add(const std::array<double, n>& numbers) {
    bytes_.append(reinterpret_cast<const char*>(numbers.data()), n * kWord);
  }

  std::string finish() {
    const std::uint64_t sum = checksum(bytes_.data(), bytes_.size());
    bytes_.append(reinterpret_cast<const char*>(&sum), kWord);
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
};

[[noreturn]] void failDamaged(const std::string& where, std::size_t size) {
  throw InputError(where, "is damaged: " + std::to_string(size) +
                              " bytes that are not what was stored; restore a copy of the file");
}

// Size of the content without its checksum.
std::size_t checkedSize(const std::string& bytes, const std::string& where) {
  const std::size_t size = bytes.size() - kWord;
  std::uint64_t stored;
  if (bytes.size() < kWord || bytes.size() % kWord != 0) {
    failDamaged(where, bytes.size());
  }
  std::memcpy(&stored, bytes.data() + size, kWord);
  if (stored != checksum(bytes.data(), size)) {
    failDamaged(where, bytes.size());
  }
  return size;
}

template <std::size_t n, typename Add>
void decode(const char* bytes, std::size_t size, const std::string& where, const Add& add) {
  if (size % (n * kWord) != 0) {
    failDamaged(where, size);
  }
  for (std::size_t at = 0; at < size; at += n * kWord) {
    std::array<double, n> numbers;
    std::memcpy(numbers.data(), bytes + at, n * kWord);
    add(numbers);
  }
}

std::vector<CaseStep> decodeSteps(const char* bytes, std::size_t size, const std::string& where) {
  std::vector<CaseStep> steps;
  steps.reserve(size / (9 * kWord));
  decode<9>(bytes, size, where, [&](const std::array<double, 9>& n) {
    steps.push_back({Pose2(n[0], n[1], n[2]), Twist2{n[3], n[4], n[5]}, Pose2(n[6], n[7], n[8])});
  });
  return steps;
}

}  // namespace

std::string encodeSteps(const std::vector<CaseStep>& steps) {
  Encoder encoder(9 * steps.size());
  for (const CaseStep& step : steps) {
    const Pose2& r = step.object_T_robot;
    const Twist2& a = step.action;
    const Pose2& o = step.start_T_object;
    encoder.add<9>({r.x(), r.y(), r.yaw(), a.vx_mps, a.vy_mps, a.wz_rps, o.x(), o.y(), o.yaw()});
  }
  return encoder.finish();
}

std::vector<CaseStep> decodeSteps(const std::string& bytes, const std::string& where) {
  return decodeSteps(bytes.data(), checkedSize(bytes, where), where);
}

std::vector<CaseStep> decodeUncheckedSteps(const std::string& bytes, const std::string& where) {
  return decodeSteps(bytes.data(), bytes.size(), where);
}

std::string encodePath(const std::vector<Pose2>& path) {
  Encoder encoder(3 * path.size());
  for (const Pose2& pose : path) {
    encoder.add<3>({pose.x(), pose.y(), pose.yaw()});
  }
  return encoder.finish();
}

std::vector<Pose2> decodePath(const std::string& bytes, const std::string& where) {
  std::vector<Pose2> path;
  decode<3>(bytes.data(), checkedSize(bytes, where), where,
            [&](const std::array<double, 3>& n) { path.emplace_back(n[0], n[1], n[2]); });
  return path;
}

std::string encodeTube(const std::vector<PoseGaussian>& tube) {
  Encoder encoder(9 * tube.size());
  for (const PoseGaussian& step : tube) {
    const Pose2& m = step.mean;
    const Eigen::Matrix3d& c = step.covariance;
    encoder.add<9>({m.x(), m.y(), m.yaw(), c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)});
  }
  return encoder.finish();
}

std::vector<PoseGaussian> decodeTube(const std::string& bytes, const std::string& where) {
  std::vector<PoseGaussian> tube;
  tube.reserve(bytes.size() / (9 * kWord));
  decode<9>(bytes.data(), checkedSize(bytes, where), where, [&](const std::array<double, 9>& n) {
    PoseGaussian step{Pose2(n[0], n[1], n[2]), {}};
    step.covariance << n[3], n[4], n[5], n[4], n[6], n[7], n[5], n[7], n[8];
    tube.push_back(step);
  });
  return tube;
}

}  // namespace casepush
