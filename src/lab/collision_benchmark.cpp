#include "casepush/lab/collision_benchmark.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "casepush/common/random.h"
#include "casepush/common/violations.h"
#include "casepush/world/fcl_checker.h"
#include "casepush/world/static_table.h"
#include "casepush/world/sweep_checker.h"
#include "thread_time.h"

namespace casepush {
namespace {

constexpr double kRoom_m = 15.0;
constexpr double kDoubt_m = 1e-4;
constexpr int kPathPoses = 20;
constexpr int kSigmaPoses = 6;
constexpr std::size_t kTable = 4;  // Index of the static table's back-end.

WorldModel randomRoom(Random& random) {
  WorldModel world;
  world.name = "room";
  world.min_m = {0.0, 0.0};
  world.max_m = {kRoom_m, kRoom_m};
  const auto add = [&world](const Eigen::Vector3d& size_m, const Eigen::Isometry3d& map_T_box) {
    StaticBox box;
    box.name = "box_" + std::to_string(world.boxes.size());
    box.box.size_m = size_m;
    box.map_T_box = map_T_box;
    world.boxes.push_back(box);
  };
  for (int side = 0; side < 4; ++side) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translate(Eigen::Vector3d(kRoom_m / 2.0, kRoom_m / 2.0, 0.75));
    pose.rotate(Eigen::AngleAxisd(side * M_PI / 2.0, Eigen::Vector3d::UnitZ()));
    pose.translate(Eigen::Vector3d(kRoom_m / 2.0 - 0.05, 0.0, 0.0));
    add({0.1, kRoom_m, 1.5}, pose);
  }
  const int boxes = 34 + static_cast<int>(random.below(12));
  for (int i = 0; i < boxes; ++i) {
    const Eigen::Vector3d size(random.uniform(0.2, 1.5), random.uniform(0.2, 1.5),
                               random.uniform(0.1, 1.2));
    const double lift_m = random.chance(0.3) ? random.uniform(0.1, 1.0) : 0.0;
    const double x = random.uniform(0.5, kRoom_m - 0.5);
    const double y = random.uniform(0.5, kRoom_m - 0.5);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translate(Eigen::Vector3d(x, y, lift_m + size.z() / 2.0));
    pose.rotate(Eigen::AngleAxisd(random.uniform(-M_PI, M_PI), Eigen::Vector3d::UnitZ()));
    add(size, pose);
  }
  return world;
}

/// A push as the planner tests it.
struct Motion {
  std::vector<Pose2> object;
  std::vector<Pose2> ends;
  std::vector<Pose2> robot;
};

Motion randomMotion(Random& random, double contact_m) {
  Motion motion;
  const double bearing = random.uniform(-M_PI, M_PI);
  const double length_m = random.uniform(0.3, 1.2);
  const Eigen::Vector3d twist(length_m * std::cos(bearing), length_m * std::sin(bearing),
                              random.uniform(-0.8, 0.8));
  const Pose2 object_T_robot(-contact_m * std::cos(bearing), -contact_m * std::sin(bearing),
                             bearing);
  for (int i = 0; i < kPathPoses; ++i) {
    motion.object.push_back(expSe2(twist * i / (kPathPoses - 1.0)));
    motion.robot.push_back(motion.object.back() * object_T_robot);
  }
  for (int i = 0; i < kSigmaPoses; ++i) {
    Eigen::Vector3d off = Eigen::Vector3d::Zero();
    off[i / 2] = (i % 2 == 0 ? 1.0 : -1.0) * (i < 4 ? 0.09 : 0.15);
    motion.ends.push_back(motion.object.back() * expSe2(off));
  }
  return motion;
}

struct Test {
  int motion;
  Pose2 map_T_start;
};

/// Object and robot for FCL, grown by -shrink_m.
struct FclBodies {
  FclBodies(const Solid& object_solid, const Solid& robot_solid, double shrink_m)
      : object(object_solid, shrink_m), robot(robot_solid, shrink_m) {}
  FclChecker::Body object;
  FclChecker::Body robot;

  bool collide(const FclChecker& fcl, const Motion& motion, const Pose2& map_T_start) const {
    const auto any = [&](const FclChecker::Body& body, const std::vector<Pose2>& poses) {
      return std::any_of(poses.begin(), poses.end(),
                         [&](const Pose2& pose) { return fcl.collides(body, map_T_start * pose); });
    };
    return any(object, motion.ends) || any(robot, motion.robot) || any(object, motion.object);
  }
};

/// Measures room after room.
class Measurement {
 public:
  Measurement(const Catalog& catalog, const CollisionBenchmarkOptions& options,
              std::function<void(int)> progress)
      : options_(options),
        progress_(std::move(progress)),
        object_(catalog.object(options.object)),
        robot_(catalog.robot(options.robot)),
        random_(Random::stream(options.seed, "collision benchmark")) {
    for (const char* name : {"fcl_octomap", "pose_by_pose", "sweep_exact", "sweep_mask"}) {
      result_.backends.push_back({name});
      cpu_s_.push_back(0.0);
    }
    if (options.static_table) {
      result_.backends.push_back({"static_table"});
      cpu_s_.push_back(0.0);
    }
  }

