// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "robot/chain.hpp"
#include "robot/kinematics.hpp"
#include "support/error.hpp"

namespace tactus::robot {
namespace {

using Values = Chain::Values;
using Twist = Eigen::Matrix<double, 6, 1>;
using Normal = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, Chain::most_joints, Chain::most_joints>;

constexpr double whole_turn = 2.0 * std::numbers::pi;
constexpr double least_progress = 0.05;  // of the error's square, over `patience` steps
constexpr int patience = 10;
constexpr double same_value = 1e-3;  // joints that differ by less make no different solution

/// What moves the link from `pose` to `target`: metres, then a rotation vector, in the root's frame.
Twist difference(const Pose& pose, const Pose& target) {
  Twist twist;
  twist.head<3>() = target.translation() - pose.translation();
  twist.tail<3>() = geometry::rotation_vector(target.linear() * pose.linear().transpose());
  return twist;
}

/// The limits of a chain's joints.
struct Limits {
  Values lower, upper;
  Values clamped(const Values& values) const { return values.cwiseMax(lower).cwiseMin(upper); }
};

Limits limits_of(const RobotModel& model, const Chain& chain) {
  Limits limits{Values(chain.columns()), Values(chain.columns())};
  for (int c = 0; c < chain.columns(); ++c) {
    limits.lower[c] = model.joints[static_cast<std::size_t>(chain.joint(c))].lower;
    limits.upper[c] = model.joints[static_cast<std::size_t>(chain.joint(c))].upper;
  }
  return limits;
}

/// The same without the limits of joints that have a whole turn: these would only be in the way of a descent.
Limits without_full_circles(const Chain& chain, Limits limits) {
  for (int c = 0; c < chain.columns(); ++c) {
    if (!chain.turns_freely(c) || limits.upper[c] - limits.lower[c] < whole_turn) continue;
    limits.lower[c] = -std::numeric_limits<double>::infinity();
    limits.upper[c] = std::numeric_limits<double>::infinity();
  }
  return limits;
}

/// Turns joints by whole turns into their limits, and there as near to `goal` as may be.
Values wound_towards(const Chain& chain, const Limits& limits, Values values, const Values& goal) {
  for (int c = 0; c < values.size(); ++c) {
    if (!chain.turns_freely(c)) continue;
    const double fewest = std::ceil((limits.lower[c] - values[c]) / whole_turn);
    const double most = std::floor((limits.upper[c] - values[c]) / whole_turn);
    values[c] += whole_turn * std::max(fewest, std::min(most, std::round((goal[c] - values[c]) / whole_turn)));
  }
  return limits.clamped(values);
}

/// Random values for the joints, not further than half a turn from `near` where the limits allow.
Values draw(const Chain& chain, const Limits& limits, const Values& near, support::Rng& rng) {
  Values values(near.size());
  for (int c = 0; c < values.size(); ++c) {
    double low = limits.lower[c], high = limits.upper[c];
    if (chain.turns_freely(c) && high - low > whole_turn) {
      low = std::clamp(near[c] - 0.5 * whole_turn, low, high - whole_turn);
      high = low + whole_turn;
    }
    const bool bounded = std::isfinite(low) && std::isfinite(high);
    values[c] = bounded ? rng.uniform(low, high) : near[c] + rng.uniform(-0.5, 0.5) * whole_turn;
  }
  return values;
}

/// Levenberg-Marquardt in a box, after Sugihara (2011): damped by the error itself, so that it slows down near
/// singularities and where the target is out of reach, and is Gauss-Newton near a solution.
class Descent {
 public:
  Descent(const Chain& chain, const Pose& target, const Limits& box) : chain_(chain), target_(target), box_(box) {}

  /// True if `values` arrive at the target.
  bool run(Values& values, const InverseOptions& options) {
    values = box_.clamped(values);
    Chain::Jacobian jacobian;
    Twist error = difference(chain_.forward(values, jacobian), target_);
    double damping = 1.0, mark = error.squaredNorm();
    for (int i = 0; !arrived(error, options); ++i) {
      if (i >= options.iterations) return false;
      if (i % patience == patience - 1) {
        if (error.squaredNorm() > (1.0 - least_progress) * mark) return false;
        mark = error.squaredNorm();
      }
      const Values candidate = box_.clamped(values + step(values, jacobian, error, damping * error.squaredNorm()));
      const Twist left = difference(chain_.forward(candidate), target_);
      if (left.squaredNorm() < error.squaredNorm()) {
        values = candidate;
        error = difference(chain_.forward(values, jacobian), target_);
        damping = std::max(0.25 * damping, 1e-6);
      } else {
        damping *= 4.0;
      }
    }
    return true;
  }

