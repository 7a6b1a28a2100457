// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "action/probes.hpp"
#include "belief/small_task.hpp"
#include "solver/rate_policy.hpp"

/// Random poses of a small task with what simple policies on them rest on.
namespace tactus::test {

using solver::Attempt;
using solver::RatePolicy;
using support::Bitset;
using support::Rng;
using Members = RatePolicy::Members;

constexpr int dimensions = 3;

inline const std::shared_ptr<const action::Task>& task() {
  static const auto made = small_task({.roll_width = 0.2, .position_width = 0.04});
  return made;
}

/// From the middle of the prior, this share of its widths; no two of them so close that an attempt at one may serve the
/// other.
inline std::vector<Pose> random_poses(std::size_t count, Rng& rng, double share = 1.0,
                                      const action::Task& on = *task()) {
  constexpr double apart = 0.002;
  scene::Prior part = on.scene().prior;
  for (double& width : part.width) width *= share;
  std::vector<Pose> poses;
  while (poses.size() < count) {
    const Pose pose = part.sample(rng);
    if (std::all_of(poses.begin(), poses.end(),
                    [&](const Pose& other) { return (other.translation() - pose.translation()).norm() > apart; }))
      poses.push_back(pose);
  }
  return poses;
}

inline Attempt attempt_at(const Pose& pose) {
  constexpr double way = 0.05;
  const Pose seated = task()->scene().seated(pose);
  Attempt attempt{seated, seated, way};
  attempt.base_from_start.translation() -= way * (pose.linear() * task()->scene().target.approach_axis);
  return attempt;
}

/// A policy on some poses of which an attempt serves its own alone, and what it rests on.
struct Setting {
  Setting(std::size_t count, Rng& rng, std::shared_ptr<const action::Task> of = task())
      : on(of),
        probes(action::probes(*of, of->frame().region, of->home(), 3)),
        predictions(of, random_poses(count, rng, 1.0, *of)) {
    for (std::size_t i = 0; i < count; ++i) {
      attempts.push_back(attempt_at(predictions.poses()[i]));
      served.emplace_back(count);
      served.back().set(i);
    }
  }
  RatePolicy policy() { return {on, predictions, probes, attempts, served, dimensions}; }
  double straight(const Pose& base_from_tool, std::size_t member) const {
    const Pose& seated = attempts[member].base_from_seated;
    return task()->options().cost.action + (seated.translation() - base_from_tool.translation()).norm() +
           0.05 * geometry::angle_between(seated, base_from_tool);
  }

  std::shared_ptr<const action::Task> on;
  std::vector<action::MotionPtr> probes;
  solver::Predictions predictions;
  std::vector<Attempt> attempts;
  std::vector<Bitset> served;
};

inline Members random_members(std::size_t count, Rng& rng) {
  Members members;
  const std::uint64_t most = 1 + rng.below(6);
  for (std::size_t i = 0; i < count; ++i)
    if (rng.below(most) == 0) members.push_back(i);
  if (members.empty()) members.push_back(rng.below(count));
  return members;
}

inline Pose random_place(Rng& rng) {
  const Vector3 shift(rng.uniform(-0.05, 0.01), rng.uniform(-0.05, 0.05), rng.uniform(-0.05, 0.05));
  return Eigen::Translation3d(shift) * task()->base_from_tool(task()->scene().start);
}

}  // namespace tactus::test
