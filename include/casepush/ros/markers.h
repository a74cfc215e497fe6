#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <string>
#include <vector>

#include "casepush/common/pose_gaussian.h"
#include "casepush/model/case.h"
#include "casepush/model/mechanism.h"
#include "casepush/model/observation.h"
#include "casepush/model/push_plan.h"
#include "casepush/world/map.h"

/// What RViz shows. Each array begins with a marker that removes what its topic showed before.
namespace casepush {

using MarkerArray = visualization_msgs::MarkerArray;

/// The shapes of a mechanism at zero joint angles, in the colours of its URDF.
/// @param frame_id  Frame that `frame_T_root` is given in; the markers move along with it.
void addMechanism(const Mechanism& mechanism, const std::string& frame_id,
                  const Eigen::Isometry3d& frame_T_root, const std::string& marker_namespace,
                  MarkerArray& array);

MarkerArray robotMarkers(const Mechanism& robot);

/// Objects with their names; translucent while they have not been seen for `faded_after_s`.
struct ShownObject {
  ObjectState state;
  const Mechanism* mechanism;  ///< Not null.
};
MarkerArray objectMarkers(const std::vector<ShownObject>& objects, double now_s,
                          double faded_after_s);

/// Cases around an object as in the paper's Fig. 3b: robot trajectory green, object trajectory red,
/// yellow 2-sigma ellipse and heading at the mean outcome, id beside it.
MarkerArray caseMarkers(const std::vector<Case>& cases, const Pose2& map_T_object);

/// A plan: goal with its tolerance, and each push with its trajectories, ellipse, sigma points and
/// number. Pushes whose case is not in `cases` show their outcomes only.
MarkerArray planMarkers(const PushPlan& plan, const std::vector<Case>& cases);

MarkerArray treeMarkers(const std::vector<TreeEdge>& tree);

/// Occupied voxels above the floor, coloured by height.
MarkerArray mapMarkers(const Map& map);

/// Points of the n-sigma ellipse of (x, y) around the mean, closed.
std::vector<Eigen::Vector2d> ellipse(const PoseGaussian& gaussian, double sigmas, int segments);

/// Colours from blue over green to red for a fraction in [0, 1].
std_msgs::ColorRGBA rainbow(double fraction);

}  // namespace casepush