  void measureRoom(int tests) {
    auto map = std::make_shared<Map>(options_.resolution_m);
    map->addSurvey(surveyPoints(randomRoom(random_), options_.resolution_m));
    double start_s = threadSeconds();
    const CollisionChecker checker(*map);
    const auto object = checker.footprint(object_.solid);
    const auto robot = checker.footprint(robot_.solid);
    const auto classes = SweepChecker::heightClasses(checker, {object, robot});
    constexpr double kReach_m = 4.0;
    start_s = threadSeconds();
    const SweepChecker sweeps(checker, classes, kReach_m);
    map_s_ += threadSeconds() - start_s;
    std::vector<Motion> motions;
    std::vector<std::unique_ptr<Sweep>> prepared;
    start_s = threadSeconds();
    for (int i = 0; i < options_.motions; ++i) {
      motions.push_back(randomMotion(random_, object_.radius_m + robot_.radius_m));
      std::vector<Track> tracks = {{object, motions.back().ends, Track::Kind::kSeparate},
                                   {robot, motions.back().robot, Track::Kind::kPath},
                                   {object, motions.back().object, Track::Kind::kPath}};
      prepared.push_back(std::make_unique<Sweep>(std::move(tracks), classes));
      warmUp(sweeps, *prepared.back());
    }
    mask_s_ += threadSeconds() - start_s;
    std::vector<Test> drawn;
    for (int i = 0; i < tests; ++i) drawn.push_back(randomTest());
    compare(*map, sweeps, motions, prepared, drawn);
    ++rooms_;
  }

  CollisionBenchmark result() const {
    CollisionBenchmark result = result_;
    for (std::size_t i = 0; i < cpu_s_.size(); ++i) {
      result.backends[i].tests_per_s = cpu_s_[i] > 0.0 ? result.tests / cpu_s_[i] : 0.0;
    }
    result.mask_ms = 1e3 * mask_s_ / (rooms_ * options_.motions);
    result.map_ms = 1e3 * map_s_ / rooms_;
    if (options_.static_table) addTableCost(&result);
    return result;
  }

 private:
  static void warmUp(const SweepChecker& sweeps, const Sweep& sweep) {
    constexpr int kHeadings = 128;
    for (int i = 0; i < kHeadings; ++i) {
      sweeps.mayCollide(sweep, {kRoom_m / 2.0, kRoom_m / 2.0, i * 2.0 * M_PI / kHeadings - M_PI});
    }
  }

  void addTableCost(CollisionBenchmark* result) const {
    const double tests = 1.0 * result->tests * options_.motions;
    const double table_s = cpu_s_[kTable];
    CollisionBackend& backend = result->backends[kTable];
    backend.tests_per_s = table_s > 0.0 ? tests / table_s : 0.0;
    StaticTableCost& cost = result->static_table;
    cost.build_s = table_build_s_ / rooms_;
    cost.memory_mb = 1e-6 * static_cast<double>(table_bytes_) / rooms_;
    cost.mask_tests_per_s = all_masks_s_ > 0.0 ? tests / all_masks_s_ : 0.0;
    const double saved_s = all_masks_s_ - table_s;
    cost.pays_from_tests = saved_s > 0.0 ? cost.build_s * tests / saved_s : 0.0;
  }

  /// Answers from a table, and how long the masks take for all that it answers.
  std::vector<std::uint8_t> measureTable(const SweepChecker& sweeps,
                                         const std::vector<std::unique_ptr<Sweep>>& prepared,
                                         const std::vector<Test>& tests) {
    std::vector<const Sweep*> motions;
    for (const auto& sweep : prepared) motions.push_back(sweep.get());
    double start_s = threadSeconds();
    const StaticTable table(sweeps, motions);
    table_build_s_ += threadSeconds() - start_s;
    table_bytes_ += table.bytes();
    std::vector<std::uint8_t> may(motions.size());
    start_s = threadSeconds();
    for (const Test& test : tests) {
      for (std::size_t i = 0; i < motions.size(); ++i) {
        may[i] = sweeps.mayCollide(*motions[i], test.map_T_start) ? 1 : 0;
      }
    }
    all_masks_s_ += threadSeconds() - start_s;
    std::vector<std::uint64_t> words(table.words());
    return run(kTable, tests, [&](const Test& test) {
      for (int w = 0; w < table.words(); ++w) words[w] = table.blocked(test.map_T_start, w);
      return (words[test.motion / 64] >> test.motion % 64 & 1) != 0;
    });
  }

