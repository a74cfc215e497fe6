#include "tag_camera.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "bullet_conversions.h"
#include "tag_pose.h"

namespace casepush::sim {
namespace {

constexpr std::size_t kMostWaiting = 1000;
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

bool isVisible(const Eigen::Isometry3d& map_T_camera, const Eigen::Isometry3d& map_T_tag,
               double size_m, const Sight& sight) {
  const Eigen::Vector3d eye = map_T_camera.translation();
  const Eigen::Vector3d in_front(0.0, 0.0, -kInFront_m);
  if (!sight.isClear(eye, map_T_tag * in_front)) return false;
  const auto corners = tagCorners(kInset * size_m);
  return std::all_of(corners.begin(), corners.end(), [&](const Eigen::Vector3d& corner) {
    return sight.isClear(eye, map_T_tag * (corner + in_front));
  });
}

}  // namespace

TagCameras::TagCameras(const Scene& scene, bool noise, std::uint64_t seed)
    : scene_(scene), waiting_(kMostWaiting) {
  for (const CameraModel& model : scene.robot.cameras) {
    if (!model.switches.enabled) continue;
    cameras_.push_back({&model, noise && model.switches.noise,
                        noiseStream(model.switches, seed, model.name), SampleClock(model.rate_hz)});
  }
}

bool TagCameras::isDue(double time_s) const {
  return std::any_of(cameras_.begin(), cameras_.end(),
                     [time_s](const Camera& camera) { return camera.clock.isDue(time_s); });
}

void TagCameras::update(double time_s, const PhysicsWorld& physics, const Sight& sight) {
  for (Camera& camera : cameras_) {
    if (!camera.clock.isDue(time_s)) continue;
    camera.clock.advance(time_s);
    waiting_.push(time_s + camera.model->latency_s, capture(camera, time_s, physics, sight));
  }
}

TagFrame TagCameras::capture(Camera& camera, double time_s, const PhysicsWorld& physics,
                             const Sight& sight) const {
  const CameraModel& model = *camera.model;
  TagFrame frame;
  frame.camera = model.name;
  frame.stamp_s = time_s;
  const Eigen::Isometry3d map_T_camera = toSpatial(physics.robot().pose()) * model.base_T_camera;
  const Eigen::Isometry3d camera_T_map = map_T_camera.inverse();
  for (const SceneTag& tag : scene_.tags) {
    const Eigen::Isometry3d map_T_tag =
        physics.furniture(tag.object).map_T_root() * tag.mount.object_T_tag;
    const Eigen::Isometry3d camera_T_tag = camera_T_map * map_T_tag;
    std::optional<Corners> corners = cornersInImage(model, tag.mount.size_m, camera_T_tag);
    if (!corners || !isVisible(map_T_camera, map_T_tag, tag.mount.size_m, sight)) continue;
    if (camera.noise) {
      if (camera.random.chance(model.dropout)) continue;
      for (Eigen::Vector2d& corner : *corners) {
        corner.x() += camera.random.normal(model.corner_noise_px);
        corner.y() += camera.random.normal(model.corner_noise_px);
      }
    }
    const TagPoseEstimate estimate =
        estimateTagPose(model, tag.mount.size_m, *corners, camera_T_tag,
                        std::max(model.corner_noise_px, kLeastNoise_px));
    frame.detections.push_back(
        {tag.mount.id, tag.mount.size_m, estimate.camera_T_tag, estimate.covariance});
  }
  return frame;
}

}  // namespace casepush::sim
