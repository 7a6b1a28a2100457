// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <unordered_map>

#include "action/library.hpp"
#include "belief/belief.hpp"
#include "solver/predictions.hpp"
#include "solver/problem.hpp"

namespace tactus::solver {

/// The likelihood of the paper along one motion: for each waypoint, the probability that the first contact is there,
/// and last that there is none; given how many voxels of PO each waypoint newly enters (|S n PO|), |PO|, N, and for
/// each recorded contact the overlap and the distance of S to it (equations PO likelihood, C likelihood and their
/// product along the motion). Sums to one.
struct ContactEvidence {
  double overlap = 0.0;   ///< |S(q_i, a) n S(q_j, a_j)|
  double size = 0.0;      ///< |S(q_j, a_j)|
  double distance = 0.0;  ///< dist(S(q_i, a), S(q_j, a_j)), m
};
double contact_likelihood(double entered, double possibly_occupied, double target_voxels, double diameter,
                          const std::vector<ContactEvidence>& contacts);
std::vector<double> first_contact_probabilities(const std::vector<double>& contact_likelihood_at);

/// What planning on voxels shares between its beliefs: the motions made for one planning call and the voxels each
/// sweeps. One thread.
class VoxelProblem : public std::enable_shared_from_this<VoxelProblem> {
 public:
  /// `poses`: feasible poses of the target, for the calibrated likelihood; empty for the paper's. `cost_per_bit`: the
  /// least that a bit is worth to h_inad. What takes time throws `Cancelled` when `cancellation` does.
  VoxelProblem(std::shared_ptr<const belief::Model> model, std::shared_ptr<action::ActionLibrary> library,
               std::vector<geometry::Pose> poses, double cost_per_bit, support::Cancellation cancellation = {});

  /// The belief at the start. What a bit is worth to the heuristics of what follows depends on its choices: they are to
  /// be asked for first.
  BeliefStatePtr start(const robot::JointVector& q, const belief::VoxelBelief& voxels);

  /// By waypoint of a motion from where the robot is, the probability that the first contact is there, and last that
  /// there is none.
  std::vector<double> forecast(const belief::VoxelBelief& voxels, const action::MotionPtr& motion);

 private:
  friend class VoxelState;
  const support::Cancellation& cancellation() const { return predictions_.cancellation(); }
  const contact::SweptVoxels& swept(const action::MotionPtr& motion);
  const std::vector<action::MotionPtr>& anchored(const belief::VoxelBelief& voxels, const robot::JointVector& near);
  double bits_to_delta(double count) const;
  Values heuristic(double count, double to_nearest) const;
  void price_bits(double bits, std::vector<Choice>& at_start);

  std::shared_ptr<const belief::Model> model_;
  std::shared_ptr<action::ActionLibrary> library_;
  Predictions predictions_;
  double least_cost_per_bit_;
  double cost_per_bit_;      ///< of h_inad, from the greedy rate at the start
  double tool_reach_ = 0.0;  ///< m from the tool frame's origin to the tool's farthest vertex
  std::optional<std::vector<action::MotionPtr>> anchored_;
  std::unordered_map<const action::Motion*, contact::SweptVoxels> swept_;
  std::vector<action::MotionPtr> kept_;
};

}  // namespace tactus::solver
