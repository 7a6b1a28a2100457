// SPDX-License-Identifier: BSD-3-Clause
#include "robot/model.hpp"

#include <limits>

#include "robots.hpp"

namespace tactus::robot {
namespace {

using testing::CaptureLog;
using testing::load_text;
using testing::TempFolder;

const Link& link_of(const RobotModel& model, const std::string& name) {
  return model.links[static_cast<std::size_t>(model.find_link(name))];
}

TEST(Model, ParentsComeBeforeChildrenAndSiblingsInTheFilesOrder) {
  const RobotModel model = load_text(testing::tree_urdf);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    names.push_back(model.links[i].name);
    EXPECT_LT(model.links[i].parent, static_cast<int>(i));
  }
  EXPECT_EQ(names, (std::vector<std::string>{"base", "post", "upper", "slide", "wrist", "follower", "tip", "finger"}));
  EXPECT_EQ(model.links[0].parent, -1);
  EXPECT_EQ(model.find_link("nobody"), -1);
}

TEST(Model, IndependentJointsHaveTheirLimits) {
  const RobotModel model = load_text(testing::tree_urdf);
  ASSERT_EQ(model.dof(), 3);
  EXPECT_EQ(model.joints[0].name, "shoulder");
  EXPECT_EQ(model.joints[0].lower, -2.0);
  EXPECT_EQ(model.joints[0].upper, 2.5);
  EXPECT_EQ(model.joints[1].kind, JointKind::prismatic);
  EXPECT_EQ(model.joints[2].kind, JointKind::continuous);
  EXPECT_EQ(model.joints[2].upper, std::numeric_limits<double>::infinity());
  EXPECT_EQ(model.joints[2].velocity, 3.0);
}

TEST(Model, MimicJointsFollow) {
  const RobotModel model = load_text(testing::tree_urdf);
  const Link& follower = link_of(model, "follower");
  EXPECT_EQ(follower.joint, 0);
  EXPECT_EQ(follower.multiplier, -0.5);
  EXPECT_EQ(follower.offset, 0.3);
  EXPECT_EQ(link_of(model, "finger").joint, 1);
}

TEST(Model, AMimicJointsVelocityLimitHoldsForWhatItFollows) {
  std::string urdf = testing::tree_urdf;
  const std::string echo = R"(velocity="9" effort="1"/><mimic joint="shoulder")";
  urdf.replace(urdf.find(echo), 12, R"(velocity="0.1")");
  EXPECT_DOUBLE_EQ(load_text(urdf).joints[0].velocity, 0.2);
}

TEST(Model, AMimicJointThatLeavesItsOwnLimitsIsLogged) {
  const CaptureLog log;
  load_text(testing::tree_urdf);
  EXPECT_EQ(log.text(), "");
  std::string urdf = testing::tree_urdf;
  urdf.replace(urdf.find(R"(lower="-9" upper="9")"), 20, R"(lower="-9" upper="1")");
  load_text(urdf);
  EXPECT_NE(log.text().find("joint echo leaves its own limits"), std::string::npos) << log.text();
}

TEST(Model, AxesAreUnitVectors) {
  const RobotModel model = load_text(testing::tree_urdf);
  EXPECT_TRUE(link_of(model, "upper").axis.isApprox(geometry::Vector3(0.0, 0.6, 0.8)));
}

TEST(Model, ShapesAreClosedAndInTheLinksFrame) {
  const RobotModel model = load_text(testing::tree_urdf);
  const Link& upper = link_of(model, "upper");
  ASSERT_EQ(upper.shapes.size(), 1u);
  EXPECT_TRUE(geometry::is_closed(upper.shapes[0]));
  const geometry::Box box = geometry::bounds(upper.shapes[0]);
  EXPECT_NEAR(box.low.z(), 0.0, 1e-12);
  EXPECT_NEAR(box.high.z(), 0.4, 1e-12);
  EXPECT_TRUE(link_of(model, "post").shapes.empty());
}

TEST(Model, CollisionOriginsTurnShapes) {
  const RobotModel model =
      load_text(R"(<robot name="r"><link name="a"><collision><origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/>
    <geometry><box size="0.4 0.2 0.1"/></geometry></collision></link></robot>)");
  const geometry::Box box = geometry::bounds(model.links[0].shapes[0]);
  EXPECT_TRUE(box.size().isApprox(geometry::Vector3(0.2, 0.4, 0.1), 1e-9));
  EXPECT_TRUE(box.centre().isApprox(geometry::Vector3(1.0, 0.0, 0.0), 1e-9));
}

TEST(Model, TabsAndNewlinesDivideNumbersToo) {
  const RobotModel model = load_text(
      "<robot name='r'><link name='a'><collision><geometry><box "
      "size='1\t2\n3'/></geometry></collision></link></robot>");
  ASSERT_EQ(model.links[0].shapes.size(), 1u);
  EXPECT_TRUE(geometry::bounds(model.links[0].shapes[0]).size().isApprox(geometry::Vector3(1.0, 2.0, 3.0)));
}

TEST(Model, VisualsAndExtensionsMayBeAnything) {
  EXPECT_NO_THROW(
      load_text(R"(<robot name="r"><gazebo><x y="z"/></gazebo><link name="a"><inertial><mass value="heavy"/></inertial>
    <visual><geometry><capsule/></geometry></visual></link></robot>)"));
}

TEST(Model, AContinuousJointWithoutLimitsGetsAVelocityAndAWarning) {
  const CaptureLog log;
  const RobotModel model = load_text(R"(<robot name="r"><link name="a"/><link name="b"/>
    <joint name="wheel" type="continuous"><parent link="a"/><child link="b"/></joint></robot>)");
  EXPECT_EQ(model.joints[0].velocity, 1.0);
  EXPECT_NE(log.text().find("wheel states no velocity limit"), std::string::npos);
}

TEST(Model, ARobotWithoutCollisionsIsLegalButLogged) {
  const CaptureLog log;
  EXPECT_EQ(load_text("<robot name='ghost'><link name='a'/></robot>").dof(), 0);
  EXPECT_NE(log.text().find("ghost has no collision shapes"), std::string::npos);
}

TEST(Model, TheSrdfsDisabledPairsAreSortedAndUnique) {
  const TempFolder folder;
  const auto urdf = folder.write("robot.urdf", testing::tree_urdf);
  const auto srdf = folder.write("robot.srdf", R"(<robot name="tree"><disable_collisions link1="upper" link2="base"/>
    <disable_collisions link1="base" link2="post"/><disable_collisions link1="base" link2="upper"/></robot>)");
  EXPECT_EQ(load_model({urdf, {}, srdf}).disabled_pairs, (std::vector<LinkPair>{{0, 1}, {0, 2}}));
}

}  // namespace
}  // namespace tactus::robot
