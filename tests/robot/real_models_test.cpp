// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>

#include "robot/kinematics.hpp"
#include "robots.hpp"

namespace tactus::robot {
namespace {

/// A folder of robots made by others, where packages lie beside the URDF.
ModelSource source_of(const std::string& folder, const std::string& name) {
  const std::filesystem::path root = testing::models_folder() / folder;
  return {root / (name + ".urdf"), {{"", root}}, {}};
}

#define SKIP_WITHOUT(source) \
  if (!std::filesystem::exists((source).urdf)) GTEST_SKIP() << (source).urdf << " is not there"

Pose dh(double a, double d, double alpha, double theta) {
  Pose pose = Pose::Identity();
  pose.rotate(Eigen::AngleAxisd(theta, geometry::Vector3::UnitZ()));
  pose.translate(geometry::Vector3(a, 0.0, d));
  pose.rotate(Eigen::AngleAxisd(alpha, geometry::Vector3::UnitX()));
  return pose;
}

Pose ur10e_by_table(const JointVector& q) {
  constexpr double half = std::numbers::pi / 2.0;
  constexpr double a[] = {0.0, -0.6127, -0.57155, 0.0, 0.0, 0.0}, d[] = {0.1807, 0.0, 0.0, 0.17415, 0.11985, 0.11655};
  constexpr double alpha[] = {half, 0.0, 0.0, half, -half, 0.0};
  Pose pose(Eigen::AngleAxisd(std::numbers::pi,
                              geometry::Vector3::UnitZ()));  // the maker's base_link stands the other way round
  for (int i = 0; i < 6; ++i) pose = pose * dh(a[i], d[i], alpha[i], q[i]);
  return pose;
}

TEST(RealModels, Ur10eStandsWhereItsDhTableSays) {
  ModelSource source = source_of("ur10e", "ur10e");
  SKIP_WITHOUT(source);
  source.srdf = testing::models_folder() / "ur10e/ur10e.srdf";
  const RobotModel model = load_model(source);
  ASSERT_EQ(model.dof(), 6);
  EXPECT_EQ(model.joints[2].name, "elbow_joint");
  EXPECT_NEAR(model.joints[2].upper, std::numbers::pi, 1e-6);
  EXPECT_NEAR(model.joints[0].velocity, 2.0943951, 1e-6);
  EXPECT_FALSE(model.disabled_pairs.empty());
  support::Rng rng(21);
  for (int trial = 0; trial < 100; ++trial) {
    const JointVector q = testing::random_inside(model, rng);
    const Pose pose = forward(model, q, model.find_link("tool0"));
    EXPECT_LT((pose.matrix() - ur10e_by_table(q).matrix()).cwiseAbs().maxCoeff(), 1e-6);
  }
}

TEST(RealModels, Ur10eShapesAreSolids) {
  const ModelSource source = source_of("ur10e", "ur10e");
  SKIP_WITHOUT(source);
  const RobotModel model = load_model(source);
  std::size_t shapes = 0;
  for (const Link& link : model.links) {
    for (const geometry::Mesh& mesh : link.shapes) {
      EXPECT_TRUE(geometry::is_closed(mesh)) << link.name;
      EXPECT_GT(geometry::signed_volume(mesh), 0.0) << link.name;
      ++shapes;
    }
  }
  EXPECT_EQ(shapes, 7u);
}

TEST(RealModels, PandasSecondFingerFollowsTheFirst) {
  const ModelSource source = source_of("panda_moveit", "panda");
  SKIP_WITHOUT(source);
  const RobotModel model = load_model(source);
  ASSERT_EQ(model.dof(), 8);
  EXPECT_EQ(model.joints[7].name, "panda_finger_joint1");
  const auto gap = [&](double opening) {
    JointVector q = JointVector::Zero(8);
    q[7] = opening;
    const Pose left = forward(model, q, model.find_link("panda_leftfinger")),
               right = forward(model, q, model.find_link("panda_rightfinger"));
    return (left.translation() - right.translation()).norm();
  };
  EXPECT_NEAR(gap(0.04) - gap(0.0), 0.08, 1e-9);
  EXPECT_EQ(model.links[static_cast<std::size_t>(model.find_link("panda_leftfinger"))].shapes.size(), 1u);
}

TEST(RealModels, PandaReachesItsPosesWithSevenJoints) {
  const ModelSource source = source_of("panda_moveit", "panda");
  SKIP_WITHOUT(source);
  const RobotModel model = load_model(source);
  const int hand = model.find_link("panda_hand");
  support::Rng rng(22);
  int found = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const Pose target = forward(model, testing::random_inside(model, rng), hand);
    found += !inverse_all(model, hand, target, testing::random_inside(model, rng), rng).empty();
  }
  EXPECT_GE(found, 19);
}

TEST(RealModels, Gen3sEmptyMeshIsAnErrorThatNamesLinkAndFile) {
  const ModelSource source = source_of("gen3_badstl", "kinovaGen3");
  SKIP_WITHOUT(source);
  try {
    load_model(source);
    FAIL() << "was accepted";
  } catch (const support::Error& error) {
    const std::string text = error.what();
    EXPECT_EQ(error.status(), support::Status::bad_robot);
    EXPECT_NE(text.find("EndEffector_Link.STL"), std::string::npos) << text;
    EXPECT_NE(text.find("link EndEffector_Link"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace tactus::robot
