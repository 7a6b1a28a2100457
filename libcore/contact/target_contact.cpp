// SPDX-License-Identifier: BSD-3-Clause
#include "contact/target_contact.hpp"

#include <algorithm>

namespace tactus::contact {
namespace {

constexpr double relative_detail = 0.4;  // of the reach or the depth asked for
constexpr double field_spacing = 0.001;
constexpr double field_border = 0.01;
constexpr std::size_t leaf_stride = 31;  // of the first look for the nearest point
constexpr std::size_t field_samples = 1'000'000;

}  // namespace

TargetContact::TargetContact(std::shared_ptr<const RobotBodies> bodies, const Mesh& target, double margin)
    : bodies_(std::move(bodies)),
      target_(target),
      field_(target, field_spacing, field_border, field_samples),
      margin_(margin) {
  for (const Mesh& shell : geometry::shells(geometry::merged_vertices(target)))
    shell_points_.push_back(shell.vertices.front());
}

/// Where the look-up leaves a leaf undecided. For a depth (threshold < 0) the leaf's centre speaks; for a wide reach
/// its ball, which errs to a hit; else its triangle against the target's.
bool TargetContact::leaf_hit(const Body& body, const SurfaceBall& leaf, const Pose& target_from_body,
                             double threshold) const {
  const Vector3 centre = target_from_body * leaf.centre;
  if (threshold < 0.0)
    return field_.tree().distance(centre, -threshold) >= -threshold && field_.tree().contains(centre);
  if (threshold > std::max(margin_, leaf.radius))
    return field_.tree().distance(centre, threshold + 1.01 * leaf.radius) <= threshold + leaf.radius;
  return field_.tree().within(geometry::transformed(body.triangle(leaf.triangle), target_from_body), threshold);
}

/// Goes through the body's balls, deepest detail only where the target is near: a ball is passed over when its centre
/// is a little farther from the threshold than its radius; a reach much wider than a ball takes the ball for its part
/// of the surface, which errs to a hit, and a depth much greater gives it up, which errs to none.
TargetContact::Reach TargetContact::reach(const Body& body, const Pose& target_from_body, double threshold) const {
  const std::vector<SurfaceBall>& balls = body.balls();
  const double detail = std::abs(threshold) > margin_ ? relative_detail * std::abs(threshold) : 0.0;
  double lowest = 1e300;
  std::uint64_t asked = 0;  // a shell that crosses nothing is inside or outside as a whole: one of its points is asked
  const auto side_unknown = [&asked](int shell) {
    if (shell >= 64) return true;
    const bool first = (asked >> shell & 1) == 0;
    asked |= std::uint64_t{1} << shell;
    return first;
  };
  for (int i = 0; i < static_cast<int>(balls.size());) {
    const SurfaceBall& ball = balls[i];
    const geometry::DistanceBounds bounds = field_.bounds(target_from_body * ball.centre);
    const double lower = bounds.lower - ball.radius;
    if (lower > threshold && (lower >= lowest || ball.radius <= 0.8 * (bounds.lower - threshold))) {
      lowest = std::min(lowest, lower);
      i = ball.next;
      continue;
    }
    if (ball.radius < detail && ball.triangle < 0) {
      if (threshold > 0.0) return {true, 0.0};
      lowest = std::min(lowest, lower);
      i = ball.next;
      continue;
    }
    if (ball.triangle >= 0) {
      if (bounds.upper < threshold) return {true, 0.0};
      if (lower <= threshold && leaf_hit(body, ball, target_from_body, threshold)) return {true, 0.0};
      if (threshold >= 0.0 && bounds.lower < 0.0 && side_unknown(ball.shell) &&
          field_.tree().contains(target_from_body * ball.centre))
        return {true, 0.0};
      lowest = std::min(lowest, lower);
    }
    ++i;
  }
  return {false, std::max(0.0, lowest - threshold)};
}

bool TargetContact::target_inside(const Body& body, const Pose& target_from_body) const {
  const Pose body_from_target = target_from_body.inverse();
  return std::any_of(shell_points_.begin(), shell_points_.end(),
                     [&](const Vector3& p) { return body.tree().contains(body_from_target * p); });
}

std::size_t TargetContact::first_reach(const BodyPath& path, std::size_t body, const Pose& base_from_target,
                                       double threshold, std::size_t from, std::size_t to) const {
  if (from >= to) return to;
  const Pose target_from_base = base_from_target.inverse();
  const std::size_t none = to;
  if (threshold < BodyPath::region_margin) {
    from = std::max(from, path.near_region(body).begin);
    to = std::min(to, path.near_region(body).end);
  }
  for (std::size_t i = from; i < to;) {
    const Pose target_from_body = target_from_base * path.base_from_body(i, body);
    const Reach at = reach(bodies_->body(body), target_from_body, threshold);
    if (at.hit || (threshold >= 0.0 && target_inside(bodies_->body(body), target_from_body))) return i;
    const double free_until = path.travelled(i, body) + at.clearance;
    for (++i; i < to && path.travelled(i, body) < free_until;) ++i;
  }
  return none;
}

std::optional<std::size_t> TargetContact::first_reach(const BodyPath& path, const Pose& base_from_target,
                                                      double threshold, std::size_t from) const {
  std::size_t first = path.size();
  for (std::size_t body = 0; body < bodies_->size(); ++body)
    first = std::min(first, first_reach(path, body, base_from_target, threshold, from, first));
  return first == path.size() ? std::nullopt : std::optional(first);
}

std::optional<std::size_t> TargetContact::first_contact(const BodyPath& path, const Pose& base_from_target) const {
  return first_reach(path, base_from_target, margin_, 1);
}

std::optional<std::size_t> TargetContact::first_within(const BodyPath& path, const Pose& base_from_target,
                                                       double radius, std::size_t from) const {
  return first_reach(path, base_from_target, radius, from);
}

bool TargetContact::touches(const BodyPath& path, std::size_t waypoint, const Pose& base_from_target) const {
  return within(path, waypoint, base_from_target, margin_);
}

bool TargetContact::within(const BodyPath& path, std::size_t waypoint, const Pose& base_from_target,
                           double radius) const {
  for (std::size_t body = 0; body < bodies_->size(); ++body)
    if (first_reach(path, body, base_from_target, radius, waypoint, waypoint + 1) == waypoint) return true;
  return false;
}

std::optional<std::size_t> TargetContact::first_certain_contact(const BodyPath& path, const Pose& base_from_target,
                                                                double radius, std::size_t from) const {
  return first_reach(path, base_from_target, -radius, from);
}

ContactInterval TargetContact::first_contact_interval(const BodyPath& path, const Pose& base_from_target,
                                                      double radius) const {
  return {first_reach(path, base_from_target, radius + margin_, 1).value_or(path.size()),
          first_certain_contact(path, base_from_target, radius).value_or(path.size())};
}

Nearest TargetContact::nearest(const BodyPath& path, std::size_t waypoint, const Pose& base_from_target) const {
  Nearest result;
  const Pose target_from_base = base_from_target.inverse();
  for (std::size_t body = 0; body < bodies_->size(); ++body) {
    const BodyPath::Range& near = path.near_region(body);
    if (waypoint < near.begin || waypoint >= near.end) continue;
    const Pose target_from_body = target_from_base * path.base_from_body(waypoint, body);
    const std::vector<SurfaceBall>& balls = bodies_->body(body).balls();
    const std::vector<int>& leaves = bodies_->body(body).leaves();
    for (std::size_t k = 0; k < leaves.size(); k += leaf_stride) {
      const Vector3 centre = target_from_body * balls[leaves[k]].centre;
      const double estimate = field_.bounds(centre).upper;
      if (estimate < result.distance) result.distance = estimate, result.point = centre;
    }
    for (int i = 0; i < static_cast<int>(balls.size());) {
      const SurfaceBall& ball = balls[i];
      const Vector3 centre = target_from_body * ball.centre;
      const geometry::DistanceBounds bounds = field_.bounds(centre);
      if (bounds.lower - ball.radius >= result.distance || (ball.triangle >= 0 && bounds.lower >= result.distance)) {
        i = ball.next;
        continue;
      }
      if (ball.triangle >= 0) {
        const double estimate =
            bounds.upper > field_border ? 0.5 * (bounds.lower + bounds.upper) : field_.estimate(centre);
        if (estimate < result.distance) result.distance = estimate, result.point = centre;
      }
      ++i;
    }
  }
  result.gradient = field_.gradient(result.point);
  return result;
}

}  // namespace tactus::contact
