// SPDX-License-Identifier: BSD-3-Clause
#include "motion/path.hpp"

namespace tactus::motion {

ToolTravel tool_travel(const robot::RobotModel& model, int tool_link, const JointPath& path) {
  ToolTravel travel;
  if (path.empty()) return travel;
  Pose before = robot::forward(model, path.front(), tool_link);
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Pose after = robot::forward(model, path[i], tool_link);
    travel.metres += (after.translation() - before.translation()).norm();
    travel.radians += geometry::angle_between(before, after);
    before = after;
  }
  return travel;
}

}  // namespace tactus::motion
