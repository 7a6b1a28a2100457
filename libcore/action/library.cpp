// SPDX-License-Identifier: BSD-3-Clause
#include "action/library.hpp"

#include <algorithm>
#include <numbers>

#include "action/primitives.hpp"
#include "action/probes.hpp"

namespace tactus::action {
namespace {

constexpr std::size_t kept_configurations = 4096;
constexpr double lattice_pitch = 0.06;       // m
constexpr double same_configuration = 1e-3;  // rad or m, of every joint
constexpr double same_stand = 1e-6;
constexpr double least_retreat = 0.3;  // of the way back along the tool's axis, towards the retreat plane

/// The whole turns of joints nearest to a difference.
JointVector whole_turns(const JointVector& difference) {
  constexpr double turn = 2.0 * std::numbers::pi;
  return turn * (difference / turn).array().round().matrix();
}

/// Whether every link stands where it does at the other.
bool stands_alike(const robot::RobotModel& robot, const JointVector& a, const JointVector& b) {
  std::vector<Pose> at_a, at_b;
  robot::forward(robot, a, at_a);
  robot::forward(robot, b, at_b);
  return std::equal(at_a.begin(), at_a.end(), at_b.begin(),
                    [](const Pose& one, const Pose& other) { return one.isApprox(other, same_stand); });
}

/// Whether a box lies in another and hardly falls short of it.
bool fills(const geometry::Box& box, const geometry::Box& whole) {
  constexpr double most = 0.85;
  return whole.contains(box.low) && whole.contains(box.high) &&
         (box.size().array() >= most * whole.size().array()).all();
}

/// By a little, for a region that changes with what was drawn.
geometry::Box widened(const geometry::Box& box) {
  constexpr double by = 0.02;
  return {box.low - by * box.size(), box.high + by * box.size()};
}

JointPath shifted(JointPath path, const JointVector& by) {
  if (by.isZero(0.0)) return path;
  for (JointVector& q : path) q += by;
  return path;
}

}  // namespace

std::vector<MotionPtr> ActionLibrary::primitives_at(const JointVector& q, const support::Cancellation& cancellation) {
  const std::vector<double> key(q.data(), q.data() + q.size());
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = primitives_.find(key); found != primitives_.end()) return found->second;
  }
  std::vector<MotionPtr> motions = primitives(task_, q, cancellation);
  const std::lock_guard lock(mutex_);
  if (primitives_.size() >= kept_configurations) primitives_.clear();
  return primitives_.try_emplace(key, std::move(motions)).first->second;
}

std::vector<MotionPtr> ActionLibrary::probes_in(const geometry::Box& region, const JointVector& near, int most,
                                                const support::Cancellation& cancellation) {
  const std::lock_guard lock(mutex_);
  const bool is_kept = probes_.most == most && fills(region, probes_.region) && in_same_posture(probes_.near, near);
  if (!is_kept) {
    const geometry::Box wider = widened(region);
    probes_ = {wider, near, most, probes(task_, wider, near, most, cancellation)};
  }
  return probes_.motions;
}

std::shared_ptr<const Lattice> ActionLibrary::lattice_through(const JointVector& q) {
  const std::lock_guard lock(mutex_);
  if (!lattice_ || !lattice_->passes(q)) lattice_ = std::make_shared<const Lattice>(task_, q, lattice_pitch);
  return lattice_;
}

/// How far the tool is past the retreat plane, m.
double ActionLibrary::past_plane(const JointVector& q, const JointVector& start) const {
  const Vector3 axis = task_.frame().base_from_search.linear().col(2);
  return axis.dot(task_.base_from_tool(q).translation() - task_.base_from_tool(start).translation());
}

JointPath ActionLibrary::as_far_as_plane(const JointPath& way_back, const JointVector& start) const {
  const auto there = std::find_if(way_back.begin(), way_back.end(),
                                  [&](const JointVector& q) { return past_plane(q, start) <= 1e-6; });
  return {way_back.begin(), there == way_back.end() ? there : there + 1};
}

/// `path` and the way from its end: out along the tool's axis, and across, to `start` or whole turns of joints from it.
JointPath ActionLibrary::lead_in(JointPath path, const JointVector& start, const support::Deadline& deadline) const {
  const double step = task_.options().motion.step;
  const support::Cancellation& cancellation = deadline.cancellation();
  const JointVector q = path.back();
  if (q == start) return path;
  const Pose here = task_.base_from_tool(q);
  Pose back = here;
  const Pose goal = task_.base_from_tool(start);
  const Vector3 axis = task_.frame().base_from_search.linear().col(2), out = task_.frame().tool_axes(back).col(2);
  const double retreat = past_plane(q, start);
  if (retreat > 1e-6 && out.dot(axis) > least_retreat) {
    back.translation() -= retreat / out.dot(axis) * out;
    if (const auto leg = task_.straight_path(q, task_.at_site(here, back), step, cancellation))
      path = joined(std::move(path), *leg);
  }
  if (const auto across = task_.straight_path(path.back(), goal, step, cancellation)) {
    const JointVector end = start + whole_turns(across->back() - start);
    if ((across->back() - end).cwiseAbs().maxCoeff() < same_configuration &&
        stands_alike(*task_.scene().robot, start, end)) {
      JointPath leg = *across;
      leg.back() = end;
      return joined(std::move(path), leg);
    }
  }
  return connected(std::move(path), start, deadline);
}

/// `path` and a planned way from its end; empty if none is found.
JointPath ActionLibrary::connected(JointPath path, const JointVector& start, const support::Deadline& deadline) const {
  motion::ConnectOptions options;
  options.step = task_.options().motion.step;
  const auto way = motion::connect(task_.known_world(), path.back(), start, options, deadline);
  return way ? joined(std::move(path), *way) : JointPath{};
}

bool ActionLibrary::are_inside_limits(const JointPath& path) const {
  return std::all_of(path.begin(), path.end(),
                     [&](const JointVector& q) { return robot::inside_limits(*task_.scene().robot, q); });
}

std::optional<Action> ActionLibrary::realise(const JointVector& q, const Motion& motion,
                                             const support::Deadline& deadline, const JointPath& way_back) const {
  std::optional<Action> action = motion.anchored ? realise_anchored(q, motion, deadline, way_back)
                                                 : make_action(task_, motion.kind, motion.path, 0, motion.pace);
  if (action) action->supposed_target = motion.supposed_target;
  return action;
}

std::optional<Action> ActionLibrary::realise_anchored(const JointVector& q, const Motion& motion,
                                                      const support::Deadline& deadline,
                                                      const JointPath& way_back) const {
  const MotionOptions& options = task_.options().motion;
  const JointVector& start = motion.path.front();
  JointPath lead = lead_in(way_back.empty() ? JointPath{q} : as_far_as_plane(way_back, start), start, deadline);
  JointPath proper = lead.empty() ? motion.path : shifted(motion.path, lead.back() - start);
  if (!are_inside_limits(proper)) {
    proper = motion.path;
    lead = connected(JointPath{q}, start, deadline);
  }
  if (lead.empty()) return std::nullopt;
  std::vector<motion::PacedSegment> pace{{0, {options.speed, options.acceleration, options.joint_acceleration}}};
  for (motion::PacedSegment segment : motion.pace) {
    segment.first += lead.size() - 1;
    pace.push_back(segment);
  }
  if (lead.size() == 1) pace.erase(pace.begin());
  return make_action(task_, motion.kind, joined(lead, proper), lead.size() - 1, pace);
}

}  // namespace tactus::action
