// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "belief/belief.hpp"

namespace tactus::simulation {

struct WorldOptions {
  double fineness = 10.0;  ///< the world's steps are so many times finer than the action's
};

/// A simulated robot with a target at a hidden pose. It shares no contact code with the planner: boolean mesh collision
/// and containment at finer steps.
class World {
 public:
  /// Throws `invalid_argument` if the pose is not finite or outside the prior, `start_in_collision` if the robot's
  /// start touches the target.
  World(std::shared_ptr<const belief::Model> model, const geometry::Pose& base_from_target,
        const WorldOptions& options = {});
  ~World();

  /// Executes an action guarded: stops at the first contact and reports where; then goes back to the last free
  /// waypoint, as a real robot's driver does.
  belief::Observation execute(const action::Action& action);

  /// The tool got to the seated pose, within tolerance, and without contact.
  bool inserted() const { return inserted_; }

  const geometry::Pose& base_from_target() const { return base_from_target_; }
  const robot::JointVector& configuration() const { return q_; }

  /// What the tool frame has gone so far, retreats included.
  const motion::ToolTravel& travelled() const { return travelled_; }

 private:
  struct Solids;
  bool in_contact(const robot::JointVector& q) const;
  void travel_to(const robot::JointVector& q);

  std::shared_ptr<const belief::Model> model_;
  geometry::Pose base_from_target_;
  WorldOptions options_;
  std::unique_ptr<const Solids> solids_;
  robot::JointVector q_;
  bool inserted_ = false;
  motion::ToolTravel travelled_;
};

}  // namespace tactus::simulation
