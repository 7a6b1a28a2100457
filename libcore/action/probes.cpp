// SPDX-License-Identifier: BSD-3-Clause
#include "action/probes.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::action {
namespace {

using geometry::Box;

constexpr double layer_spacing = 0.1;  // m between sweeps at different depths
constexpr int most_layers = 3;
constexpr double short_of_end = 0.01;  // m that a poke stays off the region's far side
constexpr double beside = 0.005;       // m between the tool and the region where a sweep goes down

/// Evenly spaced offsets over a range: its middle if it is narrower than the spacing, both ends inset by half a spacing
/// otherwise.
std::vector<double> lines(double low, double high, double spacing, int most) {
  const int count = std::clamp(static_cast<int>(std::lround((high - low) / spacing)), 1, most);
  std::vector<double> offsets;
  for (int i = 0; i < count; ++i) offsets.push_back(low + (high - low) * (i + 0.5) / count);
  return offsets;
}

/// Tool positions of a sweep along axis `along` (0 or 1) at `across` on the other: on the retreat plane, down to `z`,
/// through the region.
std::vector<Vector3> sweep_positions(const scene::SearchFrame& frame, const Box& region, double plane, int along,
                                     double sign, double across, double z) {
  const double before = sign > 0.0 ? region.low[along] - frame.tool_extent.high[along] - beside
                                   : region.high[along] - frame.tool_extent.low[along] + beside;
  const double beyond = sign > 0.0 ? region.high[along] : region.low[along];
  Vector3 start;
  start[along] = before;
  start[1 - along] = across;
  start.z() = plane;
  Vector3 down = start, end = start;
  down.z() = end.z() = z;
  end[along] = beyond;
  return {start, down, end};
}

/// Of the target along its approach axis, m.
double thickness(const scene::Target& target) {
  double low = 1e300, high = -1e300;
  for (const Vector3& vertex : target.mesh.vertices) {
    low = std::min(low, vertex.dot(target.approach_axis));
    high = std::max(high, vertex.dot(target.approach_axis));
  }
  return high - low;
}

/// The tool's poses at some positions: at the nearest sites if the way between them follows the axes then.
std::vector<Pose> on_sites(const Task& task, const std::vector<Vector3>& positions, double turn) {
  std::vector<Pose> exact, moved;
  for (const Vector3& position : positions) exact.push_back(task.frame().base_from_tool(position, turn));
  if (!task.options().sites) return exact;
  moved = exact;
  moved.front().translation() = task.options().sites->nearest(exact.front().translation());
  for (std::size_t i = 1; i < exact.size(); ++i) {
    const Vector3 way = exact[i].translation() - exact[i - 1].translation();
    Pose goal = exact[i];
    goal.translation() = moved[i - 1].translation() + way;
    moved[i] = task.at_site(moved[i - 1], goal);
    if (task.options().sites->stride(moved[i - 1].translation(), moved[i].translation()) == 0.0) return exact;
  }
  return moved;
}

}  // namespace

double retreat_plane(const Task& task, const Box& region) {
  const scene::SearchFrame& frame = task.frame();
  return frame.standoff + std::max(0.0, region.low.z() - frame.region.low.z());
}

bool in_same_posture(const JointVector& a, const JointVector& b) {
  constexpr double most_turned = 1.5;  // rad, or m
  return a.size() == b.size() && (a - b).cwiseAbs().maxCoeff() < most_turned;
}

std::vector<double> layers(const Task& task, const Box& region, double first) {
  const double between = std::max(0.0, region.size().z() - thickness(task.scene().target));
  const bool one_reaches_all = between < 0.5 * first;
  const int more =
      one_reaches_all ? 0 : std::clamp(static_cast<int>(std::ceil(between / layer_spacing)), 1, most_layers - 1);
  std::vector<double> depths{first};
  for (int k = 1; k <= more; ++k) depths.push_back(first + k * between / more);
  return depths;
}

MotionPtr anchored_motion(const Task& task, Kind kind, const std::vector<Vector3>& positions, double turn,
                          const JointVector& near, const support::Cancellation& cancellation) {
  const MotionOptions& options = task.options().motion;
  const std::vector<Pose> goals = on_sites(task, positions, turn);
  const auto start = task.posture(goals.front(), near);
  if (!start) return nullptr;
  Motion motion;
  motion.kind = kind;
  motion.anchored = true;
  motion.path = {*start};
  for (std::size_t i = 1; i < goals.size(); ++i) {
    const auto leg = task.straight_path(motion.path.back(), goals[i], options.step, cancellation);
    if (!leg) return nullptr;
    motion.path = joined(std::move(motion.path), *leg);
  }
  return finished(task, std::move(motion));
}

std::vector<MotionPtr> probes(const Task& task, const Box& region, const JointVector& near, int most,
                              const support::Cancellation& cancellation) {
  const ActionOptions& options = task.options().actions;
  const scene::SearchFrame& frame = task.frame();
  const double plane = retreat_plane(task, region);
  std::vector<MotionPtr> motions;
  const auto add = [&](Kind kind, const std::vector<Vector3>& positions) {
    if (MotionPtr motion = anchored_motion(task, kind, positions, 0.0, near, cancellation))
      motions.push_back(std::move(motion));
  };
  const auto with_tip_at = [&](double depth) {
    return std::min(region.low.z() + depth, region.high.z()) - frame.tool_extent.high.z();
  };
  for (const double first : options.probe_depth) {
    const std::vector<double> depths = layers(task, region, first);
    for (const double depth : depths)
      for (const int along : {0, 1})
        for (const double across : lines(region.low[1 - along], region.high[1 - along], options.probe_spacing, most))
          for (const double sign : {1.0, -1.0})
            add(Kind::sweep, sweep_positions(frame, region, plane, along, sign, across, with_tip_at(depth)));
    for (const double u : lines(region.low.x(), region.high.x(), 2.0 * options.probe_spacing, (most + 1) / 2))
      for (const double v : lines(region.low.y(), region.high.y(), 2.0 * options.probe_spacing, (most + 1) / 2))
        add(Kind::poke, {{u, v, plane}, {u, v, with_tip_at(std::max(first, region.size().z() - short_of_end))}});
  }
  return motions;
}

}  // namespace tactus::action
