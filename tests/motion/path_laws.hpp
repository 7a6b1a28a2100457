// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "contact/known_world.hpp"
#include "motion/path.hpp"

/// What holds for every path, whoever made it.
namespace tactus::test {

/// The longest way that a vertex of any link moves between two configurations, measured vertex by vertex.
inline double vertex_motion(const robot::RobotModel& model, const robot::JointVector& from,
                            const robot::JointVector& to) {
  std::vector<geometry::Pose> before, after;
  robot::forward(model, from, before);
  robot::forward(model, to, after);
  double longest = 0.0;
  for (std::size_t i = 0; i < model.links.size(); ++i)
    for (const geometry::Mesh& shape : model.links[i].shapes)
      for (const auto& vertex : shape.vertices)
        longest = std::max(longest, (before[i] * vertex - after[i] * vertex).norm());
  return longest;
}

inline void expect_free_in_steps(const contact::KnownWorld& world, const motion::JointPath& path, double step) {
  ASSERT_GE(path.size(), 2u);
  for (std::size_t i = 0; i < path.size(); ++i) {
    EXPECT_TRUE(world.is_free(path[i])) << "waypoint " << i << ": " << world.describe_collision(path[i]);
    if (i > 0) {
      EXPECT_LE(vertex_motion(world.model(), path[i - 1], path[i]), step * (1.0 + 1e-9)) << "to waypoint " << i;
    }
  }
}

}  // namespace tactus::test
