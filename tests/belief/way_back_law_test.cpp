// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "belief/episode.hpp"

/// The way by which the robot came.
namespace tactus::test {
namespace {

using belief::Belief;
using motion::JointPath;

const std::shared_ptr<const belief::Model>& model() {
  static const auto made =
      small_model(belief::Kind::particles, {.roll_width = 0.4, .position_width = 0.04, .most_cells = 50});
  return made;
}

double displacement(const JointVector& from, const JointVector& to) {
  return model()->task->known_world().displacement(from, to);
}

double longest_step(const JointPath& path) {
  double longest = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) longest = std::max(longest, displacement(path[i - 1], path[i]));
  return longest;
}

double longest_step(const Belief& belief) {
  double longest = 0.0;
  for (const belief::Trace& trace : belief.history()) longest = std::max(longest, longest_step(trace.path));
  return longest;
}

TEST(WayBack, LeadsFromTheConfigurationToTheStartFreeOfTheTarget) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    Episode episode(model(), seed);
    const JointVector start = episode.belief.configuration();
    for (int i = 0; i < 8; ++i) {
      const action::Action action =
          i % 4 == 3 ? insertion_at(*model()->task, episode.library, episode.belief.configuration(),
                                    geometry::pose_from(episode.truth))
                     : random_action(*model()->task, episode.library, episode.belief.configuration(), episode.rng);
      episode.belief.step(action, episode.world.execute(action, 0.0, i % 3 == 0 ? 0.6 : 1.0));
      const JointPath way = episode.belief.way_back();
      ASSERT_EQ(way.front(), episode.belief.configuration());
      ASSERT_EQ(way.back(), start);
      ASSERT_LE(longest_step(way), longest_step(episode.belief) + 1e-12);
      for (const JointVector& q : way) {
        ASSERT_TRUE(model()->task->known_world().is_free(q));
        ASSERT_FALSE(episode.world.touches(q)) << "seed " << seed << ", action " << i;
      }
    }
  }
}

/// A robot that goes back the way it came again and again would go twice as far each time.
TEST(WayBack, HasNoLoops) {
  for (const std::uint64_t seed : {11u, 12u, 13u}) {
    Episode episode(model(), seed);
    for (int i = 0; i < 6; ++i) {
      episode.step();
      JointPath way = episode.belief.way_back();
      for (std::size_t at = 0; at < way.size(); ++at)
        ASSERT_EQ(std::count(way.begin(), way.end(), way[at]), 1) << "seed " << seed << ", waypoint " << at;
      const action::Action back = action_along(*model()->task, way);
      episode.belief.step(back, episode.world.execute(back));
    }
    EXPECT_EQ(episode.belief.way_back().size(), 1u);
  }
}

TEST(WayBack, EndsWhereTheRobotWasPutByHand) {
  Episode episode(model(), 5);
  for (int i = 0; i < 4; ++i) episode.step();
  const JointVector jogged = model()->task->scene().start + joints({0.001, 0.002, 0.003, 0.01, 0.0, 0.0});
  episode.belief.set_configuration(jogged);
  EXPECT_EQ(episode.belief.way_back(), JointPath{jogged});
  for (int i = 0; i < 4; ++i) {
    episode.step();
    EXPECT_EQ(episode.belief.way_back().front(), episode.belief.configuration());
    EXPECT_EQ(episode.belief.way_back().back(), jogged);
  }
}

TEST(WayBack, IsTheConfigurationBeforeAnythingWasDone) {
  const Belief belief(model(), model()->task->scene().start);
  EXPECT_EQ(belief.way_back(), JointPath{belief.configuration()});
}

}  // namespace
}  // namespace tactus::test
