// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/mesh.hpp"
#include "robot/kinematics.hpp"

namespace tactus::contact {

using geometry::Mesh;
using geometry::Pose;
using robot::JointVector;

/// What is known before the search: the robot (with its tool among the shapes of its tool link) and the static world.
/// Answers whether a configuration is free of collisions with itself and with the world. Const and shareable between
/// threads.
///
/// All pairs of links are checked but: rigidly connected ones, adjacent ones (one moving joint between them, looking
/// through links without shapes), those the SRDF disables, and those that collide at every one of 200 random
/// configurations. Links that no joint moves are not checked against the world. A shell wholly inside another, closed
/// one counts as a collision. [FCL]
class KnownWorld {
 public:
  /// `world_from_base` is folded in by the caller: `static_world` stands in the robot's base frame, closed meshes
  /// solid. One name a mesh. Throws `bad_mesh`, or `invalid_argument` if the names don't match.
  KnownWorld(std::shared_ptr<const robot::RobotModel> model, std::vector<Mesh> static_world,
             std::vector<std::string> static_names);
  ~KnownWorld();
  KnownWorld(const KnownWorld&) = delete;
  KnownWorld& operator=(const KnownWorld&) = delete;

  /// Inside the joint limits, and free of collisions. A NaN is never free.
  bool is_free(const JointVector& q) const;

  /// What collides, for an error message ("forearm_link with shelf"); empty if free. Also names a joint outside its
  /// limits.
  std::string describe_collision(const JointVector& q) const;

  const robot::RobotModel& model() const;
  /// The pairs of links that are checked, by index.
  const std::vector<robot::LinkPair>& checked_pairs() const;
  /// The radius about each link's origin that holds all its shapes, metres.
  const std::vector<double>& link_reach() const;

  /// Metres that no point of the robot exceeds between where it is at two configurations. For near neighbours the
  /// largest displacement of a corner of a shape's box (a rigid displacement is largest at a corner); where a joint
  /// moves more than 0.3, `robot::motion_bound`.
  double displacement(const JointVector& from, const JointVector& to) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tactus::contact
