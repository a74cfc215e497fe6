#include "sim_bench_json.h"

#include <cmath>

#include "casepush/lab/quantile.h"

namespace casepush {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLeastSigma = 1e-6;  // Below it an outcome does not vary.
constexpr double kTipped_rad = 0.01;  // Far more than wheels yield.

Json spread(const std::vector<double>& values) {
  return {{"median", quantile(values, 0.5)}, {"p90", quantile(values, 0.9)}};
}

Json ratios(const std::vector<double>& values) {
  if (values.empty()) return nullptr;  // Nothing varies: the object has no swivels.
  return {{"p10", quantile(values, 0.1)},
          {"median", quantile(values, 0.5)},
          {"p90", quantile(values, 0.9)}};
}

struct Differences {
  std::vector<double> position_m;
  std::vector<double> yaw_rad;
};

Differences differencesOf(const std::vector<PushOutcomes>& pushes, std::size_t other) {
  Differences result;
  for (const PushOutcomes& push : pushes) {
    for (std::size_t i = 0; i < push.reference.size(); ++i) {
      const Eigen::Vector3d difference = push.others[other][i] - push.reference[i];
      result.position_m.push_back(difference.head<2>().norm());
      result.yaw_rad.push_back(std::abs(difference.z()));
    }
  }
  return result;
}

Json curve(const std::vector<ForceSample>& samples) {
  Json result{{"moved_m", Json::array()}, {"force_n", Json::array()}};
  for (const ForceSample& sample : samples) {
    result["moved_m"].push_back(sample.moved_m);
    result["force_n"].push_back(sample.force_n);
  }
  return result;
}

Json pushForceJson(const Catalog& catalog, const SimulatorOptions& options) {
  Json result = Json::array();
  for (const double lever_arm_m : {0.0022, 0.0024, 0.0033, 0.0045}) {
    for (const double radius_m : {0.051, 0.0765}) {
      for (const double mass_kg : {20.0, 60.0, 100.0}) {
        const LawCart cart{mass_kg, radius_m, lever_arm_m};
        result.push_back({{"rolling_lever_arm_m", lever_arm_m},
                          {"wheel_radius_m", radius_m},
                          {"weight_n", cart.weightN()},
                          {"force_n", measureSteadyForce(catalog, cart, options)},
                          {"law_n", cart.rollingResistanceN()}});
      }
    }
  }
  return result;
}

Json coastJson(const Catalog& catalog, const SimulatorOptions& options) {
  Json result = Json::array();
  for (const double lever_arm_m : {0.0022, 0.0024, 0.0033, 0.0045}) {
    LawCart cart;
    cart.rolling_lever_arm_m = lever_arm_m;
    Json entry{{"rolling_lever_arm_m", lever_arm_m},
               {"time_s", Json::array()},
               {"moved_m", Json::array()},
               {"speed_mps", Json::array()}};
    for (const CoastSample& sample : measureCoast(catalog, cart, options)) {
      entry["time_s"].push_back(sample.time_s);
      entry["moved_m"].push_back(sample.moved_m);
      entry["speed_mps"].push_back(sample.speed_mps);
    }
    entry["law_m"] = coastDistance(catalog, cart, entry["speed_mps"].front());
    result.push_back(entry);
  }
  return result;
}

Json trailingJson(const Catalog& catalog, const SimulatorOptions& options) {
  Json result{{"moved_m", Json::array()}, {"swivel_rad", Json::array()}};
  for (const TrailSample& sample : measureTrailing(catalog, {}, options)) {
    result["moved_m"].push_back(sample.moved_m);
    result["swivel_rad"].push_back(sample.swivel_rad);
  }
  return result;
}

}  // namespace

bool isTipped(const PushOutcomes& push) { return push.tilt_rad > kTipped_rad; }

Json distributionsJson(const std::vector<PushOutcomes>& pushes, std::size_t other) {
  if (pushes.empty()) return nullptr;
  std::vector<double> displacement_m, mean_m, mean_rad, sigma_m, sigma_rad, ratio_m, ratio_rad;
  Eigen::Vector2d reference_variance = Eigen::Vector2d::Zero();
  Eigen::Vector2d other_variance = Eigen::Vector2d::Zero();
  for (const PushOutcomes& push : pushes) {
    const OutcomeMoments a = momentsOf(push.reference);
    const OutcomeMoments b = momentsOf(push.others[other]);
    displacement_m.push_back(a.mean.head<2>().norm());
    mean_m.push_back((b.mean - a.mean).head<2>().norm());
    mean_rad.push_back(std::abs(b.mean.z() - a.mean.z()));
    sigma_m.push_back(a.position_sigma_m);
    sigma_rad.push_back(a.yaw_sigma_rad);
    if (a.position_sigma_m > kLeastSigma) {
      ratio_m.push_back(b.position_sigma_m / a.position_sigma_m);
    }
    if (a.yaw_sigma_rad > kLeastSigma) ratio_rad.push_back(b.yaw_sigma_rad / a.yaw_sigma_rad);
    reference_variance += Eigen::Vector2d(a.position_sigma_m, a.yaw_sigma_rad).cwiseAbs2();
    other_variance += Eigen::Vector2d(b.position_sigma_m, b.yaw_sigma_rad).cwiseAbs2();
  }
  const auto pooled = [&](int i) -> Json {
    if (reference_variance[i] < kLeastSigma * kLeastSigma) return nullptr;
    return std::sqrt(other_variance[i] / reference_variance[i]);
  };
  const Differences runs = differencesOf(pushes, other);
  return {
      {"displacement_m", spread(displacement_m)},   {"mean_difference_m", spread(mean_m)},
      {"mean_difference_rad", spread(mean_rad)},    {"run_difference_m", spread(runs.position_m)},
      {"run_difference_rad", spread(runs.yaw_rad)}, {"reference_sigma_m", spread(sigma_m)},
      {"reference_sigma_rad", spread(sigma_rad)},   {"sigma_ratio_position", ratios(ratio_m)},
      {"sigma_ratio_yaw", ratios(ratio_rad)},       {"pooled_sigma_ratio_position", pooled(0)},
      {"pooled_sigma_ratio_yaw", pooled(1)}};
}

Json differencesJson(const std::vector<PushOutcomes>& pushes, std::size_t other) {
  const Differences runs = differencesOf(pushes, other);
  return {{"difference_m", spread(runs.position_m)}, {"difference_rad", spread(runs.yaw_rad)}};
}

Json outcomesJson(const Outcomes& outcomes) {
  Json result = Json::array();
  for (const Eigen::Vector3d& outcome : outcomes) {
    result.push_back({outcome.x(), outcome.y(), outcome.z()});
  }
  return result;
}

Json lawsJson(const Catalog& catalog, const SimulatorOptions& options) {
  const LawCart cart;
  return {{"push_force", pushForceJson(catalog, options)},
          {"start",
           {{"mass_kg", cart.mass_kg},
            {"law_n", cart.rollingResistanceN()},
            {"aligned", curve(measureStart(catalog, cart, false, options))},
            {"across", curve(measureStart(catalog, cart, true, options))}}},
          {"coast", coastJson(catalog, options)},
          {"trailing", trailingJson(catalog, options)}};
}

}  // namespace casepush
