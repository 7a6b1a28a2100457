// SPDX-License-Identifier: BSD-3-Clause
#include "action/task.hpp"

#include <gtest/gtest.h>

#include "belief/small_task.hpp"
#include "support/error.hpp"

/// What is const in a search.
namespace tactus::test {
namespace {

using support::Status;

Status status_of(const scene::Scene& scene, std::string* text = nullptr) {
  try {
    action::Task task(scene, {});
  } catch (const support::Error& error) {
    if (text != nullptr) *text = error.what();
    return error.status();
  }
  return Status::ok;
}

TEST(Task, HomeIsFreeWithTheToolInFrontOfThePrior) {
  const auto task = small_task();
  EXPECT_TRUE(task->known_world().is_free(task->home()));
  const Pose search_from_tool = task->frame().base_from_search.inverse() * task->base_from_tool(task->home());
  EXPECT_NEAR(search_from_tool.translation().z(), task->frame().standoff, 1e-5);
}

TEST(Task, AStartThatCollidesIsNamedAsSuch) {
  scene::Scene scene = small_scene();
  scene.start = joints({0.46, 0.125, 0, 0, 0, 0});
  std::string text;
  EXPECT_EQ(status_of(scene, &text), Status::start_in_collision);
  EXPECT_NE(text.find("post"), std::string::npos) << text;
  scene.start = joints({1.0, 0, 0, 0, 0, 0});
  EXPECT_EQ(status_of(scene, &text), Status::start_in_collision);
  EXPECT_NE(text.find("x_joint"), std::string::npos) << text;
}

TEST(Task, APriorOutOfReachIsNamedAsSuch) {
  scene::Scene scene = small_scene();
  scene.prior.centre[0] = 2.0;
  EXPECT_EQ(status_of(scene), Status::prior_unreachable);
}

TEST(Task, CostWeighsMetresAndRadians) {
  const auto task = small_task();
  EXPECT_DOUBLE_EQ(task->cost({2.0, 0.0}), 2.0);
  EXPECT_DOUBLE_EQ(task->cost({0.0, 2.0}), 0.1);
}

TEST(Task, APostureIsFreeAndPutsTheToolThere) {
  const auto task = small_task();
  support::Rng rng(1);
  for (int i = 0; i < 50; ++i) {
    const Vector3 position(rng.uniform(-0.04, 0.04), rng.uniform(-0.04, 0.04),
                           task->frame().standoff - rng.uniform(0.0, 0.02));
    const Pose wanted = task->frame().base_from_tool(position, rng.uniform(-0.5, 0.5));
    const auto q = task->posture(wanted, task->home());
    ASSERT_TRUE(q);
    EXPECT_TRUE(task->known_world().is_free(*q));
    EXPECT_LT((task->base_from_tool(*q).translation() - wanted.translation()).norm(), 2e-6);
    EXPECT_LT(geometry::angle_between(task->base_from_tool(*q), wanted), 2e-6);
  }
  Pose inside_the_post = Pose::Identity();
  inside_the_post.translation() = Vector3(0.46, 0.125, 0.0);
  EXPECT_FALSE(task->posture(inside_the_post, task->home()));
}

TEST(Task, OfAToolInMillimetresSaysWhatIsMissing) {
  scene::Scene scene = small_scene();
  for (Vector3& v : scene.tool.vertices) v *= 1000.0;
  std::string text;
  EXPECT_EQ(status_of(scene, &text), Status::bad_mesh);
  EXPECT_EQ(text.rfind("tool: ", 0), 0u) << text;
  EXPECT_NE(text.find("scale of 0.001"), std::string::npos) << text;
}

}  // namespace
}  // namespace tactus::test
