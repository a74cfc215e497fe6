#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "casepush/common/random.h"
#include "casepush/model/object_model.h"
#include "casepush/model/world_model.h"
#include "casepush/world/shadow.h"
#include "furniture_kind.h"

namespace casepush {

constexpr double kWall_m = 0.1;  ///< Thickness of walls.

/// To the centimetre: what is written to a file and read again is then the same.
double toCentimetre(double value_m);

/// A heading to the degree (or whatever the step is) [rad].
double drawHeading(Random& random, double step_deg);

/// Between the tags of two objects in a room.
constexpr int kTagsPerObject = 100;

/// A wall of a room, upright, square to the axes.
StaticBox wall(const std::string& name, double length_x_m, double length_y_m, double x_m,
               double y_m);

/// Builds a rectangular room: walls, then what must stay free, then furniture beside that.
class RoomBuilder {
 public:
  /// @param random  Must outlive the builder.
  RoomBuilder(const std::string& name, const Eigen::Vector2d& size_m, Random* random);
  /// Square.
  RoomBuilder(const std::string& name, double size_m, Random* random);

  WorldModel& world() { return world_; }

  void keepFree(const Eigen::Vector2d& centre_m, double radius_m);
  void keepLegFree(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m, double radius_m);
  /// Furniture keeps off a wall that is part of the world already.
  void addWall(const StaticBox& box);

  /// Puts an object where furniture might stand. False if there is no room for it.
  bool placeObject(const std::string& id, const ObjectModel& model, int tag_offset);

  /// Adds pieces of furniture until they cover a share of the floor. Returns the share reached,
  /// which is less if no more fit.
  double furnish(double density);

 private:
  bool tryPlace(const FurniturePiece& piece);
  std::optional<Pose2> tryStand(const Shadow& outline, double heading_step_deg);
  void add(const FurniturePiece& piece, const Pose2& pose);

  struct FreeDisc {
    Eigen::Vector2d centre_m;
    double radius_m;
  };
  Eigen::Vector2d size_m_;
  Random& random_;
  WorldModel world_;
  std::vector<FreeDisc> free_;
  std::vector<Shadow> placed_;
  int pieces_ = 0;
};

}  // namespace casepush
