// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/path.hpp"

namespace tactus::motion {

using geometry::Vector3;

namespace {

// How the accelerations are shared between speeding up along the path and turning with it. Just beside a sharp corner
// the path is up to three times as fast as in it (speeding up within the interval, as long as the limits below allow),
// so a turn may take three times its share.
constexpr double tangential_share = 1.0 / 2.0;
constexpr double turning_share = 1.0 / 6.0;

// The path parameter s is the length in metres of (tool position, metres_per_radian * joints): it grows wherever
// anything moves.
constexpr double metres_per_radian = 0.1;

// One half of the way between two distinct waypoints; halves, so that a path of two waypoints has a place to be fast
// at.
struct Half {
  double length = 0.0;      // of s
  JointVector joint_slope;  // dq/ds
  Vector3 tool_slope;       // d(tool position)/ds, m per unit of s
  Pace pace;
};

const Pace& pace_at(const std::vector<PacedSegment>& segments, std::size_t waypoint) {
  static const Pace usual;
  const Pace* pace = segments.empty() ? &usual : &segments.front().pace;
  for (const PacedSegment& segment : segments)
    if (segment.first <= waypoint) pace = &segment.pace;
  return *pace;
}

// Two halves for each interval whose ends differ; `interval_of[k]` is the interval that halves 2k and 2k+1 make up.
std::vector<Half> halves_of(const robot::RobotModel& model, int tool_link, const JointPath& path,
                            const std::vector<PacedSegment>& segments, std::vector<std::size_t>& interval_of) {
  std::vector<Half> halves;
  Vector3 tool = robot::forward(model, path.front(), tool_link).translation();
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const Vector3 next_tool = robot::forward(model, path[i + 1], tool_link).translation();
    const JointVector turn = path[i + 1] - path[i];
    const Vector3 move = next_tool - tool;
    const double length = std::hypot(move.norm(), metres_per_radian * turn.norm());
    tool = next_tool;
    if (length == 0.0) continue;
    const Half half{0.5 * length, turn / length, move / length, pace_at(segments, i)};
    halves.insert(halves.end(), 2, half);
    interval_of.push_back(i);
  }
  return halves;
}

// The greatest ds/dt that the joints' velocities and the tool's speed allow.
double speed_limit(const robot::RobotModel& model, const Half& half) {
  double limit = std::numeric_limits<double>::infinity();
  for (Eigen::Index j = 0; j < half.joint_slope.size(); ++j)
    limit = std::min(limit, model.joints[static_cast<std::size_t>(j)].velocity / std::abs(half.joint_slope[j]));
  return std::min(limit, half.pace.speed / half.tool_slope.norm());
}

// The greatest d2s/dt2 on each half; the neighbouring intervals' slopes count too, or one joint's corner could be left
// by another's greater limit.
std::vector<double> acceleration_limits(const std::vector<Half>& halves) {
  std::vector<double> own, limits;
  for (const Half& half : halves) {
    const double joints = half.pace.joint_acceleration / half.joint_slope.cwiseAbs().maxCoeff();
    const double tool = half.pace.acceleration / half.tool_slope.norm();
    own.push_back(tangential_share * std::min(joints, tool));
  }
  for (std::size_t k = 0; k < own.size(); ++k) {
    const auto first = own.begin() + static_cast<std::ptrdiff_t>(k - std::min<std::size_t>(k, 2));
    const auto last = own.begin() + static_cast<std::ptrdiff_t>(std::min(k + 3, own.size()));
    limits.push_back(*std::min_element(first, last));
  }
  return limits;
}

// The greatest ds/dt at which the path may change its direction from that of `before` to that of `after`.
double turning_limit(const Half& before, const Half& after) {
  const double span = before.length + after.length;  // between the middles of the two intervals
  const double joint_turn = (after.joint_slope - before.joint_slope).cwiseAbs().maxCoeff();
  const double tool_turn = (after.tool_slope - before.tool_slope).norm();
  const double joints = std::min(before.pace.joint_acceleration, after.pace.joint_acceleration) / joint_turn;
  const double tool = std::min(before.pace.acceleration, after.pace.acceleration) / tool_turn;
  return std::sqrt(turning_share * span * std::min(joints, tool));
}

// ds/dt at the ends of the halves: below every limit, at rest at both ends of the path, and then a pass forwards and
// one backwards.
std::vector<double> node_speeds(const robot::RobotModel& model, const std::vector<Half>& halves) {
  std::vector<double> speeds(halves.size() + 1, 0.0);
  for (std::size_t k = 1; k < halves.size(); ++k)
    speeds[k] = std::min(
        {speed_limit(model, halves[k - 1]), speed_limit(model, halves[k]), turning_limit(halves[k - 1], halves[k])});
  const std::vector<double> accelerations = acceleration_limits(halves);
  const auto reachable = [&](double speed, std::size_t half) {
    return std::sqrt(speed * speed + 2.0 * accelerations[half] * halves[half].length);
  };
  for (std::size_t k = 1; k < speeds.size(); ++k) speeds[k] = std::min(speeds[k], reachable(speeds[k - 1], k - 1));
  for (std::size_t k = halves.size(); k-- > 0;) speeds[k] = std::min(speeds[k], reachable(speeds[k + 1], k));
  return speeds;
}

}  // namespace

std::vector<double> time_path(const robot::RobotModel& model, int tool_link, const JointPath& path,
                              const std::vector<PacedSegment>& segments) {
  std::vector<double> times(path.size(), 0.0);
  if (path.size() < 2) return times;
  std::vector<std::size_t> interval_of;
  const std::vector<Half> halves = halves_of(model, tool_link, path, segments, interval_of);
  const std::vector<double> speeds = node_speeds(model, halves);
  std::vector<double> durations(path.size() - 1, 0.0);
  for (std::size_t k = 0; k < halves.size(); ++k)
    durations[interval_of[k / 2]] += 2.0 * halves[k].length / (speeds[k] + speeds[k + 1]);
  for (std::size_t i = 0; i < durations.size(); ++i) times[i + 1] = times[i] + durations[i];
  return times;
}

}  // namespace tactus::motion
