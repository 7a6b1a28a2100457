// SPDX-License-Identifier: BSD-3-Clause
#include "solver/voxel_problem.hpp"

#include <algorithm>
#include <cmath>

#include "action/probes.hpp"

namespace tactus::solver {

using action::Motion;
using action::MotionPtr;
using belief::VoxelBelief;
using contact::Bitset;
using contact::SweptVoxels;
using contact::VoxelGrid;
using geometry::Box;
using geometry::Pose;
using geometry::Vector3;
using robot::JointVector;

namespace {

constexpr double overlap_epsilon = 1.0;  // the paper's epsilon, in voxels
constexpr double least_probability = 1e-6;
constexpr int lines_per_side = 9;
constexpr std::size_t least_poses = 10;  // below, the paper's likelihood answers

/// How many voxels of a set lie in a box: sums over all boxes from the grid's corner.
class BoxCounts {
 public:
  BoxCounts(const Bitset& set, const VoxelGrid& grid)
      : grid_(grid), sums_(std::size_t(grid.shape()[0] + 1) * (grid.shape()[1] + 1) * (grid.shape()[2] + 1)) {
    const auto [nx, ny, nz] = grid.shape();
    for (int z = 0; z < nz; ++z)
      for (int y = 0; y < ny; ++y) {
        std::int32_t row = 0;
        for (int x = 0; x < nx; ++x) {
          row += set.test(grid.index(x, y, z));
          at(x + 1, y + 1, z + 1) = row + at(x + 1, y, z + 1) + at(x + 1, y + 1, z) - at(x + 1, y, z);
        }
      }
  }

  int in(const Box& box) const {
    std::array<int, 3> low, high;
    grid_.range(box, low, high);
    for (int d = 0; d < 3; ++d)
      if (low[d] >= high[d]) return 0;
    int sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const int sign = (corner & 1 ? 1 : -1) * (corner & 2 ? 1 : -1) * (corner & 4 ? 1 : -1);
      sum += sign * at(corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1], corner & 4 ? high[2] : low[2]);
    }
    return sum;
  }

 private:
  std::size_t index(int x, int y, int z) const {
    return std::size_t(x) +
           std::size_t(grid_.shape()[0] + 1) * (std::size_t(y) + std::size_t(grid_.shape()[1] + 1) * std::size_t(z));
  }
  std::int32_t& at(int x, int y, int z) { return sums_[index(x, y, z)]; }
  std::int32_t at(int x, int y, int z) const { return sums_[index(x, y, z)]; }

  const VoxelGrid& grid_;
  std::vector<std::int32_t> sums_;
};

Box box_of(const Bitset& set, const VoxelGrid& grid, const Pose& frame_from_base) {
  Box box;
  set.for_each([&](std::size_t v) { box.add(frame_from_base * grid.centre(v)); });
  return box;
}

}  // namespace

double contact_likelihood(double entered, double possibly_occupied, double target_voxels, double diameter,
                          const std::vector<ContactEvidence>& contacts) {
  if (entered <= 0.0) return 0.0;
  const double others = possibly_occupied - target_voxels;
  double likelihood = others <= entered ? 1.0 : entered / others;
  for (const ContactEvidence& c : contacts)
    likelihood *= (c.overlap + overlap_epsilon) / (c.size + overlap_epsilon) *
                  std::max(0.0, 1.0 - std::max(0.0, c.distance) / diameter);
  return std::min(1.0, likelihood);
}

std::vector<double> first_contact_probabilities(const std::vector<double>& likelihood) {
  std::vector<double> probabilities;
  double still_free = 1.0;
  for (const double at : likelihood) {
    probabilities.push_back(still_free * at);
    still_free *= 1.0 - at;
  }
  probabilities.push_back(still_free);
  return probabilities;
}

/// A configuration, PO and C.
class VoxelState : public BeliefState {
 public:
  VoxelState(std::shared_ptr<VoxelProblem> problem, JointVector q, VoxelBelief voxels, Bitset feasible,
             bool at_start = false)
      : problem_(std::move(problem)),
        q_(std::move(q)),
        voxels_(std::move(voxels)),
        feasible_(std::move(feasible)),
        count_(voxels_.possibly_occupied().count()),
        at_start_(at_start) {}