  /// Called for every test of FCL, which takes nearly all of the time.
  void showProgress() {
    const int percent = std::max(1, options_.tests / 100);
    if (progress_ && shown_++ % percent == 0) progress_(shown_ - 1);
  }

  Test randomTest() {
    Test test;
    test.motion = static_cast<int>(random_.below(static_cast<std::uint64_t>(options_.motions)));
    const double x = random_.uniform(0.5, kRoom_m - 0.5);
    const double y = random_.uniform(0.5, kRoom_m - 0.5);
    test.map_T_start = Pose2(x, y, random_.uniform(-M_PI, M_PI));
    return test;
  }

  template <typename Collides>
  std::vector<std::uint8_t> run(std::size_t backend, const std::vector<Test>& tests,
                                const Collides& collides) {
    std::vector<std::uint8_t> answers;
    answers.reserve(tests.size());
    const double start_s = threadSeconds();
    for (const Test& test : tests) answers.push_back(collides(test) ? 1 : 0);
    cpu_s_[backend] += threadSeconds() - start_s;
    return answers;
  }

  void compare(const Map& map, const SweepChecker& sweeps, const std::vector<Motion>& motions,
               const std::vector<std::unique_ptr<Sweep>>& prepared,
               const std::vector<Test>& tests) {
    std::vector<std::vector<std::uint8_t>> answers(cpu_s_.size());
    answers[1] = run(1, tests, [&](const Test& test) {
      return sweeps.collidesPoseByPose(*prepared[test.motion], test.map_T_start);
    });
    answers[2] = run(2, tests, [&](const Test& test) {
      return sweeps.collides(*prepared[test.motion], test.map_T_start);
    });
    answers[3] = run(3, tests, [&](const Test& test) {
      return sweeps.mayCollide(*prepared[test.motion], test.map_T_start);
    });
    if (options_.static_table) answers[kTable] = measureTable(sweeps, prepared, tests);
    result_.tests += static_cast<int>(tests.size());
    if (!FclChecker::isAvailable()) return;
    const FclChecker fcl(map);
    const FclBodies bodies(object_.solid, robot_.solid, 0.0);
    const FclBodies shrunk(object_.solid, robot_.solid, kDoubt_m);
    const FclBodies grown(object_.solid, robot_.solid, -kDoubt_m);
    answers[0] = run(0, tests, [&](const Test& test) {
      showProgress();
      return bodies.collide(fcl, motions[test.motion], test.map_T_start);
    });
    for (std::size_t i = 0; i < tests.size(); ++i) {
      const Motion& motion = motions[tests[i].motion];
      const bool truth = answers[0][i] != 0;
      result_.collisions += truth;
      const auto differs = [&](const auto& answer) { return (answer[i] != 0) != truth; };
      if (std::none_of(answers.begin(), answers.end(), differs)) continue;
      if (shrunk.collide(fcl, motion, tests[i].map_T_start) !=
          grown.collide(fcl, motion, tests[i].map_T_start)) {
        ++result_.contacts;
        continue;
      }
      for (std::size_t k = 1; k < answers.size(); ++k) {
        result_.backends[k].missed += truth && answers[k][i] == 0;
        result_.backends[k].extra += !truth && answers[k][i] != 0;
      }
    }
  }

  CollisionBenchmarkOptions options_;
  std::function<void(int)> progress_;
  int shown_ = 0;
  ObjectModel object_;
  RobotModel robot_;
  Random random_;
  CollisionBenchmark result_;
  std::vector<double> cpu_s_;
  double mask_s_ = 0.0;
  double map_s_ = 0.0;
  double table_build_s_ = 0.0;
  std::size_t table_bytes_ = 0;
  double all_masks_s_ = 0.0;
  int rooms_ = 0;
};

}  // namespace

void CollisionBenchmarkOptions::validate() const {
  Violations violations;
  violations.require("rooms", rooms, 1, 1000);
  violations.require("tests", tests, rooms, 100000000);
  violations.require("motions", motions, 1, 1000);
  violations.require("resolution", resolution_m, 0.02, 0.2);
  violations.throwIfAny("collision benchmark");
}

CollisionBenchmark measureCollisionChecking(const Catalog& catalog,
                                            const CollisionBenchmarkOptions& options,
                                            const std::function<void(int)>& progress) {
  options.validate();
  Measurement measurement(catalog, options, progress);
  for (int room = 0; room < options.rooms; ++room) {
    const int first = static_cast<int>(std::int64_t{options.tests} * room / options.rooms);
    const int end = static_cast<int>(std::int64_t{options.tests} * (room + 1) / options.rooms);
    measurement.measureRoom(end - first);
  }
  return measurement.result();
}

}  // namespace casepush
