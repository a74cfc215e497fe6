#include "casepush/model/object_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/input_error_text.h"
#include "common/temporary_folder.h"
#include "model/small_models.h"

namespace casepush {
namespace {

class LoadObjectModel : public testing::Test {
 protected:
  ObjectModel load(const std::string& urdf, const std::string& yaml) {
    folder_.write("cart.yaml", yaml);
    return loadObjectModel(folder_.write("cart.urdf", urdf));
  }

  /// Message without the folder's name.
  std::string errorOf(const std::string& urdf, const std::string& yaml) {
    const std::string text = inputErrorText([&] { load(urdf, yaml); });
    const std::string prefix = folder_.path().string() + "/";
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text.rfind(prefix, 0) == 0 ? text.substr(prefix.size()) : text;
  }

  std::string urdfError(const std::string& from, const std::string& to) {
    return errorOf(replaced(smallCartUrdf(), from, to), smallCartYaml());
  }

  std::string yamlError(const std::string& from, const std::string& to) {
    return errorOf(smallCartUrdf(), replaced(smallCartYaml(), from, to));
  }

  /// The cart's body alone, standing on the floor.
  static std::string bodyUrdf() {
    const std::string urdf =
        replaced(smallCartUrdf(), R"(<origin xyz="0 0 0.3"/>)", R"(<origin xyz="0 0 0.1"/>)");
    return urdf.substr(0, urdf.find(R"(  <link name="fork">)")) + "</robot>\n";
  }