  support::Hash128 hash() const override {
    std::uint64_t salt = action::path_id({q_});
    for (const belief::ContactRecord& record : voxels_.contacts()) salt += record.candidates.hash(1).low;
    salt ^= feasible_.hash(2).low;
    return voxels_.possibly_occupied().hash(salt);
  }
  const JointVector& configuration() const override { return q_; }
  std::size_t support_size() const override { return count_; }
  Values heuristic() const override {
    return done()
               ? Values{}
               : problem_->heuristic(static_cast<double>(count_), nearest(problem_->model_->task->base_from_tool(q_)));
  }

  std::vector<Choice> choices(const support::Deadline& deadline) const override {
    if (done()) return {};
    if (at_start_) problem_->cost_per_bit_ = 1.0;
    std::vector<Choice> result;
    const BoxCounts counts(voxels_.possibly_occupied(), grid());
    const auto consider = [&](const MotionPtr& motion) {
      if (!result.empty() && (at_start_ ? deadline.cancelled() : deadline.spent())) return;
      Choice choice = weigh(motion, counts);
      const bool moves = !motion->anchored && choice.outcomes.front().waypoint == motion->path.size();
      if (choice.outcomes.size() > 1 || moves) result.push_back(std::move(choice));
    };
    for (const MotionPtr& motion : problem_->anchored(voxels_, q_)) consider(motion);
    for (const MotionPtr& motion : problem_->library_->primitives_at(q_, problem_->cancellation())) consider(motion);
    if (at_start_) problem_->price_bits(bits_left(), result);
    return result;
  }

  BeliefStatePtr successor(const Choice& choice, const Outcome& outcome) const override {
    const Motion& motion = *choice.motion;
    const SweptVoxels& swept = problem_->swept(choice.motion);
    VoxelBelief next = voxels_;
    Bitset feasible = problem_->predictions_.subset(choice.motion, feasible_, outcome.waypoint, outcome.last);
    if (outcome.waypoint == motion.path.size()) {
      next.remove_free(swept.voxels, swept.voxels.size());
      return std::make_shared<VoxelState>(problem_, motion.path.back(), std::move(next), std::move(feasible));
    }
    const action::Task& task = *problem_->model_->task;
    next.remove_free(swept.voxels, swept.entered_by(outcome.waypoint - 1));
    const double step = motion.bodies.travelled(outcome.waypoint, 0) - motion.bodies.travelled(outcome.waypoint - 1, 0);
    next.add_contact(contact::contact_candidates(task.bodies(), motion.bodies, outcome.waypoint, grid(), step));
    return std::make_shared<VoxelState>(problem_, motion.path[outcome.waypoint - 1], std::move(next),
                                        std::move(feasible));
  }

  /// By waypoint, the probability that the first contact is there, and last that there is none.
  std::vector<double> forecast(const MotionPtr& motion) const {
    const SweptVoxels& swept = problem_->swept(motion);
    return forecast(motion, swept, entered_by(swept));
  }

 private:
  const VoxelGrid& grid() const { return voxels_.model().grid; }
  bool done() const { return count_ <= problem_->model_->options.delta; }
  double bits_left() const { return problem_->bits_to_delta(static_cast<double>(count_)); }

  double nearest(const Pose& base_from_tool) const {
    const Box box = box_of(voxels_.possibly_occupied(), grid(), Pose::Identity());
    return std::max(0.0, box.distance(base_from_tool.translation()) - problem_->tool_reach_);
  }

  Choice weigh(const MotionPtr& motion, const BoxCounts& counts) const {
    const SweptVoxels& swept = problem_->swept(motion);
    const std::vector<std::uint32_t> entered = entered_by(swept);
    return choice_of(motion, forecast(motion, swept, entered), swept, entered, counts);
  }

  std::vector<double> forecast(const MotionPtr& motion, const SweptVoxels& swept,
                               const std::vector<std::uint32_t>& entered) const {
    return calibrated() ? shares(motion) : first_contact_probabilities(likelihoods(swept, entered));
  }

