// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
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

/// Levenberg-Marquardt in a box, after Sugihara (2011): damped by the error itself, so that it slows down near
/// singularities and where the target is out of reach, and is Gauss-Newton near a solution.
class Descent {
 public:
  Descent(const RobotModel& model, const Chain& chain, const Pose& target) : chain_(chain), target_(target) {
    lower_.resize(chain.columns());
    upper_.resize(chain.columns());
    for (int c = 0; c < chain.columns(); ++c) {
      lower_[c] = model.joints[static_cast<std::size_t>(chain.joint(c))].lower;
      upper_[c] = model.joints[static_cast<std::size_t>(chain.joint(c))].upper;
    }
  }

  Values clamped(const Values& values) const { return values.cwiseMax(lower_).cwiseMin(upper_); }

  /// True if `values` arrive at the target.
  bool run(Values& values, const InverseOptions& options) {
    values = clamped(values);
    Chain::Jacobian jacobian;
    Twist error = difference(chain_.forward(values, jacobian), target_);
    double damping = 1.0, mark = error.squaredNorm();
    for (int i = 0; !arrived(error, options); ++i) {
      if (i >= options.iterations) return false;
      if (i % patience == patience - 1) {
        if (error.squaredNorm() > (1.0 - least_progress) * mark) return false;
        mark = error.squaredNorm();
      }
      const Values candidate = clamped(values + step(values, jacobian, error, damping * error.squaredNorm()));
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

  bool fits(int column, double value) const { return value >= lower_[column] && value <= upper_[column]; }

  /// A random value for a joint, not further than half a turn from `near` where the limits allow.
  double draw(int column, double near, support::Rng& rng) const {
    double low = lower_[column], high = upper_[column];
    if (chain_.turns_freely(column) && high - low > whole_turn) {
      low = std::clamp(near - 0.5 * whole_turn, low, high - whole_turn);
      high = low + whole_turn;
    }
    return std::isfinite(low) && std::isfinite(high) ? rng.uniform(low, high)
                                                     : near + rng.uniform(-1.0, 1.0) * whole_turn;
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
      if (!((values[c] <= lower_[c] && pull[c] < 0.0) || (values[c] >= upper_[c] && pull[c] > 0.0))) continue;
      pull[c] = 0.0;
      normal.row(c).setZero();
      normal.col(c).setZero();
      normal(c, c) = 1.0;
    }
    return Eigen::LLT<Normal>(normal).solve(pull);
  }

  const Chain& chain_;
  const Pose& target_;
  Values lower_, upper_;
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

/// Turns joints by whole turns towards `seed`, as far as the limits allow.
Values unwound(const Chain& chain, const Descent& descent, Values values, const Values& seed) {
  for (int c = 0; c < values.size(); ++c) {
    if (!chain.turns_freely(c)) continue;
    double turns = std::round((seed[c] - values[c]) / whole_turn);
    while (turns != 0.0 && !descent.fits(c, values[c] + turns * whole_turn)) turns -= std::copysign(1.0, turns);
    values[c] += turns * whole_turn;
  }
  return values;
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
  Descent descent(model, chain, root_from_link);
  const Values near = values_of(chain, start);
  Values values = near;
  if (!descent.run(values, options)) return std::nullopt;
  return with_values(chain, start, unwound(chain, descent, values, near));
}

std::vector<JointVector> inverse_all(const RobotModel& model, int link, const Pose& root_from_link,
                                     const JointVector& seed, support::Rng& rng, int restarts, int keep,
                                     const InverseOptions& options) {
  const Chain chain(model, link);
  const JointVector start = checked_seed(model, root_from_link, seed);
  Descent descent(model, chain, root_from_link);
  const Values near = values_of(chain, start);
  std::vector<Values> solutions;
  for (int attempt = 0; attempt <= restarts; ++attempt) {
    Values values = near;
    if (attempt > 0)
      for (int c = 0; c < values.size(); ++c) values[c] = descent.draw(c, near[c], rng);
    if (!descent.run(values, options)) continue;
    add_if_new(solutions, unwound(chain, descent, values, near));
    add_if_new(solutions, values);
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
