// SPDX-License-Identifier: BSD-3-Clause
#include "belief/belief.hpp"

#include <algorithm>
#include <cmath>

#include "support/error.hpp"

namespace tactus::belief {
namespace {

using support::Error;
using support::Status;

constexpr std::size_t least_trial = 24;     // projections after which it is asked whether they pay:
constexpr std::size_t pays_from = 3;        // one in so many is exact
constexpr double least_near = 0.001;        // m by which a pose may miss the history and serve for planning
constexpr double near_share = 0.15;         // of a cell's radius by which it may
constexpr double part_radius = 0.0015;      // m, of parts of cells from which poses are looked for else
constexpr double least_step = -6.0;         // log2 of how much of a cell's width
constexpr std::size_t least_share = 3;      // of the poses wanted: so many are made up from others
constexpr double fine_radius = 0.0004;      // m, of cells any pose of which comes near enough as it is
constexpr std::size_t unproved_share = 8;   // of them anywhere in a cell, for what no other speaks for
constexpr double stops_per_waypoint = 8.0;  // that can be told apart
constexpr std::size_t few_cells = 400;      // enough to tell what an observation left out would leave possible
constexpr std::size_t few_at_first = 1u << 16;
constexpr std::size_t tests_per_cell = 100;   // of a proof, for each cell that there is room for
constexpr std::size_t samples_per_pose = 40;  // of draws from the prior
constexpr std::size_t tries_per_pose = 2;     // of those that come near, to agree with the history

/// How unlikely it is to be stopped just there by a contact that is none, in bits: anywhere else on the way would have
/// been as likely. A contact that is missed has no such choice.
double surprise(const Trace& trace) {
  return trace.contact ? std::log2(stops_per_waypoint * static_cast<double>(trace.path.size())) : 0.0;
}

}  // namespace

Model::Model(std::shared_ptr<const Task> t, const Options& o)
    : task(std::move(t)), options(o), voxels(std::make_shared<VoxelModel>(*task, o.voxel_size)) {}

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

/// Whether the tool is seated at every pose of a cell.
bool Belief::is_seated(const Pose& base_from_tool, const Cell& cell) const {
  return task().scene().is_seated(base_from_tool, geometry::pose_from(cell.centre), cells_->half_width(cell));
}

bool Belief::is_seated() const {
  if (!cells_ || (!history_.empty() && history_.back().contact)) return false;
  const Pose base_from_tool = task().base_from_tool(q_);
  return cells_->all_of([&](const Cell& cell) { return is_seated(base_from_tool, cell); });
}

/// The same where the cells are too coarse to tell.
bool Belief::prove_seated() {
  if (!cells_ || cells_->grid() || history_.empty() || history_.back().contact) return false;
  const Pose base_from_tool = task().base_from_tool(q_);
  const auto seated = [&](const Cell& cell) { return is_seated(base_from_tool, cell); };
  return cells_->prove(task(), history_, seated, tests_per_cell * model_->options.cells.most);
}

std::vector<Pose> Belief::draw_feasible(std::size_t count, support::Rng& rng, const support::Deadline& deadline) const {
  std::vector<Pose> poses;
  const double radius = model_->voxels->grid.half_diagonal();
  const auto lacks = [&] { return poses.size() < count && deadline.used_fraction() < 0.5; };
  std::size_t tried = 0;
  for (std::size_t i = 0; i < samples_per_pose * count && tried < tries_per_pose * count && lacks(); ++i) {
    const Pose pose = task().scene().prior.sample(rng);
    if (!may_reproduce(task(), history_, pose, radius)) continue;
    ++tried;
    if (const auto found = projected(task(), history_, geometry::pose_vector(pose), least_near))
      poses.push_back(geometry::pose_from(found->pose));
  }
  return poses;
}

/// What draws at random come to, by their worth for planning.
struct Belief::Drawn {
  std::vector<PoseVector> exact, near;

  void add(const std::optional<Projection>& projection) {
    if (projection) (projection->exact ? exact : near).push_back(projection->pose);
  }
  std::size_t size() const { return exact.size() + near.size(); }
  const PoseVector& any(support::Rng& rng) const {
    const std::size_t i = rng.below(size());
    return i < exact.size() ? exact[i] : near[i - exact.size()];
  }
};

/// A pose from a cell, brought into agreement with the history.
std::optional<Projection> Belief::agreeing(const Cell& cell, double near, support::Rng& rng) const {
  const PoseVector seed = cells_->draw_in(cell, rng);
  if (cells_->radius(cell) > fine_radius) return projected(task(), history_, seed, near);
  return Projection{seed, reproduces(task(), history_, geometry::pose_from(seed))};
}

/// A pose up to a cell's width off another, and mostly much less.
PoseVector Belief::beside(const PoseVector& from, support::Rng& rng) const {
  const Cell cell = cells_->draw_cell(rng);
  const PoseVector inside = cells_->draw_in(cell, rng);
  const double size = std::exp2(rng.uniform(least_step, 1.0));
  PoseVector seed = from;
  for (int d = 0; d < 6; ++d) seed[d] += size * (inside[d] - cell.centre[d]);
  return seed;
}

std::vector<Pose> Belief::draw(std::size_t count, support::Rng& rng, const std::vector<Pose>& known,
                               const support::Deadline& deadline) const {
  const double near = std::max(least_near, near_share * cells_->coarsest());
  Drawn drawn;
  for (std::size_t tried = 0; tried < count && deadline.used_fraction() < 0.5; ++tried) {
    if (tried >= least_trial && drawn.exact.size() * pays_from < tried) break;
    drawn.add(agreeing(cells_->draw_cell(rng), near, rng));
  }
  const std::size_t least = count / least_share;
  const bool is_hard = drawn.exact.size() < least;
  const auto lacks = [&](std::size_t wanted) {
    return is_hard && drawn.size() < wanted && deadline.used_fraction() < 0.5;
  };
  for (std::size_t i = 0; i < known.size() && lacks(count - least); ++i)
    drawn.add(projected(task(), history_, geometry::pose_vector(known[i]), near));
  if (lacks(count))
    for (const Cell& part : cells_->draw_parts(task(), history_, count, part_radius, rng, deadline))
      if (lacks(count)) drawn.add(agreeing(part, near, rng));
  for (std::size_t tried = 0; tried < count && lacks(least) && drawn.size() > 0; ++tried)
    drawn.add(projected(task(), history_, beside(drawn.any(rng), rng), near));
  const std::size_t unproved = is_hard ? count / unproved_share : 0;
  std::vector<Pose> poses;
  for (const PoseVector& v : drawn.exact)
    if (poses.size() + unproved < count) poses.push_back(geometry::pose_from(v));
  for (const PoseVector& v : drawn.near)
    if (const Pose pose = geometry::pose_from(v); poses.size() + unproved < count && contains(pose))
      poses.push_back(pose);
  for (std::size_t i = 0; i < unproved || poses.size() < least; ++i)
    poses.push_back(geometry::pose_from(cells_->draw_in(cells_->draw_cell(rng), rng)));
  return poses;
}

}  // namespace tactus::belief
