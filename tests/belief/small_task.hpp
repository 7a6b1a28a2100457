// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "action/library.hpp"
#include "belief/belief.hpp"

/// A task made in code: a gantry with a wrist (slides x y z, then turns about x y z) that carries a box with a square
/// pin, and a box with a blind square hole somewhere in y and z, turned about x. The pin goes in along x.
namespace tactus::test {

using geometry::Mesh;
using geometry::Pose;
using geometry::PoseVector;
using geometry::Vector3;
using robot::JointVector;

struct SmallTask {
  double roll_width = 1.0;       ///< rad, of the prior
  double position_width = 0.08;  ///< m, of the prior in y and z
  double depth_width = 0.0;      ///< m, of the prior in x
  double voxel_size = 0.005;     ///< m
  std::size_t delta = 1500;      ///< of 4,000 voxels or so
  std::size_t most_cells = 1500;
  action::Sensing sensing{};
  std::vector<scene::Guess> guesses{};
  int seats = 1;  ///< of the four in which the pin fits, a quarter turn apart
};

std::vector<Mesh> tool_pieces();  ///< closed, overlapping
Mesh socket();

scene::Scene small_scene(const SmallTask& small = {});
std::shared_ptr<const action::Task> small_task(const SmallTask& small = {});
std::shared_ptr<const belief::Model> small_model(belief::Kind kind, const SmallTask& small = {});
std::shared_ptr<const belief::Model> small_model(std::shared_ptr<const action::Task> task, belief::Kind kind,
                                                 const SmallTask& small = {});

/// Joint values from a list.
JointVector joints(std::initializer_list<double> values);

/// Uniform in the prior.
PoseVector random_pose(const scene::Prior& prior, support::Rng& rng);

/// A probe, a primitive or an insertion at a pose of the prior, from `q`.
action::Action random_action(const action::Task& task, action::ActionLibrary& library, const JointVector& q,
                             support::Rng& rng);

/// The insertion at a target at `base_from_target`, with the way to its start from `q`.
action::Action insertion_at(const action::Task& task, action::ActionLibrary& library, const JointVector& q,
                            const Pose& base_from_target);

/// An action along given waypoints.
action::Action action_along(const action::Task& task, const std::vector<JointVector>& waypoints);

/// An action straight from each of some corners to the next, in steps of 4 mm.
action::Action action_round(const action::Task& task, const std::vector<JointVector>& corners);

}  // namespace tactus::test
