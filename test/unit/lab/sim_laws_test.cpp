#include "casepush/lab/sim_laws.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace casepush {
namespace {

// Every model of casters has to obey the same laws; forces are those that contacts exert.
class SimLaws : public testing::TestWithParam<CasterModel> {
 protected:
  SimLaws() { options_.caster_model = GetParam(); }

  const Catalog catalog_ = Catalog::standard();
  SimulatorOptions options_;
};

INSTANTIATE_TEST_SUITE_P(Models, SimLaws,
                         testing::Values(CasterModel::kFeatherstone, CasterModel::kPlanar),
                         [](const testing::TestParamInfo<CasterModel>& model) {
                           return std::string(toString(model.param));
                         });

TEST_P(SimLaws, steadyPushIsLinearInWeightAndLeverArmAndInverseInWheelSize) {
  for (const double lever_arm_m : {0.0022, 0.0024, 0.0045}) {
    for (const double mass_kg : {25.0, 60.0, 100.0}) {
      for (const double radius_m : {0.05, 0.076}) {
        const LawCart cart{mass_kg, radius_m, lever_arm_m};
        const double expected_n = cart.rollingResistanceN();
        EXPECT_NEAR(measureSteadyForce(catalog_, cart, options_), expected_n, 0.1 * expected_n)
            << "f " << lever_arm_m << " m, " << mass_kg << " kg, r " << radius_m << " m";
      }
    }
  }
}

double peakOf(const std::vector<ForceSample>& samples) {
  return std::max_element(
             samples.begin(), samples.end(),
             [](const ForceSample& a, const ForceSample& b) { return a.force_n < b.force_n; })
      ->force_n;
}

// A caster at the angle phi to the way resists with f N / r |cos phi| + tau / trail |sin phi|,
// which is most on the way from across to trailing.
TEST_P(SimLaws, startingTakesMoreForceWithAllWheelsAcross) {
  const LawCart cart;
  const double aligned_n = peakOf(measureStart(catalog_, cart, false, options_));
  const double across_n = peakOf(measureStart(catalog_, cart, true, options_));
  EXPECT_GT(across_n, 1.03 * aligned_n);
}

TEST_P(SimLaws, coastsAsFarAsRollingResistanceSays) {
  for (const double lever_arm_m : {0.0022, 0.0045}) {
    LawCart cart;
    cart.rolling_lever_arm_m = lever_arm_m;
    const std::vector<CoastSample> samples = measureCoast(catalog_, cart, options_);
    const double expected_m = coastDistance(catalog_, cart, samples.front().speed_mps);
    EXPECT_NEAR(samples.back().moved_m, expected_m, 0.02 * expected_m);
  }
}

TEST_P(SimLaws, castersTrailAfterPushesFromAnyStart) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    options_.seed = seed;
    const std::vector<TrailSample> samples = measureTrailing(catalog_, {}, options_);
    for (const double swivel_rad : samples.back().swivel_rad) {
      EXPECT_NEAR(swivel_rad * 180.0 / M_PI, 0.0, 0.5) << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace casepush
