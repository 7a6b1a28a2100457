// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "motion/connect.hpp"

namespace tactus::motion {

using contact::KnownWorld;

namespace {

constexpr double largest_jump = 0.2;  // rad or m, of a joint between waypoints: more is another branch
constexpr double finest =
    1.0 / 64.0;  // of the first increment: below it the way is blocked by a limit or a singularity
constexpr double radius_of_turning = 0.1;  // m, at which a turn of the tool counts as a way, for the first increment

const robot::InverseOptions follow{.position_tolerance = 2e-7, .angle_tolerance = 2e-7, .iterations = 12};

// Follows the straight line of the tool by inverse kinematics, waypoint by waypoint, with increments that fit the step.
class LineFollower {
 public:
  LineFollower(const KnownWorld& world, int tool_link, const JointVector& from, const Pose& goal,
               const StraightOptions& options)
      : world_(world),
        tool_link_(tool_link),
        start_(robot::forward(world.model(), from, tool_link)),
        goal_(goal),
        step_(options.step),
        path_{from} {
    const double metres = (goal.translation() - start_.translation()).norm();
    const double way = metres + radius_of_turning * geometry::angle_between(start_, goal);
    increment_ = std::min(1.0, step_ / std::max(way, 1e-12));
    if (options.stride > 0.0) strides_ = std::round(metres / options.stride);
    least_ = finest * increment_;
  }

  // Adds the next free waypoint; false if there is none.
  bool advance() {
    while (increment_ >= least_) {
      const double fraction = next_fraction();
      const std::optional<JointVector> next =
          robot::inverse(world_.model(), tool_link_, pose_at(fraction), extrapolated(fraction), follow);
      const double bound = next ? world_.displacement(path_.back(), *next) : 0.0;
      if (!next || bound > step_ || (*next - path_.back()).cwiseAbs().maxCoeff() > largest_jump) {
        refine(bound);
        continue;
      }
      if (!world_.is_free(*next)) return false;
      accept(*next, fraction, bound);
      return true;
    }
    return false;
  }

  bool done() const { return reached_ == 1.0; }
  JointPath take() { return std::move(path_); }

 private:
  // A whole number of strides if there is one ahead.
  double next_fraction() const {
    const double fraction = reached_ + increment_;
    if (fraction >= 1.0 - 1e-9) return 1.0;
    if (strides_ == 0.0) return fraction;
    const double whole = std::floor(fraction * strides_ + 1e-6) / strides_;
    return whole > reached_ + 1e-9 ? whole : fraction;
  }

  Pose pose_at(double fraction) const {
    return fraction == 1.0 ? goal_ : geometry::interpolate(start_, goal_, fraction);
  }

  // Where the last two waypoints lead.
  JointVector extrapolated(double fraction) const {
    if (path_.size() < 2) return path_.back();
    return path_.back() + (path_.back() - path_[path_.size() - 2]) * ((fraction - reached_) / last_increment_);
  }

  void refine(double bound) {
    const double fitting = bound > step_ ? 0.95 * step_ / bound : 0.5;
    increment_ *= std::clamp(fitting, 0.25, 0.9);
  }

  void accept(const JointVector& next, double fraction, double bound) {
    last_increment_ = fraction - reached_;
    reached_ = fraction;
    path_.push_back(next);
    increment_ = last_increment_ * std::clamp(0.97 * step_ / std::max(bound, 1e-12), 0.5, 2.0);
    increment_ = std::max(increment_, least_);
  }

  const KnownWorld& world_;
  int tool_link_;
  Pose start_, goal_;
  double step_;
  double strides_ = 0.0;  // along the line; 0: any
  JointPath path_;
  double reached_ = 0.0;  // of the line, 0 .. 1
  double increment_ = 1.0, last_increment_ = 1.0, least_ = 0.0;
};

}  // namespace

std::optional<JointPath> straight_tool_path(const KnownWorld& world, int tool_link, const JointVector& from,
                                            const Pose& base_from_tool_goal, const StraightOptions& options) {
  if (!world.is_free(from)) return std::nullopt;
  LineFollower follower(world, tool_link, from, base_from_tool_goal, options);
  while (!follower.done() && follower.advance()) options.cancellation.check();
  JointPath path = follower.take();
  if (path.size() < 2 || !(follower.done() || options.keep_free_part)) return std::nullopt;
  return path;
}

}  // namespace tactus::motion
