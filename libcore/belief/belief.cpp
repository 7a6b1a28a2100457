// SPDX-License-Identifier: BSD-3-Clause
#include "belief/belief.hpp"

#include <algorithm>
#include <cmath>

#include "support/error.hpp"

namespace tactus::belief {
namespace {

using support::Error;
using support::Status;

constexpr double stops_per_waypoint = 8.0;  // that can be told apart
constexpr std::size_t few_cells = 400;      // enough to tell what an observation left out would leave possible
constexpr std::size_t few_at_first = 1u << 16;
constexpr std::size_t parts_asked = 400;     // whether they are seated
constexpr std::size_t tests_per_cell = 100;  // of parts when cells are looked into, for each cell there is room for

/// How unlikely it is to be stopped just there by a contact that is none, in bits: anywhere else on the way would have
/// been as likely. A contact that is missed has no such choice.
double surprise(const Trace& trace) {
  return trace.contact ? std::log2(stops_per_waypoint * static_cast<double>(trace.path.size())) : 0.0;
}

}  // namespace

Model::Model(std::shared_ptr<const Task> t, const Options& o)
    : task(std::move(t)), options(o), voxels(std::make_shared<VoxelModel>(*task, o.voxel_size)) {
  if (task->options().sites)
    options.cells.tables = std::make_shared<CellTables>(*task, CellBelief::shape(task->scene().prior, o.cells));
}

Belief::Belief(std::shared_ptr<const Model> model, const JointVector& q) : model_(std::move(model)) {
  check_configuration(q, "q");
  q_ = q;
  learn_anew(model_->options.cells);
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
  if (!next.learn({&next.history_.back()}, model_->options.cells)) next.doubt();
  next.look_closer();
  next.is_goal_ = next.is_seated() || next.prove_seated();
  *this = std::move(next);
}

/// From the prior and the history.
bool Belief::learn_anew(const CellOptions& options) {
  cells_.reset();
  voxels_.reset();
  if (model_->options.kind == Kind::hierarchical)
    voxels_.emplace(model_->voxels);
  else
    cells_.emplace(task(), options);
  return learn(believed(history_), options);
}

/// Takes in traces, and hands over once |PO| <= delta. False if nothing is left then.
bool Belief::learn(const std::vector<const Trace*>& traces, const CellOptions& options) {
  if (cells_)
    return cells_->update(task(), traces) &&
           cells_->refine(task(), history_, [this](const CellBelief&) { return is_seated(); });
  for (const Trace* trace : traces) voxels_->update(task(), *trace);
  const std::size_t left = voxels_->possibly_occupied().count();
  return left > 0 && (left > model_->options.delta || hand_over(options));
}

/// The cells whose target may lie inside PO and that may have given every observation take over.
bool Belief::hand_over(const CellOptions& options) {
  cells_.emplace(task(), options);
  const auto outside = [this](const Pose& pose, double radius) { return voxels_->excludes(pose, radius); };
  const bool possible = cells_->update(task(), believed(history_), outside) && cells_->refine(task(), history_);
  voxels_.reset();
  return possible;
}

/// The belief with these traces doubted, and no others; not learnt anew yet.
Belief Belief::doubting(const std::vector<std::size_t>& traces) const {
  Belief other = *this;
  for (Trace& trace : other.history_) trace.doubted = false;
  for (const std::size_t trace : traces) other.history_[trace].doubted = true;
  return other;
}

/// Of some ways to explain the history, each by traces to doubt, the likeliest: the one that leaves most possible, less
/// its surprise. Tried by few cells first.
std::optional<Belief> Belief::best_explanation(const std::vector<std::vector<std::size_t>>& ways) const {
  CellOptions few = model_->options.cells;
  few.most = std::min(few.most, few_cells);
  few.most_at_first = std::min(few.most_at_first, few_at_first);
  std::vector<std::pair<double, std::size_t>> found;
  for (std::size_t i = 0; i < ways.size(); ++i)
    if (Belief rough = doubting(ways[i]); rough.learn_anew(few)) {
      double likely = rough.summary().bits;
      for (const std::size_t trace : ways[i]) likely -= surprise(history_[trace]);
      found.emplace_back(-likely, i);
    }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [bits, i] : found)
    if (Belief whole = doubting(ways[i]); whole.learn_anew(model_->options.cells)) return whole;
  return std::nullopt;
}

