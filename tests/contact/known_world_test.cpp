// SPDX-License-Identifier: BSD-3-Clause
#include "contact/known_world.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "contact/plain_contact.hpp"
#include "contact/small_arm.hpp"
#include "support/error.hpp"

namespace tactus {
namespace {

using contact::KnownWorld;
using geometry::Mesh;
using geometry::Pose;
using robot::JointVector;
using test::joints;

Mesh box_at(const geometry::Vector3& size, const geometry::Vector3& centre) {
  return geometry::transformed(geometry::box_mesh(size), Pose(Eigen::Translation3d(centre)));
}

std::vector<Mesh> shelf() {
  return {box_at({0.3, 0.8, 0.03}, {0.6, 0.0, 0.3}), box_at({0.3, 0.8, 0.03}, {0.6, 0.0, 0.7}),
          box_at({0.03, 0.8, 0.7}, {0.75, 0.013, 0.5})};
}

const std::vector<std::string> shelf_names{"lower board", "upper board", "back"};

bool link_meets(const Mesh& obstacle, const robot::Link& link, const Pose& pose) {
  for (const Mesh& shape : link.shapes)
    if (test::plain_contact(geometry::transformed(shape, pose), obstacle)) return true;
  return false;
}

bool plainly_free(const KnownWorld& world, const std::vector<Mesh>& obstacles, const JointVector& q) {
  std::vector<Pose> poses;
  robot::forward(world.model(), q, poses);
  const auto& links = world.model().links;
  for (std::size_t i = 1; i < links.size(); ++i)
    for (const Mesh& obstacle : obstacles)
      if (link_meets(obstacle, links[i], poses[i])) return false;
  for (const auto& [first, second] : world.checked_pairs()) {
    const auto a = static_cast<std::size_t>(first), b = static_cast<std::size_t>(second);
    for (const Mesh& shape : links[a].shapes)
      if (link_meets(geometry::transformed(shape, poses[a]), links[b], poses[b])) return false;
  }
  return true;
}

TEST(KnownWorld, AgreesWithThePlainAnswerAtRandomConfigurations) {
  const KnownWorld world(test::small_arm(), shelf(), shelf_names);
  support::Rng rng(7);
  int free = 0;
  for (int i = 0; i < 250; ++i) {
    const JointVector q = test::random_configuration(world.model(), rng);
    ASSERT_EQ(world.is_free(q), plainly_free(world, shelf(), q))
        << q.transpose() << ": " << world.describe_collision(q);
    ASSERT_EQ(world.is_free(q), world.describe_collision(q).empty());
    free += world.is_free(q);
  }
  EXPECT_GT(free, 50);
  EXPECT_LT(free, 230);
}

TEST(KnownWorld, ChecksAllPairsButAdjacentAndRigidOnes) {
  const KnownWorld world(test::small_arm(), {}, {});
  const auto pair = [&](const char* a, const char* b) {
    return robot::LinkPair(world.model().find_link(a), world.model().find_link(b));
  };
  const auto& pairs = world.checked_pairs();
  const auto checked = [&](const char* a, const char* b) {
    return std::find(pairs.begin(), pairs.end(), pair(a, b)) != pairs.end();
  };
  EXPECT_FALSE(checked("base", "turret"));
  EXPECT_FALSE(checked("wrist_2", "wrist_3"));
  EXPECT_FALSE(checked("wrist_3", "plate")) << "rigid, with the shapeless flange between";
  EXPECT_TRUE(checked("wrist_2", "plate")) << "the tool is not adjacent to the link before its carrier";
  EXPECT_TRUE(checked("base", "plate"));
  EXPECT_TRUE(checked("turret", "lower"));
  EXPECT_EQ(pairs.size(), 8u * 7 / 2 - 6 - 1) << "8 links with shapes, 6 joints, 1 rigid pair";
}

TEST(KnownWorld, SkipsPairsThatTheSrdfDisablesAndThatAlwaysCollide) {
  robot::RobotModel model = *test::small_arm();
  const int base = model.find_link("base"), upper = model.find_link("upper"), lower = model.find_link("lower");
  model.disabled_pairs = {{base, lower}};
  model.links[static_cast<std::size_t>(upper)].shapes.push_back(
      geometry::box_mesh({0.6, 0.6, 0.6}));  // always in the base
  const KnownWorld world(std::make_shared<robot::RobotModel>(model), {}, {});
  for (const auto& pair : world.checked_pairs()) {
    EXPECT_NE(pair, robot::LinkPair(base, lower));
    EXPECT_NE(pair, robot::LinkPair(base, upper));
  }
}

TEST(KnownWorld, ABodyInsideALinkIsACollision) {
  const test::Model arm = test::small_arm();
  const JointVector q = joints({0.4, 0.5, 0.3, 0.1, 0.2, 0.1});
  const Pose upper = robot::forward(*arm, q, arm->find_link("upper"));
  const Mesh pebble = box_at({0.02, 0.02, 0.02}, upper * geometry::Vector3(0.0, 0.0, 0.2));
  const KnownWorld world(arm, {pebble}, {"pebble"});
  EXPECT_FALSE(world.is_free(q));
  EXPECT_EQ(world.describe_collision(q), "upper with pebble");
  EXPECT_TRUE(world.is_free(joints({-0.4, 0.5, 0.3, 0.1, 0.2, 0.1})));
}

TEST(KnownWorld, AnArmInsideAClosedBodyCollidesAndInsideAnOpenOneDoesNot) {
  Mesh hall = geometry::box_mesh({5.0, 5.0, 5.0});
  const JointVector q = JointVector::Zero(6);
  EXPECT_FALSE(KnownWorld(test::small_arm(), {hall}, {"hall"}).is_free(q));
  hall.triangles.pop_back();
  EXPECT_TRUE(KnownWorld(test::small_arm(), {hall}, {"hall"}).is_free(q));
}

TEST(KnownWorld, OneShellOfAMeshInsideABodyIsACollision) {
  const test::Model arm = test::small_arm();
  const JointVector q = JointVector::Zero(6);
  const Pose lower = robot::forward(*arm, q, arm->find_link("lower"));
  Mesh dust = box_at({0.02, 0.02, 0.02}, {3.0, 0.0, 0.0});
  EXPECT_TRUE(KnownWorld(arm, {dust}, {"dust"}).is_free(q));
  geometry::append(dust, box_at({0.02, 0.02, 0.02}, lower * geometry::Vector3(0.003, 0.001, 0.15)));
  EXPECT_FALSE(KnownWorld(arm, {dust}, {"dust"}).is_free(q));
}

TEST(KnownWorld, TheLinkThatStandsFixedIsNotCheckedAgainstTheWorld) {
  const Mesh floor = box_at({2.0, 2.0, 0.02}, {0.0, 0.0, 0.0});
  EXPECT_TRUE(KnownWorld(test::small_arm(), {floor}, {"floor"}).is_free(JointVector::Zero(6)));
}

TEST(KnownWorld, WrongJointValuesAreNeverFreeAndAreNamed) {
  const KnownWorld world(test::small_arm(), {}, {});
  JointVector q = JointVector::Zero(6);
  EXPECT_TRUE(world.is_free(q));
  EXPECT_EQ(world.describe_collision(q), "");
  for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    q[2] = wrong;
    EXPECT_FALSE(world.is_free(q));
    EXPECT_EQ(world.describe_collision(q), "j3 is not a finite number");
  }
  q[2] = 2.9;
  EXPECT_FALSE(world.is_free(q));
  EXPECT_EQ(world.describe_collision(q), "j3 at 2.900000 outside [-2.800000, 2.800000]");
  EXPECT_FALSE(world.is_free(JointVector::Zero(5)));
  EXPECT_EQ(world.describe_collision(JointVector::Zero(5)), "found 5 joint values, expected 6");
}

TEST(KnownWorld, BadMeshesAreErrors) {
  const auto build = [](const Mesh& mesh) { KnownWorld(test::small_arm(), {mesh}, {"thing"}); };
  Mesh mesh = geometry::box_mesh({1.0, 1.0, 1.0});
  mesh.triangles[0][1] = 99;
  EXPECT_THROW(build(mesh), support::Error);
  mesh.triangles[0][1] = -1;
  EXPECT_THROW(build(mesh), support::Error);
  mesh = geometry::box_mesh({1.0, 1.0, 1.0});
  mesh.vertices[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(build(mesh), support::Error);
  EXPECT_THROW(build(Mesh{}), support::Error);
  EXPECT_THROW(build(Mesh{{{1.0, 0.0, 0.0}}, {{0, 0, 0}}}), support::Error);
  EXPECT_THROW(KnownWorld(test::small_arm(), shelf(), {"one name"}), support::Error);
}

TEST(KnownWorld, ReachHoldsEveryVertexOfTheLink) {
  const KnownWorld world(test::small_arm(), {}, {});
  const auto& links = world.model().links;
  ASSERT_EQ(world.link_reach().size(), links.size());
  for (std::size_t i = 0; i < links.size(); ++i)
    for (const Mesh& shape : links[i].shapes)
      for (const auto& vertex : shape.vertices) EXPECT_LE(vertex.norm(), world.link_reach()[i]);
}

TEST(KnownWorldUr10e, ShoulderAndSecondWristCanCollide) {
  const test::Model ur10e = test::makers_ur10e();
  if (!ur10e) GTEST_SKIP() << "the maker's UR10e is not on this machine";
  const KnownWorld world(ur10e, {}, {});
  const robot::LinkPair pair(ur10e->find_link("shoulder_link"), ur10e->find_link("wrist_2_link"));
  const auto& pairs = world.checked_pairs();
  EXPECT_NE(std::find(pairs.begin(), pairs.end(), pair), pairs.end());
  EXPECT_TRUE(world.is_free(joints({0.0, -1.57, 0.0, -1.57, 0.0, 0.0}))) << "the maker's 'up'";
  EXPECT_EQ(world.describe_collision(joints({0.0, -1.57, 3.0, 0.0, 0.0, 0.0})).empty(), false) << "folded onto itself";
}

}  // namespace
}  // namespace tactus
