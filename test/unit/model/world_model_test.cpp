#include "casepush/model/world_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "casepush/common/random.h"
#include "casepush/model/catalog.h"
#include "common/input_error_text.h"
#include "common/temporary_folder.h"
#include "model/small_models.h"

namespace casepush {
namespace {

class LoadWorldModel : public testing::Test {
 protected:
  WorldModel load(const std::string& yaml) {
    return loadWorldModel(folder_.write("room.yaml", yaml));
  }

  std::string errorWith(const std::string& from, const std::string& to) {
    const std::string text = inputErrorText([&] { load(replaced(smallWorldYaml(), from, to)); });
    const std::string prefix = (folder_.path() / "room.yaml: ").string();
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text.rfind(prefix, 0) == 0 ? text.substr(prefix.size()) : text;
  }

  TemporaryFolder folder_;
};

TEST_F(LoadWorldModel, readsEverything) {
  const WorldModel room = load(smallWorldYaml());
  EXPECT_EQ(room.name, "room");
  EXPECT_EQ(room.min_m, Eigen::Vector2d(-2, -3));
  EXPECT_EQ(room.max_m, Eigen::Vector2d(4, 5));
  EXPECT_EQ(room.floor.friction, 0.7);
  EXPECT_EQ(room.floor.rolling_lever_arm_m, 0.003);
  EXPECT_EQ(room.robot, "bot");
  EXPECT_NEAR(room.map_T_robot.yaw(), M_PI / 2, 1e-12);
  ASSERT_EQ(room.objects.size(), 2U);
  EXPECT_EQ(room.objects[0].id, "cart_1");
  EXPECT_EQ(room.objects[0].model, "cart");
  EXPECT_EQ(room.objects[0].tag_offset, 10);
  EXPECT_NEAR(room.objects[0].map_T_object.yaw(), -M_PI / 4, 1e-12);
  EXPECT_EQ(room.objects[1].tag_offset, 0);
  ASSERT_TRUE(room.goal);
  EXPECT_EQ(room.goal->x(), 3.0);
  ASSERT_EQ(room.boxes.size(), 2U);
  EXPECT_EQ(room.boxes[0].box.size_m, Eigen::Vector3d(6, 0.1, 1));
  EXPECT_LT((room.boxes[1].map_T_box * Eigen::Vector3d(1, 0, 0) -
             Eigen::Vector3d(std::cos(M_PI / 6), 0.5, 0.7))
                .norm(),
            1e-12);
}

TEST_F(LoadWorldModel, readsWhatLiesOnAnObject) {
  const std::string where = "yaw_deg: -45, tag_offset: 10";
  const auto with = [&](const std::string& load) {
    return replaced(smallWorldYaml(), where, where + ", load: " + load);
  };
  const WorldModel room = load(with("{mass_kg: 40, xy: [0.1, -0.2]}"));
  ASSERT_TRUE(room.objects[0].load);
  EXPECT_EQ(room.objects[0].load->mass_kg, 40.0);
  EXPECT_EQ(room.objects[0].load->object_p_centre_m, Eigen::Vector2d(0.1, -0.2));
  EXPECT_FALSE(room.objects[0].load->height_m);
  EXPECT_EQ(room.objects[0].load->size_m, Load().size_m);
  EXPECT_FALSE(room.objects[1].load);
  const WorldModel all =
      load(with("{mass_kg: 5, xy: [0, 0], height_m: 0.7, size_m: [0.1, 0.2, 0.3]}"));
  EXPECT_EQ(all.objects[0].load->height_m, 0.7);
  EXPECT_EQ(all.objects[0].load->size_m, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(errorWith(where, where + ", load: {mass_kg: 81, xy: [0, 0]}"),
            "objects[0].load.mass_kg: is 81; must be a number in [0, 80]");
  EXPECT_EQ(errorWith(where, where + ", load: {mass_kg: nan, xy: [0, 0]}"),
            "objects[0].load.mass_kg: is not finite; must be a number in [0, 80]");
  EXPECT_EQ(errorWith(where, where + ", load: {mass_kg: 8}"),
            "objects[0].load.xy: must be a list of 2 finite numbers");
}

TEST_F(LoadWorldModel, saysWhereItComesFrom) {
  EXPECT_EQ(load(smallWorldYaml()).where(), (folder_.path() / "room.yaml").string());
  WorldModel made;
  made.name = "made";
  EXPECT_EQ(made.where(), "world made");
}

TEST_F(LoadWorldModel, refusesIdsWithOddCharacters) {
  const std::string rule =
      "' is no good id; must be 1 to 64 letters, digits, '_', '-' or '.', the first a letter or "
      "digit";
  for (const char* id : {"cart 1", "cart/1", "/cart", "-cart", "Stühl", "a,b", "a'b", "~x", "$x"}) {
    const std::string text = errorWith("id: cart_1", "id: \"" + std::string(id) + "\"");
    EXPECT_EQ(text.rfind("objects[0].id: '", 0), 0U) << text;
    EXPECT_NE(text.find(rule), std::string::npos) << text;
  }
  EXPECT_NE(errorWith("id: cart_1", "id: \"cart\\n1\""), "");
  EXPECT_NE(errorWith("id: cart_1", "id: \"\""), "");
  EXPECT_NE(errorWith("id: cart_1", "id: " + std::string(65, 'x')), "");
  EXPECT_EQ(errorWith("id: cart_1", "id: Cart-1.b_" + std::string(50, 'x')), "");
}

TEST_F(LoadWorldModel, needsNeitherGoalNorFloorNorFurniture) {
  const WorldModel room =
      load("bounds: {min: [0, 0], max: [1, 1]}\nrobot: {model: bot, xy: [0.5, 0.5], yaw_deg: 0}\n");
  EXPECT_FALSE(room.goal);
  EXPECT_TRUE(room.objects.empty());
  EXPECT_EQ(room.floor.friction, Floor().friction);
}

TEST_F(LoadWorldModel, containsItsBordersAndNothingThatIsNotFinite) {
  const WorldModel room = load(smallWorldYaml());
  EXPECT_TRUE(room.contains(Pose2(-2, 5, 0)));
  EXPECT_FALSE(room.contains(Pose2(-2.001, 5, 0)));
  EXPECT_FALSE(room.contains(Pose2(0, 5.001, 0)));
  EXPECT_FALSE(room.contains(Pose2(std::nan(""), 0, 0)));
  EXPECT_FALSE(room.contains(Pose2(0, 0, std::nan(""))));
}

TEST_F(LoadWorldModel, refusesPosesOutside) {
  EXPECT_EQ(errorWith("xy: [1, 2]", "xy: [1, 7]"),
            "objects[0].xy: (1, 7) is outside of the world; must be within (-2, -3) to (4, 5)");
  EXPECT_EQ(errorWith("xy: [-1, 0]", "xy: [-9, 0]"),
            "robot.xy: (-9, 0) is outside of the world; must be within (-2, -3) to (4, 5)");
  EXPECT_EQ(errorWith("xy: [3, 3]", "xy: [30, 3]"),
            "goal.xy: (30, 3) is outside of the world; must be within (-2, -3) to (4, 5)");
}

TEST_F(LoadWorldModel, refusesNamesTakenTwice) {
  EXPECT_EQ(errorWith("id: cart_2", "id: cart_1"),
            "objects[1].id: 'cart_1' is taken; names must differ");
  EXPECT_EQ(errorWith("id: cart_2", "id: robot"),
            "objects[1].id: 'robot' is taken; names must differ");
  EXPECT_EQ(errorWith("id: cart_2", "id: wall"),
            "objects[1].id: 'wall' is taken; names must differ");
  EXPECT_EQ(errorWith("name: table", "name: wall"),
            "boxes[1].name: 'wall' is taken; names must differ");
}

TEST_F(LoadWorldModel, refusesBadNumbersAndUnknownKeys) {
  EXPECT_EQ(errorWith("xy: [1, 2]", "xy: [nan, 2]"),
            "objects[0].xy: is not finite; must be a list of 2 finite numbers");
  EXPECT_EQ(errorWith("yaw_deg: -45", "yaw_deg: nan"),
            "objects[0].yaw_deg: is not finite; must be a number in [-360, 360]");
  EXPECT_EQ(errorWith("friction: 0.7", "friction: -1"),
            "floor.friction: is -1; must be a number in [0.01, 2]");
  EXPECT_EQ(errorWith("size_m: [1, 2, 0.1]", "size_m: [1, 0, 0.1]"),
            "boxes[1].size_m: must be above 0 and at most 500 m");
  EXPECT_EQ(errorWith("max: [4, 5]", "max: [4, -5]"),
            "bounds: max must exceed min by 0.5 m to 500 m, both within 1000 m of the origin");
  EXPECT_EQ(errorWith("tag_offset: 10", "tag_ofset: 10"), "objects[0]: unknown key(s): tag_ofset");
  EXPECT_EQ(errorWith("goal:", "gaol:"), "unknown key(s): gaol");
  EXPECT_EQ(errorWith("robot: {model: bot, xy: [-1, 0], yaw_deg: 90}\n", ""),
            "robot: is missing; must be a map");
}

TEST_F(LoadWorldModel, refusesWhatIsHugeOrFarAway) {
  EXPECT_EQ(errorWith("max: [4, 5]", "max: [499, 5]"),
            "bounds: max must exceed min by 0.5 m to 500 m, both within 1000 m of the origin");
  EXPECT_EQ(errorWith("size_m: [1, 2, 0.1]", "size_m: [1, 2, 501]"),
            "boxes[1].size_m: must be above 0 and at most 500 m");
  EXPECT_EQ(
      errorWith("xyz: [0, 0, 0.7]", "xyz: [1e9, 0, 0.7]"),
      "boxes[1].xyz: (1e+09, 0) is far outside of the world; must be within (-4, -5) to (6, 7)");
  EXPECT_EQ(
      errorWith("xyz: [0, 0, 0.7]", "xyz: [0, -5.1, 0.7]"),
      "boxes[1].xyz: (0, -5.1) is far outside of the world; must be within (-4, -5) to (6, 7)");
  EXPECT_EQ(errorWith("xyz: [0, 0, 0.7]", "xyz: [0, -4.9, 0.7]"), "");
  EXPECT_EQ(errorWith("xyz: [0, 0, 0.7]", "xyz: [0, 0, -101]"),
            "boxes[1].xyz: z is -101; must be within 100 m of 0");
}

TEST_F(LoadWorldModel, refusesFilesThatCannotBeReadOrAreCutOff) {
  const std::string yaml = smallWorldYaml();
  EXPECT_NE(inputErrorText([&] { load(yaml.substr(0, yaml.size() - 20)); }), "");
  EXPECT_NE(inputErrorText([&] { load(""); }), "");
  EXPECT_EQ(inputErrorText([] { loadWorldModel("/no/such.yaml"); }),
            "/no/such.yaml: cannot be read; is the path right?");
}

TEST_F(LoadWorldModel, readsWhereTheStaticMapIs) {
  const WorldModel room = load(smallWorldYaml() + "static_map: maps/floor.bt\n");
  EXPECT_EQ(room.static_map, folder_.path() / "maps/floor.bt");
  EXPECT_EQ(load(smallWorldYaml() + "static_map: /maps/floor.ot\n").static_map, "/maps/floor.ot");
  EXPECT_EQ(errorWith("goal:", "static_map: floor.png\ngoal:"),
            "static_map: is 'floor.png'; must be an OctoMap file, .bt or .ot");
}

class SaveWorldModel : public LoadWorldModel {
 protected:
  WorldModel reloaded(const WorldModel& world) {
    saveWorldModel(world, folder_.path() / "copy.yaml");
    return loadWorldModel(folder_.path() / "copy.yaml");
  }

  static bool same(const Pose2& a, const Pose2& b) {
    return a.position() == b.position() && a.yaw() == b.yaw();
  }

  static void expectSame(const WorldModel& a, const WorldModel& b) {
    EXPECT_EQ(a.min_m, b.min_m);
    EXPECT_EQ(a.max_m, b.max_m);
    EXPECT_EQ(a.floor.friction, b.floor.friction);
    EXPECT_EQ(a.floor.rolling_lever_arm_m, b.floor.rolling_lever_arm_m);
    EXPECT_EQ(a.robot, b.robot);
    EXPECT_EQ(a.static_map, b.static_map);
    EXPECT_TRUE(same(a.map_T_robot, b.map_T_robot));
    ASSERT_EQ(a.goal.has_value(), b.goal.has_value());
    EXPECT_TRUE(!a.goal || same(*a.goal, *b.goal));
    ASSERT_EQ(a.objects.size(), b.objects.size());
    for (std::size_t i = 0; i < a.objects.size(); ++i) {
      EXPECT_EQ(a.objects[i].id, b.objects[i].id);
      EXPECT_EQ(a.objects[i].model, b.objects[i].model);
      EXPECT_EQ(a.objects[i].tag_offset, b.objects[i].tag_offset);
      ASSERT_EQ(a.objects[i].load.has_value(), b.objects[i].load.has_value());
      if (!a.objects[i].load) continue;
      EXPECT_EQ(a.objects[i].load->mass_kg, b.objects[i].load->mass_kg);
      EXPECT_EQ(a.objects[i].load->object_p_centre_m, b.objects[i].load->object_p_centre_m);
      EXPECT_EQ(a.objects[i].load->height_m, b.objects[i].load->height_m);
      EXPECT_EQ(a.objects[i].load->size_m, b.objects[i].load->size_m);
      EXPECT_TRUE(same(a.objects[i].map_T_object, b.objects[i].map_T_object)) << a.objects[i].id;
    }
    ASSERT_EQ(a.boxes.size(), b.boxes.size());
    for (std::size_t i = 0; i < a.boxes.size(); ++i) {
      EXPECT_EQ(a.boxes[i].name, b.boxes[i].name);
      EXPECT_EQ(a.boxes[i].box.size_m, b.boxes[i].box.size_m);
      EXPECT_EQ(a.boxes[i].map_T_box.matrix(), b.boxes[i].map_T_box.matrix()) << a.boxes[i].name;
    }
  }
};

TEST_F(SaveWorldModel, givesBackEveryShippedWorldToTheLastBit) {
  const Catalog catalog = Catalog::standard();
  for (const std::string& name : catalog.worldNames()) {
    SCOPED_TRACE(name);
    const WorldModel world = catalog.world(name);
    expectSame(reloaded(world), world);
  }
}

TEST_F(SaveWorldModel, givesBackLoads) {
  WorldModel world = load(smallWorldYaml());
  world.objects[0].load = Load{40.0, {0.1, -0.3}, 0.7, {0.1, 0.2, 0.3}};
  world.objects[1].load = Load{0.1, {0.0, 0.0}, std::nullopt, {0.3, 0.3, 0.2}};
  expectSame(reloaded(world), world);
}

TEST_F(SaveWorldModel, givesBackOddNamesNumbersAndAngles) {
  Random random(4);
  std::string yaml = smallWorldYaml();  // ends with its boxes
  for (int i = 0; i < 200; ++i) {
    std::ostringstream box;
    box.precision(i % 2 == 0 ? 4 : 17);
    box << "  - {name: \"odd " << i << " \\\"'#:\", size_m: [" << random.uniform(1e-3, 1.0)
        << ", 0.1, 1], xyz: [1, 5, 0.5], yaw_deg: " << random.uniform(-360.0, 360.0) << "}\n";
    yaml += box.str();
  }
  const WorldModel world = load(yaml);
  const WorldModel again = reloaded(world);
  ASSERT_EQ(again.boxes.size(), world.boxes.size());
  for (std::size_t i = 0; i < world.boxes.size(); ++i) {
    EXPECT_EQ(again.boxes[i].name, world.boxes[i].name);
    EXPECT_EQ(again.boxes[i].box.size_m, world.boxes[i].box.size_m);
    EXPECT_LT((again.boxes[i].map_T_box.matrix() - world.boxes[i].map_T_box.matrix()).norm(),
              1e-12);
  }
}

TEST_F(SaveWorldModel, saysIfItCannotWrite) {
  const std::filesystem::path file = folder_.path() / "absent" / "room.yaml";
  EXPECT_EQ(inputErrorText([&] { saveWorldModel(load(smallWorldYaml()), file); }),
            file.string() + ": cannot be written: No such file or directory");
}

}  // namespace
}  // namespace casepush