 private:
  static bool arrived(const Twist& error, const InverseOptions& options) {
    return error.head<3>().norm() <= options.position_tolerance && error.tail<3>().norm() <= options.angle_tolerance;
  }

  /// The damped step; joints at a limit that it would push outward stay where they are.
  Values step(const Values& values, const Chain::Jacobian& jacobian, const Twist& error, double damping) const {
    Values pull = jacobian.transpose() * error;
    Normal normal = jacobian.transpose() * jacobian;
    normal.diagonal().array() += damping + 1e-12;
    for (int c = 0; c < pull.size(); ++c) {
      if (!((values[c] <= box_.lower[c] && pull[c] < 0.0) || (values[c] >= box_.upper[c] && pull[c] > 0.0))) continue;
      pull[c] = 0.0;
      normal.row(c).setZero();
      normal.col(c).setZero();
      normal(c, c) = 1.0;
    }
    return Eigen::LLT<Normal>(normal).solve(pull);
  }

  const Chain& chain_;
  const Pose& target_;
  const Limits box_;
};

Values values_of(const Chain& chain, const JointVector& q) {
  Values values(chain.columns());
  for (int c = 0; c < chain.columns(); ++c) values[c] = q[chain.joint(c)];
  return values;
}

JointVector with_values(const Chain& chain, const JointVector& q, const Values& values) {
  JointVector changed = q;
  for (int c = 0; c < chain.columns(); ++c) changed[chain.joint(c)] = values[c];
  return changed;
}

JointVector checked_seed(const RobotModel& model, const Pose& target, const JointVector& seed) {
  if (seed.size() != model.dof() || !seed.allFinite() || !target.matrix().allFinite())
    throw support::Error(support::Status::invalid_argument,
                         "inverse kinematics: found a seed or pose of the wrong size or not finite, expected " +
                             std::to_string(model.dof()) + " finite joint values and a finite pose");
  JointVector inside = seed;
  for (int j = 0; j < model.dof(); ++j)
    inside[j] = std::clamp(seed[j], model.joints[static_cast<std::size_t>(j)].lower,
                           model.joints[static_cast<std::size_t>(j)].upper);
  return inside;
}

void add_if_new(std::vector<Values>& solutions, const Values& values) {
  const auto same = [&](const Values& known) { return (known - values).cwiseAbs().maxCoeff() <= same_value; };
  if (values.size() == 0 ? solutions.empty() : std::none_of(solutions.begin(), solutions.end(), same))
    solutions.push_back(values);
}

}  // namespace

std::optional<JointVector> inverse(const RobotModel& model, int link, const Pose& root_from_link,
                                   const JointVector& seed, const InverseOptions& options) {
  const Chain chain(model, link);
  const JointVector start = checked_seed(model, root_from_link, seed);
  const Limits limits = limits_of(model, chain);
  Descent descent(chain, root_from_link, without_full_circles(chain, limits));
  const Values near = values_of(chain, start);
  Values values = near;
  if (!descent.run(values, options)) return std::nullopt;
  return with_values(chain, start, wound_towards(chain, limits, values, near));
}

std::vector<JointVector> inverse_all(const RobotModel& model, int link, const Pose& root_from_link,
                                     const JointVector& seed, support::Rng& rng, int restarts, int keep,
                                     const InverseOptions& options) {
  const Chain chain(model, link);
  const JointVector start = checked_seed(model, root_from_link, seed);
  const Limits limits = limits_of(model, chain);
  Descent descent(chain, root_from_link, without_full_circles(chain, limits));
  const Values near = values_of(chain, start);
  std::vector<Values> solutions;
  for (int attempt = 0; attempt <= restarts; ++attempt) {
    Values values = attempt == 0 ? near : draw(chain, limits, near, rng);
    if (!descent.run(values, options)) continue;
    add_if_new(solutions, wound_towards(chain, limits, values, near));
    add_if_new(solutions, wound_towards(chain, limits, values, values));
  }
  const auto nearer = [&](const Values& a, const Values& b) {
    return (a - near).squaredNorm() < (b - near).squaredNorm();
  };
  std::stable_sort(solutions.begin(), solutions.end(), nearer);
  if (static_cast<int>(solutions.size()) > keep) solutions.resize(static_cast<std::size_t>(std::max(keep, 0)));
  std::vector<JointVector> found;
  for (const Values& values : solutions) found.push_back(with_values(chain, start, values));
  return found;
}

}  // namespace tactus::robot
