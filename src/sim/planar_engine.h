#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include <memory>
#include <vector>

#include "collision_space.h"
#include "engine.h"
#include "planar_furniture.h"
#include "planar_robot.h"
#include "planar_solver.h"

namespace casepush::sim {

/// The fast model: everything moves in the plane; Bullet only finds contacts and casts rays.
class PlanarEngine final : public Engine {
 public:
  /// @pre `scene` and `space` outlive this.
  PlanarEngine(const Scene& scene, CollisionSpace& space, const WorldState& state,
               const StepOptions& options);

  btCollisionWorld& collisions() override { return world_; }
  const btCollisionWorld& collisions() const override { return world_; }
  void setRobotTarget(const Twist2& robot_twist) override { robot_.setTarget(robot_twist); }
  void step(ContactLog& contacts) override;
  const Robot& robot() const override { return robot_; }
  const Furniture& furniture(int index) const override {
    return *furniture_[static_cast<std::size_t>(index)];
  }

 private:
  struct Touch {
    const btCollisionObject* a;
    const btCollisionObject* b;
    btManifoldPoint* point;
    Eigen::Vector2d map_point;
    double low_m;  // Of points one above the other, that are the same in the plane.
    double high_m;

    Eigen::Vector3d middle() const {
      return {map_point.x(), map_point.y(), 0.5 * (low_m + high_m)};
    }
  };

  void findTouches();
  void addTouch(btPersistentManifold& manifold, btManifoldPoint& point);
  void enterBodies();
  PlanarFurniture* furnitureOf(const btCollisionObject* object) const;
  void wake(const btCollisionObject* object);
  void setSide(const btCollisionObject* object, const Eigen::Vector2d& map_point,
               const Eigen::Vector2d& normal, PlanarAddress& address, Eigen::Vector4d& along,
               Eigen::Vector4d& across) const;
  void addContact(const Touch& touch);
  void readContacts(ContactLog& contacts);

  double step_s_;
  int iterations_;
  PlanarRobot robot_;
  std::vector<std::unique_ptr<PlanarFurniture>> furniture_;
  std::vector<char> awake_;  // By furniture: moves or is touched in this step.
  std::vector<Touch> touches_;
  PlanarSolver solver_;
  btCollisionWorld world_;  // Last: its destructor still needs all of the above.
};

}  // namespace casepush::sim
