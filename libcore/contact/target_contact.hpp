// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "contact/body_path.hpp"
#include "contact/target_field.hpp"

namespace tactus::contact {

/// The waypoints at which a pose somewhere in a cell may first be touched: no pose in it is touched before `earliest`
/// nor stays free up to and including `latest`.
struct ContactInterval {
  std::size_t earliest = 0;  ///< the path's size: certainly never
  std::size_t latest = 0;    ///< the path's size: perhaps never
};

/// The point of the robot that is deepest in the target, or nearest to it.
struct Nearest {
  double distance = 1e300;             ///< signed, m: negative inside the target
  Vector3 point = Vector3::Zero();     ///< on the robot, in the target's frame
  Vector3 gradient = Vector3::Zero();  ///< of the signed distance there, in the target's frame
};

/// What one look at a body tells.
struct Reach {
  bool hit = false;
  double clearance = 0.0;   ///< m: without a hit, no point of the body moved by less than this brings one
  std::uint64_t looks = 0;  ///< that it took, as `Effort` has it
};

/// What answers took: one look each, and one more for each walk through a body's tree and each piece of it that was
/// looked at by itself. The same on every machine; 0.2 to 0.9 us each.
struct Effort {
  std::uint64_t looks = 0;
};

/// Answers the one question of the planner: at which waypoint of a motion does the robot first touch the target, were
/// the target at this pose?
///
/// Two solids are in contact when closer than the margin, or one inside the other; an open mesh is its surface. The
/// first waypoint does not count. The answer is that of testing every triangle pair at every waypoint; waypoints are
/// skipped only where a bound on the motion proves them free. Const, shared by any number of threads.
class TargetContact {
 public:
  /// `target` in its own frame; `margin` in metres. All kernels give the same answers.
  TargetContact(std::shared_ptr<const RobotBodies> bodies, const Mesh& target, double margin,
                const kernel::Kernel& kernel = kernel::fastest());

  /// The first waypoint >= 1 in contact; none if the whole path is free.
  std::optional<std::size_t> first_contact(const BodyPath& path, const Pose& base_from_target) const;

  /// The first waypoint >= `from` at which the robot, inflated by `radius` (m, >= 0), touches the target; 0 asks for
  /// crossing or containment, without a margin. Exact up to the margin; wider reaches may err to an earlier waypoint,
  /// by up to twice the larger of a piece's radius and 0.4 of the reach. Adds to `effort` if there is one.
  std::optional<std::size_t> first_within(const BodyPath& path, const Pose& base_from_target, double radius,
                                          std::size_t from = 1, Effort* effort = nullptr) const;

  /// Whether the robot touches the target at one waypoint.
  bool touches(const BodyPath& path, std::size_t waypoint, const Pose& base_from_target) const;

  /// The interval for all poses at which no point of the target is farther than `radius` (m) from where it is at
  /// `base_from_target`. Law: every such pose has its first contact in the interval.
  ContactInterval first_contact_interval(const BodyPath& path, const Pose& base_from_target, double radius) const;

  /// The first waypoint >= `from` whose robot, deflated by `radius` (m, > 0), certainly meets the target; none if no
  /// such waypoint is found.
  std::optional<std::size_t> first_certain_contact(const BodyPath& path, const Pose& base_from_target, double radius,
                                                   std::size_t from = 1, Effort* effort = nullptr) const;

  /// The same of one body and the waypoints in [from, to); `to` if there is none.
  std::size_t first_certain_contact(const BodyPath& path, std::size_t body, const Pose& base_from_target, double radius,
                                    std::size_t from, std::size_t to) const;

  /// The first waypoint in [from, to) at which a body, deflated by `radius` (m; inflated if that is negative), may have
  /// a point of its surface in the target: errs to an earlier one, as `first_within`. `to` if there is none.
  std::size_t first_possible_contact(const BodyPath& path, std::size_t body, const Pose& base_from_target,
                                     double radius, std::size_t from, std::size_t to) const;

  /// Whether the robot comes within `radius` (m) of the target at a waypoint; errs as `first_within`.
  bool within(const BodyPath& path, std::size_t waypoint, const Pose& base_from_target, double radius) const;

  /// One look at one body: does it, inflated by `threshold` (m) if that is positive, deflated if it is negative, meet
  /// the target? (As `first_within` and `first_certain_contact`.)
  Reach reach(std::size_t body, const Pose& target_from_body, double threshold) const {
    return reach(bodies_->body(body), target_from_body, usual(threshold));
  }

  /// The deepest or nearest point at a waypoint, of the bodies near the region, found to a tenth of a millimetre or so:
  /// by the pieces whose middles come nearest, and of these the corners. Its distance is exact below a centimetre, but
  /// another point may be nearer: nothing sound may rest on it. Some 10 us.
  Nearest nearest(const BodyPath& path, std::size_t waypoint, const Pose& base_from_target) const;

  const Mesh& target() const { return target_; }
  const geometry::DistanceField& field() const { return field_; }
  const RobotBodies& bodies() const { return *bodies_; }
  double margin() const { return margin_; }

 private:
  struct Sides;
  struct Closest;
  struct Asked {
    double threshold;  ///< m by which the robot is inflated; deflated if it is negative
    bool errs_to_hit;  ///< where it is much wider or deeper than what would have to be looked at; else to none
  };
  static Asked usual(double threshold) { return {threshold, threshold > 0.0}; }
  Reach reach(const Body& body, const Pose& target_from_body, const Asked& asked) const;
  bool piece_hit(const Piece& piece, const Pose& target_from_body, const kernel::Placement& at,
                 const Asked& asked) const;
  bool crosses(const Piece& piece, const Pose& target_from_body, const kernel::Placement& at, double reach) const;
  double estimate(const Vector3& p) const;
  void look_at(const Piece& piece, const Pose& target_from_body, Closest& closest) const;
  void look_closely(const Piece& piece, const Pose& target_from_body, Nearest& best) const;
  void nearest(const Body& body, const Pose& target_from_body, Closest& closest) const;
  bool target_inside(const Body& body, const Pose& target_from_body) const;
  std::uint32_t near_waypoints(const BodyPath& path, std::size_t body, std::size_t block,
                               const kernel::Placement& target_from_base, double reach) const;
  std::size_t first_reach(const BodyPath& path, std::size_t body, const Pose& target_from_base, const Asked& asked,
                          std::size_t from, std::size_t to, Effort* effort = nullptr) const;
  std::optional<std::size_t> first_reach(const BodyPath& path, const Pose& base_from_target, const Asked& asked,
                                         std::size_t from, Effort* effort = nullptr) const;

  std::shared_ptr<const RobotBodies> bodies_;
  Mesh target_;
  geometry::DistanceField field_;
  TargetField image_;
  Facets facets_;
  kernel::Extent extent_;
  const kernel::Kernel& kernel_;
  double margin_;
  std::vector<Vector3> shell_points_;  ///< one vertex of each shell of the target
};

}  // namespace tactus::contact
