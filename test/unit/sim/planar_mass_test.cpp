#include "planar_mass.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "casepush/common/random.h"

namespace casepush::sim {
namespace {

constexpr int kSwivels = 4;
constexpr int kSize = 3 + kSwivels;

PlanarDirection randomDirection(Random& random, int swivel) {
  PlanarDirection direction;
  for (int i = 0; i < 3; ++i) direction.chassis[i] = random.uniform(-1.0, 1.0);
  direction.swivel = swivel;
  direction.swivel_rate = swivel < 0 ? 0.0 : random.uniform(-0.1, 0.1);
  return direction;
}

Eigen::VectorXd denseRow(const PlanarDirection& direction) {
  Eigen::VectorXd row = Eigen::VectorXd::Zero(kSize);
  row.head<3>() = direction.chassis;
  if (direction.swivel >= 0) row[3 + direction.swivel] = direction.swivel_rate;
  return row;
}

class PlanarMassTest : public testing::TestWithParam<int> {
 protected:
  PlanarMassTest() : random_(static_cast<std::uint64_t>(GetParam())) {
    mass_.reset(kSwivels);
    for (int swivel = -1; swivel < kSwivels; ++swivel) {
      for (int i = 0; i < 4; ++i) {
        const PlanarDirection direction = randomDirection(random_, swivel);
        const double mass = random_.uniform(0.1, swivel < 0 ? 30.0 : 2.0);
        mass_.add(direction, mass);
        dense_ += mass * denseRow(direction) * denseRow(direction).transpose();
      }
      if (swivel < 0) continue;
      const double inertia = random_.uniform(1e-4, 1e-2);
      mass_.addSwivelInertia(swivel, inertia);
      dense_(3 + swivel, 3 + swivel) += inertia;
    }
    mass_.factor();
  }

  Random random_;
  PlanarMass mass_;
  Eigen::MatrixXd dense_ = Eigen::MatrixXd::Zero(kSize, kSize);
};

INSTANTIATE_TEST_SUITE_P(Seeds, PlanarMassTest, testing::Range(1, 9));

TEST_P(PlanarMassTest, coordinatesCarryTheEnergyAndComeBack) {
  Eigen::VectorXd velocity = Eigen::VectorXd::NullaryExpr(
      kSize, [this](Eigen::Index) { return random_.uniform(-2.0, 2.0); });
  Eigen::VectorXd identity(kSize);
  Eigen::VectorXd back(kSize);
  mass_.toIdentity(velocity.data(), identity.data());
  mass_.fromIdentity(identity.data(), back.data());
  EXPECT_NEAR(identity.squaredNorm(), velocity.dot(dense_ * velocity), 1e-9);
  EXPECT_LT((back - velocity).norm(), 1e-9);
}

TEST_P(PlanarMassTest, directionsMeasureSpeedAndMoveAsTheInverseMassSays) {
  for (int swivel = -1; swivel < kSwivels; ++swivel) {
    const PlanarDirection direction = randomDirection(random_, swivel);
    const Eigen::VectorXd row = denseRow(direction);
    const Eigen::Vector4d j = mass_.toIdentity(direction);
    const Eigen::VectorXd gained = dense_.ldlt().solve(row);
    EXPECT_NEAR(j.squaredNorm(), row.dot(gained), 1e-9 * j.squaredNorm());
    Eigen::VectorXd identity = Eigen::VectorXd::Zero(kSize);
    identity.head<3>() = j.head<3>();
    if (swivel >= 0) identity[3 + swivel] = j[3];
    Eigen::VectorXd velocity(kSize);
    mass_.fromIdentity(identity.data(), velocity.data());
    EXPECT_LT((velocity - gained).norm(), 1e-9 * gained.norm());
  }
}

}  // namespace
}  // namespace casepush::sim
