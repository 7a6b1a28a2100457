// SPDX-License-Identifier: BSD-3-Clause
#include "belief/contains.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::belief {
namespace {

constexpr double tolerance = 1e-6;  // m and rad

bool near(double angle, double centre, double half) {
  return std::abs(scene::nearest_angle(angle, centre) - centre) <= half + tolerance;
}

bool turns_within(const PoseVector& centre, const PoseVector& half, double roll, double pitch, double yaw) {
  return near(roll, centre[3], half[3]) && near(pitch, centre[4], half[4]) && near(yaw, centre[5], half[5]);
}

}  // namespace

bool covers(const PoseVector& centre, const PoseVector& half, const Pose& base_from_target) {
  constexpr double pi = std::numbers::pi;
  const PoseVector v = geometry::pose_vector(base_from_target);
  for (int d = 0; d < 3; ++d)
    if (!(std::abs(v[d] - centre[d]) <= half[d] + tolerance)) return false;
  if (std::abs(std::cos(v[4])) < tolerance) {  // only one sum of roll and yaw is there to be seen
    const double sign = v[4] > 0.0 ? -1.0 : 1.0;
    return near(v[4], centre[4], half[4]) && near(v[3] + sign * v[5], centre[3] + sign * centre[5], half[3] + half[5]);
  }
  return turns_within(centre, half, v[3], v[4], v[5]) || turns_within(centre, half, v[3] + pi, pi - v[4], v[5] + pi);
}

bool contains(const Belief& belief, const Pose& base_from_target) {
  if (belief.phase() == Phase::voxels) {
    const scene::Prior& prior = belief.task().scene().prior;
    PoseVector half = prior.width;
    for (double& width : half) width *= 0.5;
    return covers(prior.centre, half, base_from_target) && !belief.voxels().excludes(base_from_target, 0.0);
  }
  const CellBelief& cells = belief.cells();
  return std::any_of(cells.cells().begin(), cells.cells().end(),
                     [&](const Cell& cell) { return covers(cell.centre, cells.half_width(cell), base_from_target); });
}

}  // namespace tactus::belief
