// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "belief/cells.hpp"
#include "belief/voxels.hpp"
#include "belief/weighed_cells.hpp"
#include "support/deadline.hpp"
#include "support/rng.hpp"

namespace tactus::belief {

enum class Kind : std::int32_t { hierarchical = 1, particles = 2 };
/// How a planner weighs the outcomes of a motion on voxels: by the paper's equations, or by the share of feasible poses
/// that would be first touched there.
enum class Likelihood : std::int32_t { paper = 1, calibrated = 2 };
enum class Phase : std::int32_t { voxels = 1, poses = 2 };
enum class Health : std::int32_t { good = 0, contradicted = 1 };

struct Options {
  Kind kind = Kind::hierarchical;
  double voxel_size = 0.01;  ///< m
  std::size_t delta = 3000;  ///< voxels: with so many or fewer in PO, poses take over
  CellOptions cells;
  Likelihood likelihood = Likelihood::calibrated;
  std::size_t particles = 200;  ///< poses drawn for planning
};

/// A pose drawn for planning, and how far contacts and clearances of the history may be off there (m); 0: it reproduces
/// all of it.
struct Drawn {
  Pose pose = Pose::Identity();
  double miss = 0.0;
};

std::vector<Pose> poses_of(const std::vector<Drawn>& drawn);

/// What is const of every belief of a scenario. Shared.
struct Model {
  std::shared_ptr<const Task> task;
  Options options;
  std::shared_ptr<const VoxelModel> voxels;

  Model(std::shared_ptr<const Task> task, const Options& options);
};

struct Summary {
  Phase phase = Phase::voxels;
  Health health = Health::good;
  std::size_t observations = 0, contacts = 0, doubted = 0;
  std::size_t possibly_occupied = 0;  ///< voxels; 0 in the pose phase
  double volume = 0.0;                ///< m^3 of PO; 0 in the pose phase
  std::size_t cells = 0;              ///< 0 in the voxel phase
  double bits = 0.0;  ///< entropy of the pose in steps of the task's tolerances: log2 of how many of them it spans
  PoseVector mean{},
      extent{};  ///< of the target's pose: middle (angles: circular mean) and full extents, x y z roll pitch yaw
  std::array<double, 36> covariance{};  ///< of the same six, row-major
};

/// The robot's configuration and what is known of the target's pose: voxels first (phase 1), cells of poses after the
/// hand-over (phase 2), or cells throughout. A correct observation never removes the true pose. A value: copies are
/// independent. One thread at a time.
class Belief {
 public:
  /// Throws `invalid_argument` for a NaN or a wrong number of joints, `start_in_collision` for a configuration that is
  /// not free.
  Belief(std::shared_ptr<const Model> model, const JointVector& q);

  /// Takes in one observation. The configuration becomes the last free waypoint. Where the observations contradict each
  /// other the health says so from then on, and where no errors were told to the task some are taken to be possible:
  /// the cells weigh how well they explain the whole history, and what the likeliest explanation takes for wrong is
  /// doubted (`Trace::doubted`); it need not be the last. Throws as `locate`; then nothing has changed.
  void step(const Action& action, const Observation& observation);

  void set_configuration(const JointVector& q);

  const Model& model() const { return *model_; }
  const std::shared_ptr<const Model>& shared_model() const { return model_; }
  const Task& task() const { return *model_->task; }
  const JointVector& configuration() const { return q_; }
  const std::vector<Trace>& history() const { return history_; }
  Phase phase() const { return cells_ ? Phase::poses : Phase::voxels; }
  Health health() const { return health_; }
  const VoxelBelief& voxels() const { return *voxels_; }  ///< phase 1 only
  const CellBelief& cells() const { return *cells_; }     ///< phase 2 only
  /// What the cells' bits are of, once observations may err.
  const std::optional<WeighedCells>& weighed() const { return weighed_; }
  /// What is taken for possible of the robot: what the task says of it, or more once it must have erred more.
  const action::Sensing& sensing() const;

