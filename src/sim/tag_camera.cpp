#include "tag_camera.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "bullet_conversions.h"
#include "tag_pose.h"

namespace casepush::sim {
namespace {

constexpr double kTimeEpsilon_s = 1e-9;
// Nobody reads the images of a world that is only driven; they must not pile up.
constexpr std::size_t kMaxPending = 1000;
// Occlusion is tested this far in front of the tag, so that the face that carries it does not hide
// it, and at corners this much nearer to the centre.
constexpr double kInFront_m = 0.005;
constexpr double kInset = 0.9;
constexpr double kLeastNoise_px = 0.01;  // Keeps the covariance positive definite.

// Corners in the image, if the camera could see the tag in an empty world.
std::optional<Corners> cornersInImage(const CameraModel& camera, double size_m,
                                      const Eigen::Isometry3d& camera_T_tag) {
  const Eigen::Vector3d sight = camera_T_tag.translation();
  const double range_m = sight.norm();
  if (sight.z() <= 0.0 || range_m > camera.max_range_m) return std::nullopt;
  const double facing = camera_T_tag.linear().col(2).dot(sight) / range_m;
  if (facing < std::cos(camera.max_view_angle_rad)) return std::nullopt;
  const auto corners = tagCorners(size_m);
  Corners result;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d camera_p = camera_T_tag * corners[i];
    if (camera_p.z() <= 0.0) return std::nullopt;
    result[i] = project(camera, camera_p);
    const bool inside = result[i].x() >= 0.0 && result[i].x() <= camera.width_px &&
                        result[i].y() >= 0.0 && result[i].y() <= camera.height_px;
    if (!inside) return std::nullopt;
  }
  return result;
}

}  // namespace

TagCameras::TagCameras(const Scene& scene, bool noise, std::uint64_t seed)
    : scene_(scene),
      noise_(noise),
      random_(Random::stream(seed, "cameras")),
      images_taken_(scene.robot.cameras.size(), 0) {}

void TagCameras::update(double time_s, const PhysicsWorld& physics) {
  for (std::size_t i = 0; i < images_taken_.size(); ++i) {
    const CameraModel& camera = scene_.robot.cameras[i];
    if (time_s + kTimeEpsilon_s < static_cast<double>(images_taken_[i]) / camera.rate_hz) continue;
    // Counting from the clock keeps the rate when a step is longer than a period.
    images_taken_[i] =
        1 + static_cast<std::int64_t>(std::floor((time_s + kTimeEpsilon_s) * camera.rate_hz));
    if (pending_.size() >= kMaxPending) pending_.pop_front();
    pending_.push_back({time_s + camera.latency_s, capture(camera, time_s, physics)});
  }
}

std::vector<TagFrame> TagCameras::take(double time_s) {
  std::vector<TagFrame> frames;
  std::deque<Pending> later;
  for (Pending& pending : pending_) {
    if (pending.due_s <= time_s + kTimeEpsilon_s) {
      frames.push_back(std::move(pending.frame));
    } else {
      later.push_back(std::move(pending));
    }
  }
  pending_.swap(later);
  return frames;
}

bool TagCameras::isVisible(const Eigen::Isometry3d& map_T_camera,
                           const Eigen::Isometry3d& map_T_tag, double size_m,
                           const PhysicsWorld& physics) const {
  const Eigen::Vector3d eye = map_T_camera.translation();
  const Eigen::Vector3d in_front(0.0, 0.0, -kInFront_m);
  if (!physics.isClear(eye, map_T_tag * in_front)) return false;
  const auto corners = tagCorners(kInset * size_m);
  return std::all_of(corners.begin(), corners.end(), [&](const Eigen::Vector3d& corner) {
    return physics.isClear(eye, map_T_tag * (corner + in_front));
  });
}

TagFrame TagCameras::capture(const CameraModel& camera, double time_s,
                             const PhysicsWorld& physics) {
  TagFrame frame;
  frame.camera = camera.name;
  frame.stamp_s = time_s;
  const Eigen::Isometry3d map_T_camera = toSpatial(physics.robot().pose()) * camera.base_T_camera;
  const Eigen::Isometry3d camera_T_map = map_T_camera.inverse();
  for (const SceneTag& tag : scene_.tags) {
    const Eigen::Isometry3d map_T_tag =
        physics.furniture(tag.object).map_T_root() * tag.mount.object_T_tag;
    const Eigen::Isometry3d camera_T_tag = camera_T_map * map_T_tag;
    std::optional<Corners> corners = cornersInImage(camera, tag.mount.size_m, camera_T_tag);
    if (!corners || !isVisible(map_T_camera, map_T_tag, tag.mount.size_m, physics)) continue;
    if (noise_) {
      if (random_.chance(camera.dropout)) continue;
      for (Eigen::Vector2d& corner : *corners) {
        corner.x() += random_.normal(camera.corner_noise_px);
        corner.y() += random_.normal(camera.corner_noise_px);
      }
    }
    const TagPoseEstimate estimate =
        estimateTagPose(camera, tag.mount.size_m, *corners, camera_T_tag,
                        std::max(camera.corner_noise_px, kLeastNoise_px));
    frame.detections.push_back(
        {tag.mount.id, tag.mount.size_m, estimate.camera_T_tag, estimate.covariance});
  }
  return frame;
}

}  // namespace casepush::sim
