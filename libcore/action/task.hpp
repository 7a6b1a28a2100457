// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "action/tool_sites.hpp"
#include "contact/known_world.hpp"
#include "contact/target_contact.hpp"
#include "motion/connect.hpp"
#include "scene/scene.hpp"

namespace tactus::action {

using contact::BodyPath;
using motion::JointPath;
using robot::JointVector;

/// What a motion costs: metres of the tool frame, radians it turns, and a little for each action, so that no loop is
/// free.
struct CostWeights {
  double metre = 1.0;
  double radian = 0.05;  ///< per rad
  double action = 0.005;
};

struct MotionOptions {
  double step = 0.004;            ///< m that no point of the robot exceeds between waypoints
  double insertion_step = 0.001;  ///< the same on the last straight motion
  double speed = 0.25;            ///< of the tool in free transit, m/s
  double approach_speed = 0.1;    ///< where contact is possible
  double insertion_speed = 0.02;
  double acceleration = 0.5;        ///< of the tool, m/s^2
  double joint_acceleration = 4.0;  ///< rad/s^2
};

struct ActionOptions {
  std::vector<double> primitive_lengths{0.02, 0.06, 0.18};  ///< m
  std::vector<double> primitive_angles{0.2, 0.8};           ///< rad
  double probe_spacing = 0.04;                              ///< m between neighbouring sweeps
  std::vector<double> probe_depth{0.035};  ///< m behind the region's near side that the tool's tip sweeps at
  int insertion_candidates = 6;
  double standoff = 0.03;  ///< m between the tool and the region on the retreat plane
};

/// How what a robot reports may differ from what it does. All 0: it stops dead, knows where it is, and feels every
/// contact and nothing else.
struct Sensing {
  double stopping_distance = 0.0;  ///< m that a point of the robot may travel on after the first contact
  double encoder_error = 0.0;      ///< m: no point of the robot is farther off than the reported joints say
  double missed_contacts = 0.0;    ///< share of motions in which no contact is felt
  double false_contacts = 0.0;     ///< share of motions that are stopped by a contact that was none
  /// Whether a contact, or none, that it reports may not be true.
  bool errs() const { return missed_contacts > 0.0 || false_contacts > 0.0; }
  bool operator==(const Sensing&) const = default;
};

/// Of a robot that may err as much as either.
Sensing worse_of(const Sensing& a, const Sensing& b);

struct TaskOptions {
  MotionOptions motion;
  ActionOptions actions;
  CostWeights cost;
  double contact_margin = 1e-5;   ///< m
  double stop_tolerance = 0.001;  ///< m of tool motion before the reported stop within which the first contact may lie
  Sensing sensing;
  std::optional<ToolSites> sites;  ///< where the tool stands on its way; none: wherever the step allows
};

/// All that is const in a search: the scene, what collides with what, where motions are laid out, and the options.
/// Shared by any number of threads.
class Task {
 public:
  /// Throws `start_in_collision` if the start is not free, `prior_unreachable` if the arm reaches no pose of the prior,
  /// `bad_mesh`.
  Task(scene::Scene scene, TaskOptions options);

  const scene::Scene& scene() const { return scene_; }
  const TaskOptions& options() const { return options_; }
  const contact::KnownWorld& known_world() const { return *known_world_; }
  const contact::RobotBodies& bodies() const { return *bodies_; }
  const contact::TargetContact& target_contact() const { return *target_contact_; }
  const scene::SearchFrame& frame() const { return frame_; }
  double target_diameter() const { return target_diameter_; }  ///< D_max of the paper, m
  double target_reach() const { return target_reach_; }        ///< m from the target's origin to its farthest vertex
  const JointVector& home() const {
    return home_;
  }  ///< a free configuration at standoff, in the arm's posture for the search

  Pose base_from_tool(const JointVector& q) const;
  double cost(const motion::ToolTravel& travel) const;

  /// A free configuration for the tool at `base_from_tool`, in the posture of `home`, turned by less than a turn from
  /// `near`.
  std::optional<JointVector> posture(const Pose& base_from_tool, const JointVector& near) const;

  /// `motion::straight_tool_path` of the tool through the known world, from site to site where it leads from one to
  /// another along an axis. Throws `Cancelled`.
  std::optional<JointPath> straight_path(const JointVector& from, const Pose& base_from_goal, double step,
                                         const support::Cancellation& cancellation = {},
                                         bool keep_free_part = false) const;

  /// `base_from_goal`, moved to the nearest site if the tool at `base_from_start` stands on one and goes along an axis.
  Pose at_site(const Pose& base_from_start, const Pose& base_from_goal) const;

 private:
  JointVector find_home() const;
  double past_site(const Vector3& position) const;

  scene::Scene scene_;
  TaskOptions options_;
  std::unique_ptr<const contact::KnownWorld> known_world_;
  std::shared_ptr<const contact::RobotBodies> bodies_;
  std::unique_ptr<const contact::TargetContact> target_contact_;
  scene::SearchFrame frame_;
  double target_diameter_, target_reach_ = 0.0;
  JointVector home_;
};

}  // namespace tactus::action
