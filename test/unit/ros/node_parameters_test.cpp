#include "casepush/ros/node_parameters.h"

#include <gtest/gtest.h>

#include <cmath>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

using XmlRpc::XmlRpcValue;

template <typename Load>
std::string problems(Load load, const XmlRpcValue& values) {
  try {
    load(ParameterReader(values, "node"), Catalog::standard());
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

XmlRpcValue office() {
  XmlRpcValue values;
  values["world"] = std::string("office");
  return values;
}

TEST(NodeParameters, everyNodeLoadsWithItsDefaults) {
  EXPECT_EQ(problems(loadSimNodeParameters, office()), "");
  EXPECT_EQ(problems(loadPerceptionNodeParameters, office()), "");
  EXPECT_EQ(problems(loadPlannerNodeParameters, office()), "");
  EXPECT_EQ(problems(loadExecutorNodeParameters, office()), "");
  EXPECT_EQ(problems(loadLearnerNodeParameters, office()), "");
  EXPECT_EQ(problems(loadDemoNodeParameters, office()), "");
}

TEST(NodeParameters, everyNodeRefusesUnknownParameters) {
  XmlRpcValue values = office();
  values["sped"] = 1;
  EXPECT_TRUE(contains(problems(loadSimNodeParameters, values), "unknown parameter sped"));
  EXPECT_TRUE(contains(problems(loadPerceptionNodeParameters, values), "unknown parameter sped"));
  EXPECT_TRUE(contains(problems(loadPlannerNodeParameters, values), "unknown parameter sped"));
  EXPECT_TRUE(contains(problems(loadExecutorNodeParameters, values), "unknown parameter sped"));
  EXPECT_TRUE(contains(problems(loadLearnerNodeParameters, values), "unknown parameter sped"));
  EXPECT_TRUE(contains(problems(loadDemoNodeParameters, values), "unknown parameter sped"));
}

TEST(NodeParameters, namesWorldThatDoesNotExist) {
  XmlRpcValue values;
  values["world"] = std::string("atlantis");
  EXPECT_TRUE(contains(problems(loadSimNodeParameters, values), "atlantis"));
  EXPECT_TRUE(contains(problems(loadPerceptionNodeParameters, values), "atlantis"));
}

TEST(NodeParameters, takesObjectsFromAList) {
  XmlRpcValue values;
  values["objects"][0]["id"] = std::string("chair_7");
  values["objects"][0]["model"] = std::string("office_chair");
  values["objects"][0]["tag_offset"] = 20;
  const Furnishing furnishing =
      loadPerceptionNodeParameters(ParameterReader(values, "node"), Catalog::standard()).furnishing;
  ASSERT_EQ(furnishing.instances.size(), 1U);
  EXPECT_EQ(furnishing.instances[0].tag_offset, 20);
  ASSERT_NE(furnishing.instance("chair_7"), nullptr);
  EXPECT_EQ(furnishing.instance("chair_7")->model.name, "office_chair");
  EXPECT_EQ(furnishing.instance("chair_8"), nullptr);
  EXPECT_EQ(furnishing.models.count("office_chair"), 1U);
}

TEST(NodeParameters, refusesBadObjectLists) {
  XmlRpcValue neither;
  neither.setSize(0);
  EXPECT_TRUE(contains(problems(loadPerceptionNodeParameters, XmlRpcValue()), "exactly one"));
  XmlRpcValue both = office();
  both["objects"][0]["id"] = std::string("a");
  EXPECT_TRUE(contains(problems(loadPerceptionNodeParameters, both), "exactly one"));
  XmlRpcValue twice;
  for (int i = 0; i < 2; ++i) {
    twice["objects"][i]["id"] = std::string("a");
    twice["objects"][i]["model"] = std::string("office_chair");
  }
  EXPECT_TRUE(contains(problems(loadPerceptionNodeParameters, twice), "two entries"));
  XmlRpcValue pose;
  pose["objects"][0]["id"] = std::string("a");
  pose["objects"][0]["model"] = std::string("office_chair");
  pose["objects"][0]["xy"] = 1;
  EXPECT_TRUE(contains(problems(loadPerceptionNodeParameters, pose), "'xy' is no valid entry"));
}

TEST(NodeParameters, simulatorTakesACasterModel) {
  XmlRpcValue values = office();
  values["caster_model"] = std::string("planar");
  const SimNodeParameters parameters =
      loadSimNodeParameters(ParameterReader(values, "node"), Catalog::standard());
  EXPECT_EQ(parameters.simulator.caster_model, CasterModel::kPlanar);
  values["caster_model"] = std::string("flat");
  EXPECT_TRUE(contains(problems(loadSimNodeParameters, values), "there is no \"flat\""));
}

TEST(NodeParameters, sensorsAreSwitchedByName) {
  XmlRpcValue values = office();
  values["disabled_sensors"] = std::string("left scanner");
  values["exact_sensors"] = std::string(" odometry ");
  const RobotModel robot =
      loadSimNodeParameters(ParameterReader(values, "node"), Catalog::standard()).robot;
  EXPECT_TRUE(robot.cameras[0].switches.enabled);
  EXPECT_FALSE(robot.cameras[1].switches.enabled);
  EXPECT_FALSE(robot.range_sensors[0].switches.enabled);
  EXPECT_FALSE(robot.odometry.switches.noise);
  EXPECT_TRUE(robot.localisation.switches.noise);
  values["disabled_sensors"] = std::string("left sonar localisation");
  const std::string text = problems(loadSimNodeParameters, values);
  EXPECT_TRUE(contains(text, "disabled_sensors: robot cobot: has no sensor 'sonar'")) << text;
  EXPECT_TRUE(contains(text, "localisation cannot be disabled")) << text;
}

TEST(NodeParameters, boundsOfTheCoreApply) {
  XmlRpcValue values = office();
  values["push"]["alpha"] = 2.0;
  values["planner"]["goal_bias"] = -0.5;
  const std::string text = problems(loadExecutorNodeParameters, values);
  EXPECT_TRUE(contains(text, "alpha")) << text;
  EXPECT_TRUE(contains(text, "goal_bias")) << text;
}

TEST(NodeParameters, mapsComeFromOneSource) {
  const auto load = [](const XmlRpcValue& values) {
    return loadPlannerNodeParameters(ParameterReader(values, "node"), Catalog::standard()).map;
  };
  XmlRpcValue values = office();
  EXPECT_EQ(load(values).source, MapOrigin::kSurvey);
  values["map_source"] = std::string("map");
  EXPECT_EQ(load(values).source, MapOrigin::kGrid);
  values["map_source"] = std::string("none");
  EXPECT_TRUE(contains(problems(loadPlannerNodeParameters, values), "needs live_map"));
  values["live_map"] = true;
  EXPECT_EQ(load(values).source, MapOrigin::kNone);
  values["map_file"] = std::string("x.bt");
  EXPECT_TRUE(contains(problems(loadPlannerNodeParameters, values), "left out if map_file"));
  values["map_source"] = std::string("");
  EXPECT_EQ(load(values).source, MapOrigin::kFile);
  EXPECT_FALSE(load(values).resolution_m.has_value());
  values["map_resolution"] = 0.1;
  EXPECT_EQ(load(values).resolution_m, 0.1);
  values["live"]["max_range"] = -1.0;
  EXPECT_TRUE(contains(problems(loadPlannerNodeParameters, values), "max_range_m"));
}

TEST(NodeParameters, demoTakesGoalsInDegrees) {
  XmlRpcValue values = office();
  values["goal"] = std::string("1 2 90");
  values["object"] = std::string("office_chair");
  const DemoNodeParameters parameters =
      loadDemoNodeParameters(ParameterReader(values, "node"), Catalog::standard());
  EXPECT_EQ(parameters.object_id, parameters.world.objects.front().id);
  EXPECT_DOUBLE_EQ(parameters.map_T_goal.y(), 2.0);
  EXPECT_NEAR(parameters.map_T_goal.yaw(), M_PI / 2, 1e-12);
}

TEST(NodeParameters, demoRefusesBadGoalsAndObjects) {
  XmlRpcValue values = office();
  values["goal"] = std::string("1 2");
  EXPECT_TRUE(contains(problems(loadDemoNodeParameters, values), "three finite numbers"));
  values["goal"] = std::string("1 2 nan");
  EXPECT_TRUE(contains(problems(loadDemoNodeParameters, values), "three finite numbers"));
  values["goal"] = std::string("1 2 3");
  values["object"] = std::string("piano");
  EXPECT_TRUE(contains(problems(loadDemoNodeParameters, values), "piano"));
}

}  // namespace
}  // namespace casepush