  TemporaryFolder folder_;
};

TEST_F(LoadObjectModel, findsCastersAndFixedWheels) {
  const ObjectModel cart = load(smallCartUrdf(), smallCartYaml());
  EXPECT_EQ(cart.name, "cart");
  EXPECT_EQ(cart.class_name, "cart");
  ASSERT_EQ(cart.casters.size(), 2U);
  const bool is_first_fixed = cart.casters[0].swivel_joint < 0;
  const Caster& fixed = cart.casters[is_first_fixed ? 0 : 1];
  const Caster& swivelling = cart.casters[is_first_fixed ? 1 : 0];
  EXPECT_EQ(cart.mechanism.joints[fixed.wheel_joint].name, "fixed_axle");
  EXPECT_EQ(fixed.wheel_radius_m, 0.05);
  EXPECT_EQ(fixed.trail_m, 0.0);
  EXPECT_EQ(cart.mechanism.joints[swivelling.wheel_joint].name, "axle");
  EXPECT_EQ(cart.mechanism.joints[swivelling.swivel_joint].name, "swivel");
  EXPECT_EQ(swivelling.wheel_radius_m, 0.05);
  EXPECT_NEAR(swivelling.trail_m, 0.02, 1e-12);
}

TEST_F(LoadObjectModel, locksSwivels) {
  const ObjectModel cart = load(smallCartUrdf(), smallCartYaml() + "locked_swivels: [swivel]\n");
  ASSERT_EQ(cart.casters.size(), 2U);
  for (const Caster& caster : cart.casters) {
    EXPECT_EQ(caster.swivel_joint, -1);
  }
  const int swivel = cart.mechanism.linkIndex("fork") - 1;
  EXPECT_EQ(cart.mechanism.joints[swivel].type, JointType::kFixed);
  for (const char* name : {"axle", "absent"}) {
    EXPECT_EQ(
        errorOf(smallCartUrdf(), smallCartYaml() + "locked_swivels: [" + std::string(name) + "]\n"),
        "cart.yaml: locked_swivels: '" + std::string(name) +
            "' is no swivel; must name continuous joints with upright axes");
  }
}

TEST_F(LoadObjectModel, readsSurfaceFriction) {
  EXPECT_EQ(load(smallCartUrdf(), smallCartYaml()).surface_friction, 0.6);
  EXPECT_EQ(load(smallCartUrdf(), smallCartYaml() + "surface_friction: 0.2\n").surface_friction,
            0.2);
  EXPECT_EQ(errorOf(smallCartUrdf(), smallCartYaml() + "surface_friction: -1\n"),
            "cart.yaml: surface_friction: is -1; must be a number in [0, 2]");
}

TEST_F(LoadObjectModel, sweepsEachSwivellingCaster) {
  const ObjectModel cart = load(smallCartUrdf(), smallCartYaml());
  ASSERT_EQ(cart.solid.size(), 3U);
  const PlacedShape& swept = cart.solid.back();
  EXPECT_EQ(swept.part, "fork");
  const auto& cylinder = std::get<Cylinder>(swept.shape);
  EXPECT_NEAR(cylinder.radius_m, std::hypot(0.02 + 0.05, 0.02), 1e-5);
  EXPECT_NEAR(cylinder.length_m, 0.1, 1e-12);
  EXPECT_LT((swept.frame_T_shape.translation() - Eigen::Vector3d(0.2, 0.1, 0.05)).norm(), 1e-12);
  EXPECT_TRUE(swept.frame_T_shape.linear().isIdentity(1e-12));
  EXPECT_NEAR(cart.radius_m, std::hypot(0.3, 0.2), 1e-4);
}

TEST_F(LoadObjectModel, computesTheGyrationRadiusAboutTheOrigin) {
  const ObjectModel cart = load(smallCartUrdf(), smallCartYaml());
  const double inertia_kgm2 = 0.7 + 10 * 0.01 + 0.001 + 0.4 * 0.05 + 0.001 +
                              0.6 * (0.18 * 0.18 + 0.01) + 0.001 + 0.6 * 0.04;
  EXPECT_NEAR(cart.gyration_radius_m, std::sqrt(inertia_kgm2 / 11.6), 1e-12);
}

TEST_F(LoadObjectModel, readsTags) {
  const ObjectModel cart = load(smallCartUrdf(), smallCartYaml());
  ASSERT_EQ(cart.tags.size(), 2U);
  EXPECT_EQ(cart.tags[0].id, 4);
  EXPECT_EQ(cart.tags[0].size_m, 0.1);
  const Eigen::Matrix3d rotation = cart.tags[0].object_T_tag.linear();
  EXPECT_LT((rotation.col(0) - Eigen::Vector3d::UnitY()).norm(), 1e-12) << "right, seen from +x";
  EXPECT_LT((rotation.col(1) + Eigen::Vector3d::UnitZ()).norm(), 1e-12) << "down";
  EXPECT_LT((rotation.col(2) + Eigen::Vector3d::UnitX()).norm(), 1e-12) << "into the tag";
}

TEST_F(LoadObjectModel, refusesObjectsWithoutCastersUnlessTheySlide) {
  EXPECT_EQ(errorOf(bodyUrdf(), smallCartYaml()),
            "cart.urdf: has no casters; an object needs wheels (continuous joints with level axes) "
            "or `sliding: true` in its YAML");
  const ObjectModel crate = load(bodyUrdf(), smallCartYaml() + "sliding: true\n");
  EXPECT_TRUE(crate.casters.empty());
  EXPECT_EQ(errorOf(smallCartUrdf(), smallCartYaml() + "sliding: true\n"),
            "cart.urdf: has casters, but its YAML says `sliding: true`");
}

TEST_F(LoadObjectModel, refusesCastersThatDoNotTouchTheFloor) {
  const std::string axle = R"(<origin xyz="-0.02 0 -0.07"/>)";
  EXPECT_EQ(
      urdfError(axle, R"(<origin xyz="-0.02 0 -0.04"/>)"),
      "cart.urdf: joint 'axle': has a wheel that does not touch the floor: its lowest point is "
      "at z = 0.03 m, must be within 0.01 m of 0");
  EXPECT_NE(urdfError(axle, R"(<origin xyz="-0.02 0 -0.09"/>)"), "");
  EXPECT_EQ(urdfError(axle, R"(<origin xyz="-0.02 0 -0.065"/>)"), "");
}

TEST_F(LoadObjectModel, refusesOddCasters) {
  EXPECT_EQ(
      urdfError(R"(<axis xyz="0 0 1"/>)", R"(<axis xyz="0 1 1"/>)"),
      "cart.urdf: joint 'swivel': is neither a swivel (upright axis) nor a wheel (level axis)");
  EXPECT_EQ(urdfError(R"(<parent link="body"/>
    <child link="fixed_wheel"/>
    <origin xyz="-0.2 0 0.05"/>)",
                      R"(<parent link="wheel"/>
    <child link="fixed_wheel"/>
    <origin xyz="-0.2 0 0"/>)"),
            "cart.urdf: joint 'fixed_axle': hangs on more than one moving joint; must hang on none "
            "or on one swivel");
  const std::string fixed_axle = R"(<axis xyz="0 1 0"/>
  </joint>
</robot>)";
  EXPECT_EQ(urdfError(fixed_axle, R"(<axis xyz="0 1 1"/></joint></robot>)"),
            "cart.urdf: joint 'fixed_axle': is neither a swivel (upright axis) nor a wheel (level "
            "axis)");
  EXPECT_EQ(urdfError(fixed_axle, R"(<axis xyz="0 0 1"/></joint></robot>)"),
            "cart.urdf: joint 'fixed_axle': is a swivel without a wheel");
  const std::string no_wheel =
      "carries no wheel: link 'wheel' must have one collision shape, a cylinder or sphere around "
      "the "
      "joint's axis";
  const std::string cylinder = R"(<cylinder radius="0.05" length="0.04"/>)";
  EXPECT_EQ(urdfError(cylinder, R"(<box size="0.1 0.1 0.1"/>)"),
            "cart.urdf: joint 'axle': " + no_wheel);
  EXPECT_EQ(urdfError(R"(<origin rpy="1.5707963267948966 0 0"/>)", ""),
            "cart.urdf: joint 'axle': " + no_wheel);
}

