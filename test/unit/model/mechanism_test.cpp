#include "casepush/model/mechanism.h"

#include <gtest/gtest.h>

#include "common/input_error_text.h"
#include "common/temporary_folder.h"
#include "model/small_models.h"

namespace casepush {
namespace {

constexpr char kBodyInertia[] = R"(ixx="0.5" ixy="0" ixz="0" iyy="0.6" iyz="0" izz="0.7")";

class LoadMechanism : public testing::Test {
 protected:
  /// Message for the cart with `from` replaced by `to`, without the file's name.
  std::string errorWith(const std::string& from, const std::string& to) {
    return errorOf(replaced(smallCartUrdf(), from, to));
  }

  std::string errorOf(const std::string& urdf) {
    const std::string file = folder_.write("cart.urdf", urdf).string();
    const std::string text = inputErrorText([&] { loadMechanism(file); });
    if (text.empty()) {
      return text;
    }
    EXPECT_EQ(text.rfind(file + ": ", 0), 0U) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text.substr(file.size() + 2);
  }

  TemporaryFolder folder_;
};

TEST_F(LoadMechanism, readsTheTreeDepthFirst) {
  const Mechanism cart = loadMechanism(folder_.write("cart.urdf", smallCartUrdf()));
  ASSERT_EQ(cart.links.size(), 4U);
  ASSERT_EQ(cart.joints.size(), 3U);
  EXPECT_EQ(cart.name, "cart");
  EXPECT_EQ(cart.links[0].name, "body");
  EXPECT_EQ(cart.linkIndex("body"), 0);
  EXPECT_EQ(cart.linkIndex("lid"), -1);
  const int fork = cart.linkIndex("fork");
  const int wheel = cart.linkIndex("wheel");
  EXPECT_EQ(wheel, fork + 1);
  for (std::size_t i = 0; i < cart.joints.size(); ++i) {
    EXPECT_LE(cart.joints[i].parent_link, static_cast<int>(i));
  }
  EXPECT_EQ(cart.joints[fork - 1].name, "swivel");
  EXPECT_EQ(cart.joints[fork - 1].type, JointType::kContinuous);
  EXPECT_EQ(cart.joints[fork - 1].friction_nm, 0.1);
  EXPECT_EQ(cart.joints[wheel - 1].parent_link, fork);
  EXPECT_NEAR(cart.massKg(), 11.6, 1e-12);
  EXPECT_LT((cart.root_T_link(wheel).translation() - Eigen::Vector3d(0.18, 0.1, 0.05)).norm(),
            1e-12);
}

TEST_F(LoadMechanism, readsInertiaShapesAndColour) {
  const Mechanism cart = loadMechanism(folder_.write("cart.urdf", smallCartUrdf()));
  const Link& body = cart.links[0];
  EXPECT_EQ(body.mass_kg, 10.0);
  EXPECT_EQ(body.link_T_inertial.translation(), Eigen::Vector3d(0.1, 0.0, 0.3));
  EXPECT_EQ(body.inertia_kgm2.diagonal(), Eigen::Vector3d(0.5, 0.6, 0.7));
  ASSERT_EQ(body.collision.size(), 1U);
  EXPECT_EQ(std::get<Box>(body.collision[0].shape).size_m, Eigen::Vector3d(0.6, 0.4, 0.2));
  EXPECT_EQ(body.collision[0].part, "body");
  EXPECT_NEAR(body.colour_rgba.x(), 0.9, 1e-6);
}

TEST_F(LoadMechanism, refusesFilesThatAreNoUrdf) {
  const std::string urdf = smallCartUrdf();
  for (const std::string& bad : {std::string(), std::string("hello"), std::string("<cart/>"),
                                 urdf.substr(0, urdf.size() / 2), urdf.substr(0, urdf.size() - 12),
                                 std::string("\0\1\2", 3)}) {
    EXPECT_EQ(errorOf(bad).rfind("is not a valid URDF: ", 0), 0U) << bad;
  }
  EXPECT_EQ(inputErrorText([] { loadMechanism("/no/such.urdf"); }),
            "/no/such.urdf: cannot be read; is the path right, and is it a URDF file?");
  EXPECT_NE(inputErrorText([&] { loadMechanism(folder_.path()); }), "");
}

TEST_F(LoadMechanism, printsNothing) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  errorOf("<cart/>");
  errorWith(R"(<mass value="10"/>)", R"(<mass value="nan"/>)");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST_F(LoadMechanism, refusesALinkWithoutInertia) {
  std::string urdf = smallCartUrdf();
  const std::size_t begin = urdf.find("<inertial>");
  const std::string end = "</inertial>";
  urdf.erase(begin, urdf.find(end) + end.size() - begin);
  EXPECT_EQ(errorOf(urdf), "link 'body': has no inertia; every link needs an <inertial> element");
}

TEST_F(LoadMechanism, refusesBadMasses) {
  const std::string mass = R"(<mass value="10"/>)";
  EXPECT_EQ(errorWith(mass, R"(<mass value="0"/>)"),
            "link 'body': has a mass of 0 kg; must be finite and above 0");
  EXPECT_EQ(errorWith(mass, R"(<mass value="-1"/>)"),
            "link 'body': has a mass of -1 kg; must be finite and above 0");
  for (const char* value : {"nan", "inf", "1e999", "1,5", "ten"}) {
    EXPECT_EQ(errorWith(mass, std::string("<mass value=\"") + value + "\"/>"),
              std::string("is not a valid URDF: Inertial: mass [") + value +
                  "] is not a float; Could not parse inertial element for Link [body]");
  }
}

TEST_F(LoadMechanism, refusesBadInertias) {
  EXPECT_EQ(
      errorWith(kBodyInertia, R"(ixx="0.5" ixy="0" ixz="0" iyy="0.6" iyz="0" izz="-0.7")"),
      "link 'body': has an inertia that is not positive definite (principal moments -0.7  0.5  "
      "0.6 kg m^2)");
  EXPECT_EQ(errorWith(kBodyInertia, R"(ixx="0.5" ixy="0" ixz="0" iyy="0.5" iyz="0" izz="0")")
                .rfind("link 'body': has an inertia that is not positive definite", 0),
            0U);
  EXPECT_EQ(errorWith(kBodyInertia, R"(ixx="0.5" ixy="9" ixz="0" iyy="0.5" iyz="0" izz="0.5")")
                .rfind("link 'body': has an inertia that is not positive definite", 0),
            0U);
  EXPECT_EQ(
      errorWith(kBodyInertia, R"(ixx="0.5" ixy="0" ixz="0" iyy="0.6" iyz="0" izz="1.2")"),
      "link 'body': has an inertia that no body can have: the largest principal moment exceeds "
      "the sum of the others (principal moments 0.5 0.6 1.2 kg m^2)");
  EXPECT_NE(errorWith(kBodyInertia, R"(ixx="nan" ixy="0" ixz="0" iyy="0.6" iyz="0" izz="0.7")"),
            "");
}

TEST_F(LoadMechanism, refusesUnsupportedJoints) {
  const std::string axle = R"(<joint name="fixed_axle" type="continuous">)";
  EXPECT_EQ(errorWith(axle, R"(<joint name="fixed_axle" type="floating">)"),
            "joint 'fixed_axle': has an unsupported type; must be fixed or continuous");
  EXPECT_EQ(errorWith(axle, R"(<joint name="fixed_axle" type="revolute">
                                <limit lower="-1" upper="1" effort="1" velocity="1"/>)"),
            "joint 'fixed_axle': has an unsupported type; must be fixed or continuous");
  EXPECT_NE(errorWith(axle, R"(<joint name="fixed_axle" type="magic">)"), "");
  EXPECT_EQ(errorWith(R"(<axis xyz="0 0 1"/>)", R"(<axis xyz="0 0 0"/>)"),
            "joint 'swivel': has no axis; must be a finite vector other than zero");
  EXPECT_EQ(errorWith(R"(friction="0.1")", R"(friction="-0.1")"),
            "joint 'swivel': dynamics friction: must be finite and not negative [Nm]");
  EXPECT_EQ(errorWith(R"(friction="0.1")", R"(friction="0.1" damping="2")"),
            "joint 'swivel': dynamics damping: is not supported; must be 0, use friction");
}

TEST_F(LoadMechanism, refusesBadShapes) {
  const std::string sphere = R"(<sphere radius="0.05"/>)";
  EXPECT_EQ(errorWith(sphere, R"(<mesh filename="package://casepush/wheel.stl"/>)"),
            "link 'fixed_wheel': has a mesh for collision; must be boxes, cylinders or spheres");
  EXPECT_EQ(errorWith(sphere, R"(<sphere radius="0"/>)"),
            "link 'fixed_wheel': collision: has a size that is not finite and above 0 m");
  EXPECT_EQ(errorWith(sphere, R"(<sphere radius="-1"/>)"),
            "link 'fixed_wheel': collision: has a size that is not finite and above 0 m");
  EXPECT_NE(errorWith(sphere, R"(<sphere radius="nan"/>)"), "");
  EXPECT_NE(errorWith(sphere, ""), "");
  EXPECT_NE(errorWith(R"(<origin xyz="-0.2 0 0.05"/>)", R"(<origin xyz="-0.2 nan 0.05"/>)"), "");
}

TEST_F(LoadMechanism, refusesTwoRoots) {
  EXPECT_NE(errorWith(R"(<child link="fork"/>)", R"(<child link="fixed_wheel"/>)"), "");
}

}  // namespace
}  // namespace casepush
