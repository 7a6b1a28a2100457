// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/prior.hpp"

namespace tactus::scenario {

/// What a scenario file says, key by key, as plain data: nothing is loaded yet. The members' initial values are the
/// defaults of the keys; `examples/scenarios/README.md` is the page for those who write such files. SI units, radians;
/// paths are absolute.

struct MeshSource {
  std::filesystem::path file;
  geometry::Vector3 scale = geometry::Vector3::Ones();  ///< metres a unit of the file, by axis; negative mirrors
};

struct RobotDescription {
  std::filesystem::path urdf;
  std::filesystem::path srdf;                             ///< empty: none
  std::map<std::string, std::filesystem::path> packages;  ///< `package://name/` -> folder
  geometry::Pose world_from_base = geometry::Pose::Identity();
  std::string tool_link;
  std::vector<double> start;  ///< (dof) rad or m
};

struct ToolDescription {
  MeshSource mesh;
  geometry::Pose tool_link_from_mesh = geometry::Pose::Identity();
};

/// A part of the static world: exactly one of `box` and `mesh` is there.
struct ObjectDescription {
  std::string name;
  std::optional<geometry::Vector3> box;  ///< full size, centred on the object's frame
  std::optional<MeshSource> mesh;
  geometry::Pose world_from_object = geometry::Pose::Identity();
};

/// How far two poses may lie apart, or how large a cell of poses is.
struct Resolution {
  double position;  ///< m
  double angle;     ///< rad
};

struct TargetDescription {
  MeshSource mesh;
  std::vector<geometry::Pose> target_from_seated_tool;  ///< of the tool link when done: at any of these
  geometry::Vector3 approach_axis =
      geometry::Vector3::UnitZ();  ///< unit, in the target's frame: where the last motion goes
  double approach_depth = 0.0;     ///< m: length of that motion, along which the tool may be inside the target
  Resolution tolerance{0.003, 0.15};
};

/// A pose of the target, as roughly known.
struct GuessDescription {
  geometry::PoseVector mean{};
  scene::Matrix6 covariance = scene::Matrix6::Identity();  ///< positive definite where the prior's widths are not 0
  double weight = 1.0;                                     ///< beside the others'
};

/// Where the target may be: in a box of x, y, z, roll, pitch, yaw in the robot's base frame. Uniformly, but for the
/// guesses.
struct PriorDescription {
  geometry::PoseVector centre{};
  geometry::PoseVector width{};           ///< full widths; 0: known
  std::vector<GuessDescription> guesses;  ///< of `normal` or `poses`
  double floor = 0.01;                    ///< share of the probability that is not the guesses'
};

struct BeliefDescription {
  std::string kind = "hierarchical";  ///< or "particles"
  double voxel_size = 0.01;           ///< m
  int delta = 3000;                   ///< number of voxels at which they are handed over to cells of poses
  Resolution cell{0.004, 0.06};       ///< of those cells at first
  int max_cells = 20000;
  int particles = 200;                    ///< poses drawn for planning
  int threads = 1;                        ///< that take in an observation, and more; 0: as many as the machine has
  std::string likelihood = "calibrated";  ///< of a contact on voxels; or "paper"
};

struct ContactDescription {
  double margin = 1e-5;           ///< m: closer is contact
  double stop_tolerance = 0.001;  ///< m: how far before the reported stop the first contact may lie
  double step = 0.004;            ///< m: most that a point of the robot moves between neighbours of a motion
  double insertion_step = 0.001;  ///< m: the same while inserting
};

/// How what the robot reports may differ from what it does.
struct SensingDescription {
  double stopping_distance = 0.0;  ///< m that a point of the robot may travel on after the first contact
  double encoder_error = 0.0;      ///< m: no point of the robot is farther off than the reported joints say
  double missed_contacts = 0.0;    ///< share of motions in which no contact is felt, in [0, 0.5]
  double false_contacts = 0.0;     ///< share of motions stopped by a contact that was none, in [0, 0.5]
};

struct MotionDescription {
  double speed = 0.25;              ///< m/s of the tool, free transit
  double approach_speed = 0.1;      ///< m/s
  double insertion_speed = 0.02;    ///< m/s
  double acceleration = 0.5;        ///< m/s^2 of the tool
  double joint_acceleration = 4.0;  ///< rad/s^2
};

struct ActionsDescription {
  std::vector<double> primitive_lengths{0.02, 0.06, 0.18};  ///< m
  std::vector<double> primitive_angles{0.2, 0.8};           ///< rad
  double probe_spacing = 0.04;                              ///< m
  std::vector<double> probe_depth{0.035};  ///< m behind the nearest possible point of the target along the approach
  int insertion_candidates = 6;
  double standoff = 0.03;  ///< m from the retreat plane to every pose of the prior
};

/// Cost is `metre` a metre of the tool frame's path, `radian` a radian it turns, `action` an action.
struct CostDescription {
  double metre = 1.0;
  double radian = 0.05;
  double action = 0.005;
};

struct PlannerDescription {
  std::string solver = "brtdp-bel";  ///< rtdp-bel, rtdp-inad, rtdp-ad, brtdp-bel, tbl, frontier or rate
  double budget_seconds = 1.0;
  std::uint64_t budget_expansions = 0;  ///< 0: none
  double epsilon = 0.5;                 ///< in [0, 1]
  int horizon = 8;
  double cost_per_bit = 0.035;  ///< m a bit
};

/// An episode ends at the first of these.
struct LimitsDescription {
  int actions = 200;
  double travel = 60.0;    ///< m
  double seconds = 600.0;  ///< s
};

struct Description {
  std::string name;  ///< the file's stem unless stated
  RobotDescription robot;
  ToolDescription tool;
  std::vector<ObjectDescription> world;
  TargetDescription target;
  PriorDescription prior;
  BeliefDescription belief;
  ContactDescription contact;
  SensingDescription sensing;
  MotionDescription motion;
  ActionsDescription actions;
  CostDescription cost;
  PlannerDescription planner;
  LimitsDescription limits;
};

/// Reads a scenario file; its relative paths are relative to its folder.
/// Throws `file_not_found`, `file_unreadable`, or `bad_scenario` with everything that is wrong with it, one line a
/// mistake: `shelf.yaml:12: prior.width.y: found -0.1, expected a number of at least 0`.
Description read_description(const std::filesystem::path& file);

/// The same from text. `name` stands for the file in messages.
Description parse_description(const std::string& yaml, const std::filesystem::path& base_dir,
                              const std::string& name = "scenario");

}  // namespace tactus::scenario