  /// How many voxels each waypoint's S counts: those that a no-contact outcome would remove.
  std::vector<std::uint32_t> entered_by(const SweptVoxels& swept) const {
    std::vector<std::uint32_t> entered = contact::entered_of(swept, voxels_.possibly_occupied());
    entered.front() = 0;  // the robot is there already
    return entered;
  }

  /// Calls `visit(voxel)` for S(q_i, a) n PO.
  template <typename Visit>
  void for_each_entered(const SweptVoxels& swept, std::size_t waypoint, Visit&& visit) const {
    for (std::size_t k = swept.entered_by(waypoint - 1); k < swept.entered_by(waypoint); ++k)
      if (voxels_.possibly_occupied().test(swept.voxels[k])) visit(swept.voxels[k]);
  }

  /// The paper's, by waypoint, from how many voxels of PO each enters and the evidence of C.
  std::vector<double> likelihoods(const SweptVoxels& swept, const std::vector<std::uint32_t>& entered) const {
    const belief::VoxelModel& model = voxels_.model();
    std::vector<double> result(entered.size(), 0.0);
    for (std::size_t i = 1; i < entered.size(); ++i)
      if (entered[i] > 0)
        result[i] = contact_likelihood(entered[i], static_cast<double>(count_), model.target_voxels, model.diameter,
                                       evidence(swept, i));
    return result;
  }

  std::vector<ContactEvidence> evidence(const SweptVoxels& swept, std::size_t waypoint) const {
    std::vector<ContactEvidence> result;
    for (const belief::ContactRecord& contact : voxels_.contacts()) {
      ContactEvidence of_contact{0.0, static_cast<double>(contact.candidates.count()), 1e30};
      for_each_entered(swept, waypoint, [&](std::size_t v) {
        of_contact.overlap += contact.candidates.test(v) ? 1.0 : 0.0;
        of_contact.distance = std::min(of_contact.distance, static_cast<double>(contact.distance[v]));
      });
      result.push_back(of_contact);
    }
    return result;
  }

  /// Around S(q_i, a) n PO.
  Box box_entered(const SweptVoxels& swept, std::size_t waypoint) const {
    Box box;
    for_each_entered(swept, waypoint, [&](std::size_t v) { box.add(grid().centre(v)); });
    return box;
  }

  bool calibrated() const { return feasible_.count() >= least_poses; }

  /// The calibrated likelihood: of the feasible poses, the share that is first touched at each waypoint, and last the
  /// share that is not.
  std::vector<double> shares(const MotionPtr& motion) const {
    std::vector<double> result(motion->path.size() + 1, 0.0);
    const auto total = static_cast<double>(feasible_.count());
    for (const Group& group : problem_->predictions_.split(motion, feasible_))
      result[group.first] = static_cast<double>(group.poses.size()) / total;
    return result;
  }

  Choice choice_of(const MotionPtr& motion, const std::vector<double>& probability, const SweptVoxels& swept,
                   const std::vector<std::uint32_t>& entered, const BoxCounts& counts) const {
    const action::Task& task = *problem_->model_->task;
    const std::size_t waypoints = motion->path.size();
    const double lead =
        motion->anchored ? action::transit_cost(task, task.base_from_tool(q_), motion->base_from_start) : 0.0;
    const double within = voxels_.model().diameter + grid().half_diagonal();
    const auto delta = static_cast<double>(problem_->model_->options.delta);
    Choice choice{motion, {}};
    double kept = 0.0, remaining = static_cast<double>(count_);
    std::size_t last = 0;  // where the robot last entered PO: a contact is about there
    for (std::size_t i = 1; i <= waypoints; ++i) {
      remaining -= entered[i - 1];
      if (i < waypoints && entered[i] > 0) last = i;
      if (probability[i] < least_probability && i < waypoints) continue;
      Outcome outcome;
      outcome.waypoint = outcome.last = i;
      outcome.probability = probability[i];
      kept += outcome.probability;
      outcome.cost = task.options().cost.action + lead + motion->cost_to[std::min(i, waypoints - 1)];
      double left = remaining;
      if (i < waypoints && last > 0)
        left = std::min(left, static_cast<double>(counts.in(box_entered(swept, last).inflated(within))));
      outcome.goal = left <= delta;
      const Vector3 tool = motion->bodies.base_from_body(std::min(i, waypoints - 1), 0).translation();
      const double away = i < waypoints ? 0.0 : std::max(0.0, grid().box().distance(tool) - problem_->tool_reach_);
      if (!outcome.goal) outcome.heuristic = problem_->heuristic(left, away);
      choice.outcomes.push_back(outcome);
    }
    if (choice.outcomes.back().probability < least_probability && choice.outcomes.size() > 1) {
      kept -= choice.outcomes.back().probability;
      choice.outcomes.pop_back();
    }
    for (Outcome& outcome : choice.outcomes) outcome.probability /= kept;
    return choice;
  }

