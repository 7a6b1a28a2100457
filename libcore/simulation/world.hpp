// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "belief/belief.hpp"
#include "support/rng.hpp"

namespace tactus::simulation {

struct WorldOptions {
  /// The world's steps are so many times finer than the action's, and no longer than the scenario's stop tolerance.
  double fineness = 10.0;
  std::optional<action::Sensing> sensing{};  ///< what the robot really does; none: what the scenario says
  std::uint64_t seed = 1;                    ///< of what chance decides: the same, and the same actions: the same world
};

/// A simulated robot with a target at a hidden pose. It shares no contact code with the planner: boolean mesh collision
/// and containment at finer steps.
///
/// The robot is as imperfect as `WorldOptions::sensing` says. What it reports may be off, where it goes is not: every
/// motion ends at a waypoint of its path. A missed contact is missed for the whole motion, which then goes on through
/// the target. A touch that is there when a motion begins is felt only after the robot has been clear of it.
class World {
 public:
  /// Throws `invalid_argument` if the pose is not finite or outside the prior, or an option out of its range,
  /// `start_in_collision` if the robot's start touches the target.
  World(std::shared_ptr<const belief::Model> model, const geometry::Pose& base_from_target,
        const WorldOptions& options = {});

  /// Executes an action guarded: stops at the first contact that it feels and reports where; then goes back to the last
  /// free waypoint, as `belief::locate` has it from the report, as a real robot's driver does.
  /// Throws `invalid_argument` if the action does not begin where the robot is, `stop_off_path` if the encoders are off
  /// by more than the scenario allows; then nothing has changed.
  belief::Observation execute(const action::Action& action);

  /// The tool got to the seated pose, within tolerance, and the robot touched nothing on the way, felt or not.
  bool inserted() const { return inserted_; }

  const geometry::Pose& base_from_target() const { return base_from_target_; }
  const robot::JointVector& configuration() const { return q_; }

  /// What the tool frame has gone so far, retreats included.
  const motion::ToolTravel& travelled() const { return travelled_; }

 private:
  struct Solids;
  bool in_contact(const robot::JointVector& q) const;
  const action::Sensing& sensing() const { return *options_.sensing; }
  bool is_at(const robot::JointVector& q) const;
  motion::JointPath in_fine_steps(const motion::JointPath& path) const;
  void travel_to(const robot::JointVector& q);
  belief::Observation perform(const action::Action& action);
  std::optional<std::size_t> travel_until_felt(const motion::JointPath& path);
  void travel_on(const motion::JointPath& path, std::size_t step, double metres);
  void retreat(const action::Action& action, const belief::Observation& reported);
  robot::JointVector reported_joints();

  std::shared_ptr<const belief::Model> model_;
  geometry::Pose base_from_target_;
  WorldOptions options_;
  std::shared_ptr<const Solids> solids_;
  support::Rng rng_;
  robot::JointVector q_;
  bool touched_ = false;  // in the present motion, felt or not
  bool inserted_ = false;
  motion::ToolTravel travelled_;
};

}  // namespace tactus::simulation