  /// The way by which the robot came to the present configuration, backwards: free of the target as of the rest of the
  /// world. As far as it is known without a gap, and without its loops; at least the configuration.
  JointPath way_back() const;

  /// At the present configuration every pose that may have given the history has the tool seated within tolerance, and
  /// the last motion was not stopped by a contact. Where observations may err, all but a hundredth of the weight. Found
  /// out by `step`, which splits cells for it without keeping the
  /// parts; after `set_configuration` by the cells as they are.
  bool is_goal() const { return is_goal_; }

  /// Whether the belief still holds this pose: it lies in the prior, and in the voxel phase every voxel centre inside
  /// the target there is possibly occupied; in the pose phase a cell holds it, and where observations may err one that
  /// is not a million times less likely than the likeliest. To 1e-9 m and rad; angles modulo whole
  /// turns, and in every way in which roll, pitch and yaw describe the same rotation.
  bool contains(const Pose& base_from_target) const;

  /// Up to `count` poses drawn from all over the cells (phase 2 only): first those that miss the history by no more
  /// than a quarter of a millimetre, most of them by nothing, then those that miss it by no more than a millimetre or
  /// 15 % of the coarsest cell's radius. `known`: poses drawn for an earlier state of this belief; up to two thirds
  /// come from those of them that the motions which met nothing leave possible. The rest is drawn afresh: where cells
  /// are few a sixteenth in those that are far from all others, however little they weigh, then from any cells, and
  /// where close ones are hard to find there from fine parts of cells, by lot from all over; if there are too few parts
  /// too, an eighth are anywhere in a cell, so that no part of the belief goes without a pose. Looks no further after
  /// `latest_draw`: what parts there are by then serve as they are, up to `count` of them. Throws `Cancelled`.
  std::vector<Drawn> draw(std::size_t count, support::Rng& rng, const std::vector<Drawn>& known = {},
                          const support::Deadline& deadline = support::Deadline::unlimited()) const;

  /// Phase 1: up to `count` poses drawn from the prior and brought into agreement with the history, to a millimetre at
  /// least, from no farther away than half a voxel's diagonal or so; up to two thirds of them from the `known` ones, as
  /// above. Fewer where they are rare; if fewer than ten, up to ten together with some that miss the history by half a
  /// voxel's diagonal. Looks no further after `latest_draw`. Throws `Cancelled`.
  std::vector<Drawn> draw_feasible(std::size_t count, support::Rng& rng, const std::vector<Drawn>& known = {},
                                   const support::Deadline& deadline = support::Deadline::unlimited()) const;

  Summary summary() const;  ///< O(cells)

  /// As the summary has it; O(1) for a grid of cells of a prior without weights.
  double bits() const;

  /// The whole state as bytes, versioned and with a checksum; `restore` gives a belief that acts like this one. Throws
  /// `bad_saved_state`, `wrong_scenario`.
  std::vector<std::uint8_t> save() const;
  static Belief restore(std::shared_ptr<const Model> model, const std::uint8_t* bytes, std::size_t size);

 private:
  explicit Belief(std::shared_ptr<const Model> model) : model_(std::move(model)) {}
  void check_configuration(const JointVector& q, const char* argument) const;
  bool learn(const std::vector<const Trace*>& traces);
  void begin();
  bool hand_over();
  bool refine();
  void weigh();
  void suspect();
  void explain();
  bool is_seated(const Pose& base_from_tool, const Cell& cell) const;
  bool is_seated() const;
  bool is_likely_seated() const;
  bool prove_seated();
  bool look_closer(const Belief& before);
  Looked look_closer(double radius);
  std::vector<Drawn> draw_explained(std::size_t count, support::Rng& rng, const support::Deadline& deadline) const;

  std::shared_ptr<const Model> model_;
  JointVector q_;
  std::vector<Trace> history_;
  Health health_ = Health::good;
  bool is_goal_ = false;
  std::uint32_t standstill_ = 0;  ///< observations in a row that told next to nothing
  std::optional<VoxelBelief> voxels_;
  std::optional<CellBelief> cells_;
  std::optional<WeighedCells> weighed_;
};

}  // namespace tactus::belief
