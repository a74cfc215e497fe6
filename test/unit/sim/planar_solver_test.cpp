#include "planar_solver.h"

#include <gtest/gtest.h>

#include <cmath>

#include "casepush/common/random.h"

namespace casepush::sim {
namespace {

PlanarBound randomRow(Random& random, double limit) {
  PlanarBound row;
  for (int i = 0; i < 4; ++i) row.j[i] = random.uniform(-1.0, 1.0);
  row.limit = limit;
  return row;
}

// Inside of its bounds a row has no speed left; at a bound it may only want to go further out.
void expectSolved(const PlanarBound& row, double left_over) {
  constexpr double kTolerance = 1e-5;
  EXPECT_LE(std::abs(row.impulse), row.limit * (1.0 + 1e-12));
  if (row.impulse < row.limit * (1.0 - 1e-9)) {
    EXPECT_LT(left_over, kTolerance);
  }
  if (row.impulse > -row.limit * (1.0 - 1e-9)) {
    EXPECT_GT(left_over, -kTolerance);
  }
}

TEST(PlanarSolver, solvesCastersToTheirBounds) {
  Random random(5);
  for (int round = 0; round < 200; ++round) {
    PlanarSolver solver;
    solver.clear();
    const int body = solver.addBody(5);
    for (int i = 0; i < 5; ++i) {
      solver.velocity(body)[i] = random.uniform(-1.0, 1.0);
    }
    for (int i = 0; i < 2; ++i) {
      PlanarCaster caster;
      caster.at = {body, body + 3 + i};
      caster.forward = randomRow(random, random.uniform(0.0, 0.2));
      caster.sideways = randomRow(random, random.uniform(0.0, 1.0));
      caster.bearing = randomRow(random, random.uniform(0.0, 1.0));
      solver.add(caster);
    }
    solver.solve(2000);
    for (const PlanarCaster& caster : solver.casters()) {
      const double* v = solver.velocity(body);
      for (const PlanarBound* row : {&caster.forward, &caster.sideways, &caster.bearing}) {
        const double speed = row->j[0] * v[0] + row->j[1] * v[1] + row->j[2] * v[2] +
                             row->j[3] * v[caster.at.swivel - body];
        expectSolved(*row, -speed);
      }
    }
  }
}

// A body of 1 kg on another of 1 kg that is twice as fast.
PlanarContact headOn(int a, int b) {
  PlanarContact contact;
  contact.a = {a, a};
  contact.b = {b, b};
  contact.normal_a << 1.0, 0.0, 0.0, 0.0;
  contact.normal_b << -1.0, 0.0, 0.0, 0.0;
  contact.across_a << 0.0, 1.0, 0.0, 0.0;
  contact.across_b << 0.0, -1.0, 0.0, 0.0;
  contact.friction = 0.5;
  return contact;
}

TEST(PlanarSolver, contactsPushAndRubButNeverPull) {
  PlanarSolver solver;
  solver.clear();
  const int a = solver.addBody(3);
  const int b = solver.addBody(3);
  solver.velocity(b)[0] = 1.0;  // Towards a.
  solver.velocity(b)[1] = 4.0;
  solver.add(headOn(a, b));
  solver.solve(100);
  EXPECT_NEAR(solver.velocity(a)[0], 0.5, 1e-9);
  EXPECT_NEAR(solver.velocity(b)[0], 0.5, 1e-9);
  EXPECT_NEAR(solver.velocity(a)[1], 0.25, 1e-9);  // Friction gives half of the normal impulse.
  EXPECT_NEAR(solver.velocity(b)[1], 3.75, 1e-9);

  solver.clear();
  const int c = solver.addBody(3);
  const int d = solver.addBody(3);
  solver.velocity(c)[0] = 1.0;
  solver.add(headOn(c, d));
  solver.solve(100);
  EXPECT_EQ(solver.velocity(c)[0], 1.0);
  EXPECT_EQ(solver.contacts()[0].normal_impulse, 0.0);
}

TEST(PlanarSolver, slidesAreLimitedAsAWhole) {
  PlanarSolver solver;
  solver.clear();
  const int body = solver.addBody(3);
  solver.velocity(body)[0] = 3.0;
  solver.velocity(body)[1] = 4.0;
  PlanarSlide slide;
  slide.at = {body, body};
  slide.x.j << 1.0, 0.0, 0.0, 0.0;
  slide.y.j << 0.0, 1.0, 0.0, 0.0;
  slide.x.limit = slide.y.limit = 2.5;
  solver.add(slide);
  solver.solve(10);
  EXPECT_NEAR(solver.velocity(body)[0], 1.5, 1e-9);
  EXPECT_NEAR(solver.velocity(body)[1], 2.0, 1e-9);
}

}  // namespace
}  // namespace casepush::sim
