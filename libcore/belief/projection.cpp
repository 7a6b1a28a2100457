// SPDX-License-Identifier: BSD-3-Clause
#include "belief/projection.hpp"

#include <algorithm>

namespace tactus::belief {
namespace {

constexpr int steps = 12;
constexpr std::size_t looks = 3;          // at waypoints along a stretch that should be free
constexpr double least_delay = 0.002;     // m by which a contact comes too early to be put off:
constexpr double least_depth = 0.15;      // of that; a robot that comes no deeper only grazes the target
constexpr double close_enough = 0.00001;  // m
constexpr double clear_by = 0.00005;      // m, where the robot was free
constexpr double gain = 0.9;              // of the worst demand so far: steps that leave more gain nothing;
constexpr int patience = 3;               // so many in a row, and it is given up
constexpr double least_miss = 0.0001;     // m, of a pose that is not exact
constexpr double damping = 0.2;           // 1/m^2, where several demands say the same
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
  std::vector<double> leeways;  ///< m by which what comes of it may be off

  void add(const Row& row, double amount, double leeway) {
    rows.push_back(row);
    amounts.push_back(amount);
    leeways.push_back(leeway);
  }
  double largest() const {
    double most = 0.0;
    for (const double amount : amounts) most = std::max(most, std::abs(amount));
    return most;
  }
};

/// Where a point of the tool at one waypoint is at another.
Vector3 carried(const Trace& trace, std::size_t from, std::size_t to, const Vector3& base_point) {
  return trace.bodies.base_from_body(to, 0) * (trace.bodies.base_from_body(from, 0).inverse() * base_point);
}

/// A contact before its time.
struct Early {
  std::size_t hit = 0;  ///< the first waypoint in contact
  contact::Nearest at_hit, deepest;
};

/// The deepest as far as a few of the waypoints from `hit` to the touch tell.
Early look_at(const Task& task, const Trace& trace, const Pose& base_from_target, std::size_t hit) {
  const std::size_t stride = std::max<std::size_t>(1, (trace.touch - hit) / looks);
  const contact::Nearest at_hit = task.target_contact().nearest(trace.bodies, hit, base_from_target);
  Early early{hit, at_hit, at_hit};
  for (std::size_t i = hit + stride; i < trace.touch; i += stride) {
    const contact::Nearest at = task.target_contact().nearest(trace.bodies, i, base_from_target);
    if (at.distance < early.deepest.distance) early.deepest = at;
  }
  return early;
}

/// A contact that comes much too early: the target goes on by what the robot does from there to the stop. Moved the
/// shortest way out instead, it would be passed at the side. False if that is not the case, or the robot only grazes it
/// on a long way.
bool add_delay(const Task& task, const Trace& trace, const Pose& base_from_target, const Early& early,
               Demands& demands) {
  const Vector3 there = base_from_target * early.at_hit.point;
  const Vector3 way = carried(trace, early.hit, trace.bodies.size() - 1, there) - there;
  const double length = way.norm();
  if (length < least_delay || -early.deepest.distance < least_depth * length) return false;
  Row row = Row::Zero();
  for (int d = 0; d < 3; ++d)
    if (task.scene().prior.width[d] > 0.0) row[d] = way[d] / length;
  if (row.norm() < 0.5) return false;
  demands.add(row, length, least_delay);
  return true;
}

/// In touch at the stop: half as deep as it may be if the robot was free until just before.
void add_touch(const Task& task, const Trace& trace, const PoseVector& v, const Pose& base_from_target,
               Demands& demands) {
  const std::size_t last = trace.bodies.size() - 1;
  const contact::Nearest at_stop = task.target_contact().nearest(trace.bodies, last, base_from_target);
  if (at_stop.distance >= 1.0) return;
  const Vector3 there = base_from_target * at_stop.point;
  const Vector3 last_way = there - carried(trace, last, trace.touch - 1, there);
  const double deepest = std::abs((base_from_target.linear() * at_stop.gradient).dot(last_way));
  const double depth = std::max(close_enough, 0.5 * std::min(deepest, task.options().stop_tolerance));
  const double wanted = std::clamp(at_stop.distance, -depth - trace.travel, -depth);
  if (wanted != at_stop.distance)
    demands.add(derivative(task, v, base_from_target, at_stop), wanted - at_stop.distance, depth);
}

Demands demands_of(const Task& task, const std::vector<const Trace*>& history, const PoseVector& v,
                   const support::Cancellation& cancellation) {
  const Pose pose = geometry::pose_from(v);
  Demands demands;
  for (const Trace* trace : history) {
    cancellation.check();
    const auto hit = task.target_contact().first_within(trace->bodies, pose, 0.0, 0);
    if (hit && *hit < trace->touch) {
      const Early early = look_at(task, *trace, pose, *hit);
      if (trace->contact && add_delay(task, *trace, pose, early, demands)) continue;
      demands.add(derivative(task, v, pose, early.deepest), clear_by - early.deepest.distance, clear_by);
    }
    if (trace->contact) add_touch(task, *trace, v, pose, demands);
  }
  return demands;
}

/// The least change of the pose that meets the demands in the sense of least squares, each in units of its leeway, and
/// angles weighed by the target's size.
PoseVector moved(const PoseVector& v, const Demands& demands, double lever) {
  const auto count = static_cast<Eigen::Index>(demands.rows.size());
  Eigen::MatrixXd a(count, 6);
  Eigen::VectorXd b(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto demand = static_cast<std::size_t>(i);
    a.row(i) = demands.rows[demand] / demands.leeways[demand];
    a.row(i).tail<3>() /= lever;
    b[i] = demands.amounts[demand] / demands.leeways[demand];
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

std::optional<Projection> projected(const Task& task, const std::vector<const Trace*>& history, const PoseVector& seed,
                                    double near, const support::Cancellation& cancellation) {
  const double lever = 0.5 * task.target_diameter();
  std::optional<Projection> nearest;
  PoseVector at = inside(task.scene().prior, seed);
  double best = 1e300;
  int in_vain = 0;
  for (int step = 0; step < steps; ++step) {
    if (reproduces(task, history, geometry::pose_from(at))) return Projection{at, 0.0};
    const Demands demands = demands_of(task, history, at, cancellation);
    const double worst = demands.largest();
    if (worst < (nearest ? nearest->miss : near)) nearest = Projection{at, std::max(worst, least_miss)};
    in_vain = worst < gain * best ? 0 : in_vain + 1;
    if (in_vain >= patience) break;
    best = std::min(best, worst);
    at = inside(task.scene().prior, moved(at, demands, lever));
  }
  return nearest;
}

std::optional<Projection> projected(const Task& task, const std::vector<Trace>& history, const PoseVector& seed,
                                    double near, const support::Cancellation& cancellation) {
  return projected(task, believed(history), seed, near, cancellation);
}

}  // namespace tactus::belief
