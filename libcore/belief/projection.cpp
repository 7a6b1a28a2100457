// SPDX-License-Identifier: BSD-3-Clause
#include "belief/projection.hpp"

#include <algorithm>

namespace tactus::belief {
namespace {

constexpr int steps = 8;
constexpr std::size_t looks = 3;          // at waypoints along a stretch that should be free
constexpr double close_enough = 0.00005;  // m
constexpr double clear_by = 0.00005;      // m, where the robot was free
constexpr double near = 0.001;            // m by which a demand may be missed
constexpr double damping = 1e-8;          // m^2
constexpr double longest_shift = 0.02;    // m in one step

using Row = Eigen::Matrix<double, 1, 6>;

/// How the signed distance at a point of the robot changes with x, y, z, roll, pitch, yaw of the target; fixed
/// dimensions do not count.
Row derivative(const Task& task, const PoseVector& v, const Pose& base_from_target, const contact::Nearest& nearest) {
  const Vector3 gradient = base_from_target.linear() * nearest.gradient;
  const Vector3 arm = base_from_target.linear() * nearest.point;
  const Eigen::Matrix3d yaw = Eigen::AngleAxisd(v[5], Vector3::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3d pitch = Eigen::AngleAxisd(v[4], Vector3::UnitY()).toRotationMatrix();
  const std::array<Vector3, 3> axes{yaw * (pitch * Vector3::UnitX()), yaw * Vector3::UnitY(), Vector3::UnitZ()};
  Row row;
  for (int d = 0; d < 3; ++d) {
    row[d] = -gradient[d];
    row[d + 3] = -gradient.dot(axes[d].cross(arm));
  }
  for (int d = 0; d < 6; ++d)
    if (task.scene().prior.width[d] <= 0.0) row[d] = 0.0;
  return row;
}

/// What the history asks of a pose: one row for each contact not in touch and each free stretch that is not free.
struct Demands {
  std::vector<Row> rows;
  std::vector<double> amounts;

  void add(const Row& row, double amount) {
    rows.push_back(row);
    amounts.push_back(amount);
  }
  double largest() const {
    double most = 0.0;
    for (const double amount : amounts) most = std::max(most, std::abs(amount));
    return most;
  }
};

Demands demands_of(const Task& task, const std::vector<Trace>& history, const PoseVector& v) {
  const contact::TargetContact& target = task.target_contact();
  const Pose pose = geometry::pose_from(v);
  const double travelled_on = task.options().sensing.stopping_distance;
  Demands demands;
  for (const Trace& trace : history) {
    if (trace.doubted) continue;
    const std::size_t last = trace.bodies.size() - 1;
    if (trace.contact) {
      const contact::Nearest at_stop = target.nearest(trace.bodies, last, pose);
      const double wanted = std::clamp(at_stop.distance, -close_enough - travelled_on, -close_enough);
      if (at_stop.distance < 1.0 && at_stop.distance != wanted)
        demands.add(derivative(task, v, pose, at_stop), wanted - at_stop.distance);
    }
    const auto hit = target.first_within(trace.bodies, pose, 0.0, 0);
    const std::size_t end = trace.touch;
    if (!hit || *hit >= end) continue;
    const std::size_t stride = std::max<std::size_t>(1, (end - *hit) / looks);
    contact::Nearest deepest;
    for (std::size_t i = *hit; i < end; i += stride) {
      const contact::Nearest at = target.nearest(trace.bodies, i, pose);
      if (at.distance < deepest.distance) deepest = at;
    }
    demands.add(derivative(task, v, pose, deepest), clear_by - deepest.distance);
  }
  return demands;
}

/// The least change of the pose that meets the demands in the sense of least squares, angles weighed by the target's
/// size.
PoseVector moved(const PoseVector& v, const Demands& demands, double lever) {
  const auto count = static_cast<Eigen::Index>(demands.rows.size());
  Eigen::MatrixXd a(count, 6);
  Eigen::VectorXd b(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    a.row(i) = demands.rows[static_cast<std::size_t>(i)];
    a.row(i).tail<3>() /= lever;
    b[i] = demands.amounts[static_cast<std::size_t>(i)];
  }
  const Eigen::MatrixXd normal = a * a.transpose() + damping * Eigen::MatrixXd::Identity(count, count);
  Eigen::Matrix<double, 6, 1> change = a.transpose() * normal.ldlt().solve(b);
  const double size = change.norm();
  if (size > longest_shift) change *= longest_shift / size;
  PoseVector next = v;
  for (int d = 0; d < 6; ++d) next[d] += d < 3 ? change[d] : change[d] / lever;
  return next;
}

/// The box's point nearest to `v`, number by number.
PoseVector inside(const scene::Prior& prior, PoseVector v) {
  for (int d = 0; d < 6; ++d) {
    const double half = 0.5 * prior.width[d], value = d < 3 ? v[d] : scene::nearest_angle(v[d], prior.centre[d]);
    v[d] = std::clamp(value, prior.centre[d] - half, prior.centre[d] + half);
  }
  return v;
}

}  // namespace

std::optional<Projection> projected(const Task& task, const std::vector<Trace>& history, const PoseVector& seed) {
  const double lever = 0.5 * geometry::diameter(task.scene().target.mesh);
  PoseVector at = inside(task.scene().prior, seed);
  for (int step = 0; step < steps; ++step) {
    if (reproduces(task, history, geometry::pose_from(at))) return Projection{at, true};
    const Demands demands = demands_of(task, history, at);
    const bool is_last = step + 1 == steps;
    if (is_last) return demands.largest() < near ? std::optional(Projection{at, false}) : std::nullopt;
    at = inside(task.scene().prior, moved(at, demands, lever));
  }
  return std::nullopt;
}

}  // namespace tactus::belief