/// The history contradicts itself: as few of its traces are doubted as explain it. First one alone; two in a row, as
/// after a missed contact, when the next motion sets out from inside the target, or one beside a single one doubted so
/// far; one beside several; and then more and more of the last, until what is left makes sense.
void Belief::doubt() {
  health_ = Health::contradicted;
  std::vector<std::size_t> so_far;
  for (std::size_t i = 0; i < history_.size(); ++i)
    if (history_[i].doubted) so_far.push_back(i);
  std::vector<std::vector<std::size_t>> ones, pairs, more;
  for (std::size_t i = history_.size(); i-- > 0;) {
    ones.push_back({i});
    if (i + 1 < history_.size()) pairs.push_back({i, i + 1});
    if (so_far.empty() || history_[i].doubted) continue;
    (so_far.size() == 1 ? pairs : more).emplace_back(so_far).push_back(i);
  }
  for (const auto& ways : {ones, pairs, more})
    if (auto best = best_explanation(ways)) {
      *this = std::move(*best);
      return;
    }
  for (std::vector<std::size_t> last = so_far; last.size() < so_far.size() + history_.size();) {
    last.push_back(history_.size() - 1 - (last.size() - so_far.size()));
    if (auto best = best_explanation({last})) {
      *this = std::move(*best);
      return;
    }
  }
}

JointPath Belief::way_back() const {
  JointPath way{q_};
  for (auto trace = history_.rbegin(); trace != history_.rend(); ++trace) {
    const auto here = std::find(trace->path.rbegin(), trace->path.rend(), way.back());
    if (here == trace->path.rend()) break;
    way.insert(way.end(), here + 1, trace->path.rend());
  }
  return way;
}

/// Goes on to cells of a millimetre or so where there is no room for all that are in between. Coarse ones can't be told
/// from what touches them: most of them are empty.
void Belief::look_closer() {
  if (!cells_ || cells_->grid() || cells_->coarsest() <= part_radius) return;
  const std::size_t most_tests = tests_per_cell * model_->options.cells.most;
  support::Rng rng(fingerprint(history_, history_.size()));
  if (cells_->estimated_tests(task(), history_, part_radius, rng) > static_cast<double>(most_tests)) return;
  const auto fine = [this](const Cell& cell) { return cells_->radius(cell) <= part_radius; };
  if (!cells_->look_inside(task(), history_, fine, 2 * most_tests)) return;
  cells_->refine(task(), history_, [this](const CellBelief&) { return is_seated(); });
}

/// Whether the tool is seated at every pose of a cell.
bool Belief::is_seated(const Pose& base_from_tool, const Cell& cell) const {
  return task().scene().is_seated(base_from_tool, geometry::pose_from(cell.centre), cells_->half_width(cell));
}

bool Belief::is_seated() const {
  if (!cells_ || (!history_.empty() && history_.back().contact)) return false;
  const Pose base_from_tool = task().base_from_tool(q_);
  return cells_->all_of([&](const Cell& cell) { return is_seated(base_from_tool, cell); });
}

/// The same where the cells are too coarse to tell. Not tried unless most of some parts of cells drawn by lot are
/// seated.
bool Belief::prove_seated() {
  if (!cells_ || cells_->grid() || history_.empty() || history_.back().contact) return false;
  const Pose base_from_tool = task().base_from_tool(q_);
  const auto seated = [&](const Cell& cell) { return is_seated(base_from_tool, cell); };
  support::Rng rng(fingerprint(history_, history_.size()));
  const std::vector<Cell> parts = cells_->draw_parts(task(), history_, parts_asked, fine_radius, rng);
  if (2 * static_cast<std::size_t>(std::count_if(parts.begin(), parts.end(), seated)) <= parts.size()) return false;
  return cells_->look_inside(task(), history_, seated, tests_per_cell * model_->options.cells.most);
}

}  // namespace tactus::belief