  std::shared_ptr<VoxelProblem> problem_;
  JointVector q_;
  VoxelBelief voxels_;
  Bitset feasible_;  ///< of the problem's poses
  std::size_t count_;
  bool at_start_;
};

VoxelProblem::VoxelProblem(std::shared_ptr<const belief::Model> model, std::shared_ptr<action::ActionLibrary> library,
                           std::vector<Pose> poses, double cost_per_bit, support::Cancellation cancellation)
    : model_(std::move(model)),
      library_(std::move(library)),
      predictions_(model_->task, std::move(poses), 0.0, {}, 1, cancellation),
      least_cost_per_bit_(cost_per_bit),
      cost_per_bit_(cost_per_bit) {
  for (const Vector3& v : model_->task->scene().tool.vertices) tool_reach_ = std::max(tool_reach_, v.norm());
}

BeliefStatePtr VoxelProblem::start(const JointVector& q, const VoxelBelief& voxels) {
  return std::make_shared<VoxelState>(shared_from_this(), q, voxels, Bitset(predictions_.poses().size(), true), true);
}

/// By the motions at the start, where so many `bits` are missing; they were weighed as if one were worth one unit of
/// cost.
void VoxelProblem::price_bits(double bits, std::vector<Choice>& choices) {
  std::vector<double> cost, gained;
  for (const Choice& choice : choices) {
    cost.push_back(choice.expected_cost());
    gained.push_back(bits);
    for (const Outcome& outcome : choice.outcomes)
      gained.back() -= outcome.probability * (outcome.heuristic[1] - outcome.heuristic[0]);
  }
  cost_per_bit_ = greedy_cost_per_bit(cost, gained, least_cost_per_bit_);
  solver::price_bits(choices, cost_per_bit_);
}

std::vector<double> VoxelProblem::forecast(const VoxelBelief& voxels, const MotionPtr& motion) {
  const Bitset all(predictions_.poses().size(), true);
  return VoxelState(shared_from_this(), motion->path.front(), voxels, all).forecast(motion);
}

const SweptVoxels& VoxelProblem::swept(const MotionPtr& motion) {
  const auto [entry, is_new] = swept_.try_emplace(motion.get());
  if (is_new) {
    entry->second = contact::swept_voxels(model_->task->bodies(), motion->bodies, model_->voxels->grid);
    kept_.push_back(motion);
  }
  return entry->second;
}

const std::vector<MotionPtr>& VoxelProblem::anchored(const VoxelBelief& voxels, const JointVector& near) {
  if (anchored_) return *anchored_;
  const Box box =
      box_of(voxels.possibly_occupied(), voxels.model().grid, model_->task->frame().base_from_search.inverse());
  return anchored_.emplace(
      library_->probes_in(box.inflated(0.5 * voxels.model().grid.pitch()), near, lines_per_side, cancellation()));
}

double VoxelProblem::bits_to_delta(double count) const {
  return std::log2(std::max(1.0, count / std::max(1.0, static_cast<double>(model_->options.delta))));
}

/// h_ad: the way to the nearest voxel that may be occupied; h_inad adds what the bits down to delta are worth.
Values VoxelProblem::heuristic(double count, double to_nearest) const {
  const double least = model_->task->options().cost.metre * to_nearest + model_->task->options().cost.action;
  return {least, least + cost_per_bit_ * bits_to_delta(count)};
}

}  // namespace tactus::solver
