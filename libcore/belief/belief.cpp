// SPDX-License-Identifier: BSD-3-Clause
#include "belief/belief.hpp"

#include <algorithm>
#include <cmath>

#include "support/error.hpp"

namespace tactus::belief {
namespace {

using support::Error;
using support::Status;

constexpr std::size_t tries_per_pose = 2;     // of projections
constexpr std::size_t least_share = 3;        // of the poses wanted: so many are made up from near ones
constexpr std::size_t samples_per_pose = 40;  // of draws from the prior

}  // namespace

Model::Model(std::shared_ptr<const Task> t, const Options& o)
    : task(std::move(t)), options(o), voxels(std::make_shared<VoxelModel>(*task, o.voxel_size)) {}

Belief::Belief(std::shared_ptr<const Model> model, const JointVector& q) : model_(std::move(model)) {
  check_configuration(q, "q");
  q_ = q;
  if (model_->options.kind == Kind::hierarchical)
    voxels_.emplace(model_->voxels);
  else
    cells_.emplace(task(), model_->options.cells, [](const Pose&, double) { return true; });
  if (voxels_ && voxels_->possibly_occupied().count() <= model_->options.delta) hand_over();
}

void Belief::check_configuration(const JointVector& q, const char* argument) const {
  const int dof = task().scene().robot->dof();
  if (q.size() != dof)
    throw Error(Status::invalid_argument, std::string(argument) + ": found " + std::to_string(q.size()) +
                                              " joints, expected " + std::to_string(dof));
  for (int j = 0; j < dof; ++j)
    if (!std::isfinite(q[j]))
      throw Error(Status::invalid_argument, std::string(argument) + "[" + std::to_string(j) + "] (" +
                                                task().scene().robot->joints[j].name +
                                                "): found a value that is not finite, expected a joint position");
  const std::string collision = task().known_world().describe_collision(q);
  if (!collision.empty())
    throw Error(Status::start_in_collision, std::string(argument) + ": found " + collision +
                                                ", expected a configuration inside the limits and free of collisions");
}

void Belief::set_configuration(const JointVector& q) {
  check_configuration(q, "q");
  q_ = q;
}

void Belief::step(const Action& action, const Observation& observation) {
  const Stop stop = locate(task(), action, observation);
  Belief next = *this;
  next.q_ = action.path[stop.last_free];
  if (!observation.contact && stop.segment > stop.last_free) next.q_ = observation.q;
  next.history_.push_back(trace_of(task(), action, observation, stop));
  bool possible = true;
  if (next.voxels_) {
    next.voxels_->update(task(), next.history_.back());
    const std::size_t left = next.voxels_->possibly_occupied().count();
    possible = left > 0 && (left > model_->options.delta || next.hand_over());
  } else {
    possible = next.cells_->update(task(), next.history_.back()) &&
               next.cells_->refine(task(), next.history_, [&next](const CellBelief&) { return next.is_goal(); });
  }
  if (!possible) {
    const JointVector q = next.q_;
    next = *this;
    next.q_ = q;
    next.health_ = Health::contradicted;
  }
  *this = std::move(next);
}

/// |PO| <= delta: the cells whose target may lie inside PO and that may have given every observation take over.
bool Belief::hand_over() {
  const auto keep = [this](const Pose& pose, double radius) {
    return !voxels_->excludes(pose, radius) && std::all_of(history_.rbegin(), history_.rend(), [&](const Trace& trace) {
      return may_reproduce(task(), trace, pose, radius);
    });
  };
  cells_.emplace(task(), model_->options.cells, keep);
  voxels_.reset();
  return !cells_->cells().empty() && cells_->refine(task(), history_);
}

bool Belief::is_goal() const {
  if (!cells_ || (!history_.empty() && history_.back().contact)) return false;
  const Pose base_from_tool = task().base_from_tool(q_);
  return std::all_of(cells_->cells().begin(), cells_->cells().end(), [&](const Cell& cell) {
    return task().scene().is_seated(base_from_tool, geometry::pose_from(cell.centre), cells_->half_width(cell));
  });
}

std::vector<Pose> Belief::draw_feasible(std::size_t count, support::Rng& rng) const {
  std::vector<Pose> poses;
  const double radius = model_->voxels->grid.half_diagonal();
  for (std::size_t i = 0; i < samples_per_pose * count && poses.size() < count; ++i) {
    const Pose pose = task().scene().prior.sample(rng);
    if (std::all_of(history_.rbegin(), history_.rend(),
                    [&](const Trace& trace) { return may_reproduce(task(), trace, pose, radius); }))
      poses.push_back(pose);
  }
  return poses;
}

std::vector<Pose> Belief::draw(std::size_t count, support::Rng& rng, const std::vector<Pose>& known,
                               const support::Deadline& deadline) const {
  std::vector<Pose> poses;
  for (const Pose& pose : known)
    if (std::all_of(history_.rbegin(), history_.rend(),
                    [&](const Trace& trace) { return reproduces(task(), trace, pose); }))
      poses.push_back(pose);
  std::vector<Pose> near;
  for (std::size_t i = 0; i < tries_per_pose * count && poses.size() < count && deadline.used_fraction() < 0.5; ++i) {
    const auto drawn = cells_->draw(task(), history_, rng);
    if (drawn) (drawn->exact ? poses : near).push_back(drawn->pose);
  }
  for (std::size_t i = 0; i < near.size() && poses.size() < count / least_share; ++i) poses.push_back(near[i]);
  if (poses.empty()) poses.push_back(geometry::pose_from(cells_->cells()[cells_->draw_cell(rng)].centre));
  return poses;
}

}  // namespace tactus::belief
