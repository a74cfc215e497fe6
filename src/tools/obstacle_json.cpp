#include "obstacle_json.h"

#include <cmath>
#include <cstdio>
#include <string>

namespace casepush {
namespace {

struct Measure {
  const char* name;
  double (*of)(const PlanTrial&);
};
constexpr Measure kMeasures[] = {
    {"nodes", [](const PlanTrial& plan) { return static_cast<double>(plan.nodes); }},
    {"length_m", [](const PlanTrial& plan) { return plan.length_m; }},
    {"pushes", [](const PlanTrial& plan) { return static_cast<double>(plan.pushes); }},
};
constexpr Measure kTime = {"planning_s", [](const PlanTrial& plan) { return plan.planning_s; }};

/// Of all solved plans.
nlohmann::ordered_json spreadJson(const std::vector<TaskRun>& runs, const Measure& measure) {
  double sum = 0.0, squares = 0.0, squares_within = 0.0;
  int count = 0, rooms = 0;
  for (const TaskRun& run : runs) {
    double room_sum = 0.0, room_squares = 0.0;
    int room_count = 0;
    for (const PlanTrial& plan : run.plans) {
      if (!plan.is_solved) continue;
      const double value = measure.of(plan);
      room_sum += value;
      room_squares += value * value;
      ++room_count;
    }
    if (room_count == 0) continue;
    squares_within += room_squares - room_sum * room_sum / room_count;
    sum += room_sum;
    squares += room_squares;
    count += room_count;
    ++rooms;
  }
  if (count == 0) return {{"mean", nullptr}, {"sd", nullptr}, {"sd_within_rooms", nullptr}};
  const auto deviation = [](double squared, int freedom) {
    return freedom > 0 ? std::sqrt(std::max(squared, 0.0) / freedom) : 0.0;
  };
  return {{"mean", sum / count},
          {"sd", deviation(squares - sum * sum / count, count - 1)},
          {"sd_within_rooms", deviation(squares_within, count - rooms)}};
}

nlohmann::ordered_json finiteJson(double value) {
  return std::isinf(value) ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(value);
}

void printSpread(const char* name, const nlohmann::ordered_json& spread) {
  if (spread["mean"].is_null()) return;
  std::printf(", %s %.3g +- %.2g (%.2g)", name, spread["mean"].get<double>(),
              spread["sd"].get<double>(), spread["sd_within_rooms"].get<double>());
}

std::string edgeText(const DetourBin& bin) {
  char text[32];
  if (bin.from == 0.0 && std::isinf(bin.to)) return "all";
  if (std::isinf(bin.to)) {
    std::snprintf(text, sizeof text, "%.2f and more", bin.from);
  } else {
    std::snprintf(text, sizeof text, "%.2f to %.2f", bin.from, bin.to);
  }
  return text;
}

}  // namespace

nlohmann::ordered_json planTrialsJson(const std::vector<TaskRun>& runs) {
  int trials = 0, solved = 0;
  for (const TaskRun& run : runs) {
    for (const PlanTrial& plan : run.plans) {
      ++trials;
      solved += plan.is_solved ? 1 : 0;
    }
  }
  nlohmann::ordered_json json = {{"trials", trials}, {"solved", solved}};
  for (const Measure& measure : kMeasures) json[measure.name] = spreadJson(runs, measure);
  return json;
}

nlohmann::ordered_json planTimesJson(const std::vector<TaskRun>& runs) {
  return spreadJson(runs, kTime);
}

nlohmann::ordered_json pairsJson(const std::vector<ObstaclePair>& pairs) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const ObstaclePair& pair : pairs) {
    json.push_back({{"seed", pair.seed},
                    {"around_m", finiteJson(pair.around_m)},
                    {"through_m", finiteJson(pair.through_m)},
                    {"stationary_s", pair.stationary_s},
                    {"movable_s", pair.movable_s},
                    {"success", pair.succeeded}});
  }
  return json;
}

nlohmann::ordered_json detourJson(const std::vector<DetourBin>& bins) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const DetourBin& bin : bins) {
    nlohmann::ordered_json row = {{"detour_from", bin.from},
                                  {"detour_to", finiteJson(bin.to)},
                                  {"pairs", bin.pairs},
                                  {"failed_pairs", bin.failed}};
    if (bin.pairs > 0) {
      row.update({{"detour", bin.detour},
                  {"around_m", bin.around_m},
                  {"through_m", bin.through_m},
                  {"stationary_s", bin.stationary_s},
                  {"movable_s", bin.movable_s},
                  {"ratio", bin.ratio.mean},
                  {"ci95", {bin.ratio.low, bin.ratio.high}}});
    }
    json.push_back(row);
  }
  return json;
}

void printPlanTrials(const nlohmann::ordered_json& rows, const nlohmann::ordered_json& times) {
  std::printf("\nPlans: mean and standard deviation (within a room)\n");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const nlohmann::ordered_json& label = rows[i]["label"];
    const nlohmann::ordered_json& plans = rows[i]["plans"];
    std::printf("%s, %s, %d of %d found", label["caster_model"].get<std::string>().c_str(),
                label["obstacles"].get<std::string>().c_str(), plans["solved"].get<int>(),
                plans["trials"].get<int>());
    for (const Measure& measure : kMeasures) printSpread(measure.name, plans[measure.name]);
    printSpread(kTime.name, times[i]);
    std::printf("\n");
  }
}

void printDetours(const std::vector<DetourBin>& bins) {
  std::printf("%-14s %6s %7s %9s %10s %13s %10s %20s\n", "detour", "pairs", "failed", "around m",
              "through m", "stationary s", "movable s", "ratio (95 %)");
  for (const DetourBin& bin : bins) {
    std::printf("%-14s %6d %7d", edgeText(bin).c_str(), bin.pairs, bin.failed);
    if (bin.pairs > 0) {
      std::printf(" %9.1f %10.1f %13.1f %10.1f    %.2f (%.2f to %.2f)", bin.around_m, bin.through_m,
                  bin.stationary_s, bin.movable_s, bin.ratio.mean, bin.ratio.low, bin.ratio.high);
    }
    std::printf("\n");
  }
}

}  // namespace casepush