TEST_F(LoadObjectModel, refusesObjectsBelowOrAboveTheFloor) {
  EXPECT_EQ(urdfError(R"(<box size="0.6 0.4 0.2"/></geometry>
    </collision>)",
                      R"(<box size="0.6 0.4 0.8"/></geometry></collision>)"),
            "cart.urdf: does not stand on the floor: its lowest point is at z = -0.1 m, must be "
            "within 0.01 m of 0");
  EXPECT_NE(errorOf(replaced(bodyUrdf(), R"(<origin xyz="0 0 0.1"/>)", R"(<origin xyz="0 0 1"/>)"),
                    smallCartYaml() + "sliding: true\n"),
            "");
}

TEST_F(LoadObjectModel, refusesBadTags) {
  EXPECT_EQ(yamlError("id: 5", "id: 4"), "cart.yaml: tags[1].id: 4 is taken by another tag");
  EXPECT_EQ(yamlError("id: 5", "id: 587"),
            "cart.yaml: tags[1].id: is 587; must be a number in [0, 586]");
  EXPECT_EQ(yamlError("size_m: 0.1", "size_m: 0"),
            "cart.yaml: tags[0].size_m: is 0; must be a number in [0.01, 1]");
  EXPECT_EQ(yamlError("xyz: [0.31, 0, 0.3]", "xyz: [nan, 0, 0.3]"),
            "cart.yaml: tags[0].xyz: is not finite; must be a list of 3 finite numbers");
  EXPECT_EQ(yamlError("xyz: [0.31, 0, 0.3]", "xyz: [0.31, 0, -1e6]"),
            "cart.yaml: tags[0].xyz: holds -1e+06; each must be within 10 m of 0");
  EXPECT_EQ(yamlError("rpy_deg: [-90, 0, 90]", "rpy_deg: [-90, 0, 1e300]"),
            "cart.yaml: tags[0].rpy_deg: holds 1e+300; each must be within 360 deg of 0");
  EXPECT_EQ(yamlError("size_m: 0.1", "size_m: 1e6"),
            "cart.yaml: tags[0].size_m: is 1e+06; must be a number in [0.01, 1]");
  EXPECT_EQ(errorOf(smallCartUrdf(), "class: cart\n"),
            "cart.yaml: tags: must list at least one tag");
  EXPECT_EQ(errorOf(smallCartUrdf(), "class: cart\ntags: []\n"),
            "cart.yaml: tags: must list at least one tag");
}

TEST_F(LoadObjectModel, refusesBadYaml) {
  EXPECT_EQ(yamlError("class: cart", "class: cart\ncolour: red"),
            "cart.yaml: unknown key(s): colour");
  EXPECT_EQ(yamlError("id: 4", "id: 4, side: front"), "cart.yaml: tags[0]: unknown key(s): side");
  EXPECT_EQ(yamlError("class: cart\n", ""), "cart.yaml: class: must be a non-empty text");
  const std::string urdf = folder_.write("alone.urdf", smallCartUrdf()).string();
  EXPECT_EQ(inputErrorText([&] { loadObjectModel(urdf); }),
            (folder_.path() / "alone.yaml").string() + ": cannot be read; is the path right?");
}

}  // namespace
}  // namespace casepush
