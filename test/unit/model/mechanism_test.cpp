#include "casepush/model/mechanism.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

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
            "link 'body': has a mass of 0 kg; must be above 0 and at most 10000 kg");
  EXPECT_EQ(errorWith(mass, R"(<mass value="-1"/>)"),
            "link 'body': has a mass of -1 kg; must be above 0 and at most 10000 kg");
  for (const char* value : {"nan", "inf", "1e999", "1,5", "ten"}) {
    EXPECT_EQ(errorWith(mass, std::string("<mass value=\"") + value + "\"/>"),
              std::string("is not a valid URDF: Inertial: mass [") + value +
                  "] is not a float; Could not parse inertial element for Link [body]");
  }
}

TEST_F(LoadMechanism, refusesBadInertias) {
  EXPECT_EQ(
      errorWith(kBodyInertia, R"(ixx="0.5" ixy="0" ixz="0" iyy="0.6" iyz="0" izz="-0.7")"),
      "link 'body': has an inertia that is not positive definite (principal moments -0.7, 0.5, "
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
      "the sum of the others (principal moments 0.5, 0.6, 1.2 kg m^2)");
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
            "joint 'swivel': dynamics friction: is -0.1; must be in [0, 10000] Nm");
  EXPECT_EQ(errorWith(R"(friction="0.1")", R"(friction="0.1" damping="2")"),
            "joint 'swivel': dynamics damping: is not supported; must be 0, use friction");
}

TEST_F(LoadMechanism, refusesBadShapes) {
  const std::string sphere = R"(<sphere radius="0.05"/>)";
  EXPECT_EQ(errorWith(sphere, R"(<mesh filename="package://casepush/wheel.stl"/>)"),
            "link 'fixed_wheel': has a mesh for collision; must be boxes, cylinders or spheres");
  EXPECT_EQ(errorWith(sphere, R"(<sphere radius="0"/>)"),
            "link 'fixed_wheel': collision: has a size that is not above 0 and at most 10 m");
  EXPECT_EQ(errorWith(sphere, R"(<sphere radius="-1"/>)"),
            "link 'fixed_wheel': collision: has a size that is not above 0 and at most 10 m");
  EXPECT_NE(errorWith(sphere, R"(<sphere radius="nan"/>)"), "");
  EXPECT_NE(errorWith(sphere, ""), "");
  EXPECT_NE(errorWith(R"(<origin xyz="-0.2 0 0.05"/>)", R"(<origin xyz="-0.2 nan 0.05"/>)"), "");
}

TEST_F(LoadMechanism, refusesHugeNumbers) {
  EXPECT_EQ(errorWith(R"(<mass value="10"/>)", R"(<mass value="1e300"/>)"),
            "link 'body': has a mass of 1e+300 kg; must be above 0 and at most 10000 kg");
  EXPECT_EQ(errorWith(kBodyInertia, R"(ixx="1e7" ixy="0" ixz="0" iyy="1e7" iyz="0" izz="1e7")"),
            "link 'body': inertia: must be finite and at most 1e+06 kg m^2");
  EXPECT_EQ(errorWith(R"(friction="0.1")", R"(friction="1e5")"),
            "joint 'swivel': dynamics friction: is 100000; must be in [0, 10000] Nm");
  const std::string too_large = "collision: has a size that is not above 0 and at most 10 m";
  EXPECT_EQ(errorWith(R"(<sphere radius="0.05"/>)", R"(<sphere radius="1e6"/>)"),
            "link 'fixed_wheel': " + too_large);
  EXPECT_EQ(errorWith(R"(<cylinder radius="0.05" length="0.04"/>)",
                      R"(<cylinder radius="0.05" length="1e6"/>)"),
            "link 'wheel': " + too_large);
  const std::string box = R"(<box size="0.6 0.4 0.2"/></geometry>
    </collision>)";
  EXPECT_EQ(errorWith(box, R"(<box size="0.6 11 0.2"/></geometry></collision>)"),
            "link 'body': " + too_large);
}

TEST_F(LoadMechanism, refusesWhatIsFarAway) {
  const std::string bound = "; each must be within 10 m of 0";
  const std::string joint = R"(<origin xyz="-0.2 0 0.05"/>)";
  EXPECT_NE(errorWith(joint, R"(<origin xyz="-1e6 0 0.05"/>)").find(bound), std::string::npos);
  EXPECT_EQ(errorWith(joint, R"(<origin xyz="0 11 0"/>)"),
            "joint 'fixed_axle': origin: is ( 0 11  0)" + bound);
  EXPECT_EQ(errorWith(R"(<origin xyz="0 0 0.3"/>)", R"(<origin xyz="0 11 0"/>)"),
            "link 'body': collision origin: is ( 0 11  0)" + bound);
  EXPECT_EQ(errorWith(R"(<origin xyz="0.1 0 0.3"/>)", R"(<origin xyz="0 11 0"/>)"),
            "link 'body': inertial origin: is ( 0 11  0)" + bound);
  const std::string swivel = R"(<origin xyz="0.2 0.1 0.12"/>)";
  EXPECT_EQ(errorOf(replaced(replaced(smallCartUrdf(), swivel, R"(<origin xyz="9 0 0"/>)"),
                             R"(<origin xyz="-0.02 0 -0.07"/>)", R"(<origin xyz="2 0 0"/>)")),
            "link 'wheel': place in the root link: is (11  0  0)" + bound);
}

TEST_F(LoadMechanism, normalisesEvenHugeAxes) {
  const Mechanism cart =
      loadMechanism(folder_.write("cart.urdf", replaced(smallCartUrdf(), R"(<axis xyz="0 0 1"/>)",
                                                        R"(<axis xyz="0 0 1e300"/>)")));
  EXPECT_EQ(cart.joints[cart.linkIndex("fork") - 1].axis, Eigen::Vector3d::UnitZ());
}

TEST_F(LoadMechanism, refusesAFifoWithoutWaiting) {
  const std::string fifo = (folder_.path() / "fifo.urdf").string();
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_EQ(inputErrorText([&] { loadMechanism(fifo); }),
            fifo + ": cannot be read; is the path right, and is it a URDF file?");
}

TEST_F(LoadMechanism, refusesTwoRoots) {
  EXPECT_NE(errorWith(R"(<child link="fork"/>)", R"(<child link="fixed_wheel"/>)"), "");
}

}  // namespace
}  // namespace casepush
