// SPDX-License-Identifier: BSD-3-Clause
#include "belief/belief.hpp"

#include <algorithm>
#include <cmath>

#include "support/error.hpp"

namespace tactus::belief {
namespace {

using support::Error;
using support::Status;

constexpr double sure = 0.99;               // of the weight, where observations may err
constexpr double prospect = 0.001;          // of the weight of cells, for parts to be asked
constexpr std::size_t parts_weighed = 200;  // whether they are seated
constexpr double weighed_radius = 0.0008;   // m, of those
/// Of a robot that was said not to err, and did.
constexpr action::Sensing suspected{
    .stopping_distance = 0.002, .encoder_error = 0.0001, .missed_contacts = 0.02, .false_contacts = 0.02};

constexpr std::size_t parts_asked = 400;              // whether they are seated
constexpr std::uint64_t looks_to_look = 4'000'000;    // of the contact engine, into cells
constexpr std::uint64_t looks_to_prove = 40'000'000;  // the same, to prove that the tool is seated
constexpr std::size_t crowded = 5;                    // cells for each there is room for: no more are looked into
constexpr double hardly_less = 0.97;                  // of the weight, left by an observation that told next to nothing
constexpr std::uint32_t patience = 3;                 // such observations in a row

}  // namespace

Model::Model(std::shared_ptr<const Task> t, const Options& o)
    : task(std::move(t)), options(o), voxels(std::make_shared<VoxelModel>(*task, o.voxel_size)) {
  if (task->options().sites)
    options.cells.tables = std::make_shared<CellTables>(*task, CellBelief::shape(task->scene().prior, o.cells));
}

Belief::Belief(std::shared_ptr<const Model> model, const JointVector& q) : model_(std::move(model)) {
  check_configuration(q, "q");
  q_ = q;
  begin();
  is_goal_ = is_seated();
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
  if (q == q_) return;
  q_ = q;
  is_goal_ = is_seated();
}

void Belief::step(const Action& action, const Observation& observation) {
  const Stop stop = locate(task(), action, observation);
  Belief next = *this;
  next.q_ = action.path[stop.last_free];
  if (!observation.contact && stop.segment > stop.last_free) next.q_ = observation.q;
  next.history_.push_back(trace_of(task(), action, observation, stop));
  if (next.weighed_)
    next.weigh();
  else if (!next.learn({&next.history_.back()}) || !next.look_closer(*this))
    next.suspect();
  next.is_goal_ = next.is_seated() || next.prove_seated();
  *this = std::move(next);
}

/// With the prior, and no history.
void Belief::begin() {
  if (task().options().sensing.errs()) {
    weighed_.emplace(task(), task().options().sensing, model_->options.cells);
    weighed_->update(task(), history_);
    return explain();
  }
  if (model_->options.kind == Kind::hierarchical)
    voxels_.emplace(model_->voxels);
  else
    cells_.emplace(task(), model_->options.cells);
  learn({});
}

/// Takes in traces, and hands over once |PO| <= delta. False if nothing is left then.
bool Belief::learn(const std::vector<const Trace*>& traces) {
  if (cells_) return cells_->update(task(), traces) && refine();
  for (const Trace* trace : traces) voxels_->update(task(), *trace);
  const std::size_t left = voxels_->possibly_occupied().count();
  return left > 0 && (left > model_->options.delta || hand_over());
}

/// The cells whose target may lie inside PO and that may have given every observation take over.
bool Belief::hand_over() {
  cells_.emplace(task(), model_->options.cells);
  const auto outside = [this](const Pose& pose, double radius) { return voxels_->excludes(pose, radius); };
  const bool possible = cells_->update(task(), believed(history_), outside) && refine();
  voxels_.reset();
  return possible;
}

/// Cells all of whose poses are seated need not be finer. False if nothing is left.
bool Belief::refine() {
  const bool may_be_seated = history_.empty() || !history_.back().contact;
  const Pose base_from_tool = task().base_from_tool(q_);
  return cells_->refine(task(), history_,
                        [&](const Cell& cell) { return may_be_seated && is_seated(base_from_tool, cell); });
}

/// Takes in the last trace, of a robot that may err.
void Belief::weigh() {
  history_.back() = retraced(task(), history_.back(), weighed_->sensing());
  if (weighed_->update(task(), history_)) return explain();
  suspect();
}

/// The history can't have been without errors, or without more of them than were told: all of it is weighed, from the
/// prior on, as if the robot were a poor one.
void Belief::suspect() {
  health_ = Health::contradicted;
  const action::Sensing sensing = action::worse_of(this->sensing(), suspected);
  for (Trace& trace : history_) trace = retraced(task(), trace, sensing);
  weighed_.emplace(task(), sensing, model_->options.cells);
  weighed_->update(task(), history_);
  voxels_.reset();
  explain();
}

/// Doubts what the likeliest explanation takes for wrong.
void Belief::explain() {
  for (Trace& trace : history_) trace.doubted = false;
  for (const std::size_t trace : weighed_->doubted()) {
    history_[trace].doubted = true;
    health_ = Health::contradicted;
  }
  cells_ = CellBelief::weighed(task(), model_->options.cells, weighed_->cells());
}

const action::Sensing& Belief::sensing() const { return weighed_ ? weighed_->sensing() : task().options().sensing; }

JointPath Belief::way_back() const {
  JointPath way{q_};
  for (auto trace = history_.rbegin(); trace != history_.rend(); ++trace) {
    const auto here = std::find(trace->path.rbegin(), trace->path.rend(), way.back());
    if (here == trace->path.rend()) break;
    for (auto waypoint = here + 1; waypoint != trace->path.rend(); ++waypoint) {
      way.erase(std::find(way.begin(), way.end(), *waypoint), way.end());
      way.push_back(*waypoint);
    }
  }
  return way;
}

/// Goes on to cells of a millimetre or so where there is no room for all that are in between: coarse ones can't be told
/// from what touches them, and most of them are empty. To finer ones, and from a grid too, where the observations no
/// longer tell anything, as is the case where they contradict each other more subtly than cells can tell. False if
/// nothing is left.
bool Belief::look_closer(const Belief& before) {
  if (!cells_ || is_seated()) return true;
  standstill_ = before.cells_ && cells_->weight() > hardly_less * before.cells_->weight() ? standstill_ + 1 : 0;
  const bool is_stuck = standstill_ >= patience;
  Looked looked = is_stuck ? look_closer(fine_radius) : Looked::gave_up;
  if (looked == Looked::gave_up && (is_stuck || !cells_->grid())) looked = look_closer(part_radius);
  return looked != Looked::none;
}

/// Unless that takes too long.
Looked Belief::look_closer(double radius) {
  const std::size_t room = model_->options.cells.most;
  if (cells_->coarsest() <= radius || cells_->size() > crowded * room) return Looked::gave_up;
  support::Rng rng(fingerprint(history_, history_.size()));
  constexpr auto most = static_cast<double>(looks_to_look);
  if (cells_->estimated_looks(task(), history_, radius, most, rng) > most) return Looked::gave_up;
  const auto fine = [&](const Cell& cell) { return cells_->radius(cell) <= radius; };
  const Looked looked = cells_->look_inside(task(), history_, fine, 2 * looks_to_look);
  if (looked != Looked::all) return looked;
  standstill_ = 0;
  return refine() ? Looked::all : Looked::none;
}

/// Whether the tool is seated at every pose of a cell.
bool Belief::is_seated(const Pose& base_from_tool, const Cell& cell) const {
  return task().scene().is_seated(base_from_tool, geometry::pose_from(cell.centre), cells_->half_width(cell));
}

bool Belief::is_seated() const {
  if (weighed_) return is_likely_seated();
  if (!cells_ || (!history_.empty() && history_.back().contact)) return false;
  const Pose base_from_tool = task().base_from_tool(q_);
  return cells_->all_of([&](const Cell& cell) { return is_seated(base_from_tool, cell); });
}

/// Of almost all that the likelier explanations leave possible, as far as parts drawn by weight tell.
bool Belief::is_likely_seated() const {
  if (history_.empty() || history_.back().contact) return false;
  const Pose base_from_tool = task().base_from_tool(q_);
  const auto seated_at = [&](const Cell& cell) {
    return task().scene().is_seated(base_from_tool, geometry::pose_from(cell.centre));
  };
  double seated = 0.0;
  cells_->for_each([&](const Cell& cell) { seated += seated_at(cell) ? cells_->weight(cell) : 0.0; });
  if (seated < prospect * cells_->weight()) return false;
  support::Rng rng(fingerprint(history_, history_.size()));
  const auto parts = weighed_->draw_parts(task(), history_, parts_weighed, weighed_radius, rng);
  const auto count = std::count_if(parts.begin(), parts.end(),
                                   [&](const WeighedCells::Weighed& part) { return seated_at(part.cell); });
  return !parts.empty() && static_cast<double>(count) >= sure * static_cast<double>(parts.size());
}

/// The same where the cells are too coarse to tell. Not tried unless most of some parts of cells drawn by lot are
/// seated.
bool Belief::prove_seated() {
  if (!cells_ || weighed_ || cells_->grid() || history_.empty() || history_.back().contact) return false;
  const Pose base_from_tool = task().base_from_tool(q_);
  const auto seated = [&](const Cell& cell) { return is_seated(base_from_tool, cell); };
  support::Rng rng(fingerprint(history_, history_.size()));
  const std::vector<Cell> parts = cells_->draw_parts(task(), history_, parts_asked, fine_radius, rng);
  if (2 * static_cast<std::size_t>(std::count_if(parts.begin(), parts.end(), seated)) <= parts.size()) return false;
  return cells_->look_inside(task(), history_, seated, looks_to_prove) == Looked::all;
}

}  // namespace tactus::belief
