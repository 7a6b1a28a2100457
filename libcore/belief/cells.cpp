// SPDX-License-Identifier: BSD-3-Clause
#include "belief/cells.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "support/parallel.hpp"

namespace tactus::belief {
namespace {

constexpr std::size_t first_round = 16;     // of cells that are looked into; each next round is twice as long
constexpr std::size_t lot = 200;            // of cells that stand for all
constexpr std::size_t parts_per_cell = 10;  // that are kept of cells looked into, for each there is room for else,
constexpr std::size_t parts_meanwhile = 2;  // and as long as not all were looked into
constexpr std::size_t stride = 61;          // between cells that are looked into one after another
constexpr std::size_t batch = 64;           // of halves that are tested one after another
constexpr std::size_t first_splits = 256;   // of cells; by what they take it is known how many more there is time for
constexpr double finest_part = 0.00002;     // m: a part of a cell that is looked into need not be finer

/// The indices below `count` in long steps.
std::vector<std::size_t> strided(std::size_t count) {
  std::vector<std::size_t> indices;
  for (std::size_t start = 0; start < stride; ++start)
    for (std::size_t i = start; i < count; i += stride) indices.push_back(i);
  return indices;
}

std::vector<Cell> chosen(const std::vector<Cell>& cells, const std::vector<char>& which) {
  std::vector<Cell> result;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (which[i]) result.push_back(cells[i]);
  return result;
}

/// How many cells to split next, by what it took to split some and what is left.
std::size_t more_splits(std::size_t splits, std::uint64_t took, std::uint64_t left) {
  constexpr double most_growth = 4.0;
  const double each = static_cast<double>(std::max<std::uint64_t>(1, took)) / static_cast<double>(splits);
  return static_cast<std::size_t>(
      std::max(1.0, std::min(most_growth * static_cast<double>(splits), static_cast<double>(left) / each)));
}

std::vector<std::size_t> latest_first(const std::vector<Trace>& history) {
  std::vector<std::size_t> order(history.size());
  std::iota(order.rbegin(), order.rend(), std::size_t{0});
  return order;
}

}  // namespace

CellShape CellBelief::shape(const scene::Prior& prior, const CellOptions& options) {
  return cell_shape(prior, options.position, options.angle, options.most_at_first);
}

CellBelief::CellBelief(const Task& task, const CellOptions& options)
    : options_(options), prior_(task.scene().prior), weighs_(!prior_.guesses.empty()) {
  grid_.emplace(shape(prior_, options), task.target_reach());
  frame_ = {grid_->half_width(), task.target_reach()};
  density_ = CellPrior(prior_, frame_);
  list_when_few();
  weigh();
}

/// A list takes over once its cells may be split.
void CellBelief::list_when_few() {
  if (!grid_ || grid_->size() > options_.most) return;
  cells_ = cells();
  grid_.reset();
}

CellBelief CellBelief::restored(const Task& task, const CellOptions& options, Bitset members) {
  CellBelief belief(task, options);
  belief.grid_->assign(std::move(members));
  belief.weigh();
  return belief;
}

CellBelief CellBelief::restored(const Task& task, const CellOptions& options, std::vector<Cell> cells) {
  CellBelief belief(task, options);
  belief.grid_.reset();
  belief.cells_ = std::move(cells);
  belief.weigh();
  return belief;
}

CellBelief CellBelief::weighed(const Task& task, const CellOptions& options, std::vector<Cell> cells) {
  CellBelief belief(task, options);
  for (int d = 0; d < 6; ++d) belief.frame_.half[d] = 0.5 * belief.prior_.width[d];
  belief.density_ = CellPrior(belief.prior_, belief.frame_);
  belief.grid_.reset();
  belief.cells_ = std::move(cells);
  belief.weighs_ = true;
  belief.weigh();
  return belief;
}

std::vector<Cell> CellBelief::cells() const {
  if (!grid_) return cells_;
  std::vector<Cell> all;
  all.reserve(size());
  for_each([&](const Cell& cell) { all.push_back(cell); });
  return all;
}

double CellBelief::coarsest() const { return grid_ ? radius(Cell{}) : coarsest(cells_); }

double CellBelief::coarsest(const std::vector<Cell>& cells) const {
  double most = 0.0;
  for (const Cell& cell : cells) most = std::max(most, radius(cell));
  return most;
}

double CellBelief::volume() const {
  if (grid_) return static_cast<double>(size()) * volume(Cell{});
  double total = 0.0;
  for (const Cell& cell : cells_) total += volume(cell);
  return total;
}

double CellBelief::weight(const Cell& cell) const {
  return std::exp2(-cell.bits) * volume(cell) * density_.density(cell);
}

double CellBelief::weight() const { return weighed_.empty() ? volume() : weighed_.back(); }

void CellBelief::weigh() {
  if (grid_ && !weighs_) return weighed_.clear();
  weighed_.assign(grid_ ? grid_->members().words().size() : cells_.size(), 0.0);
  for (std::size_t i = 0; i < cells_.size(); ++i) weighed_[i] = weight(cells_[i]);
  if (grid_)
    grid_->members().for_each([&](std::size_t member) {
      weighed_[member / 64] += weight({grid_->centre(member), {}});
    });
  std::partial_sum(weighed_.begin(), weighed_.end(), weighed_.begin());
}

bool CellBelief::update(const Task& task, const std::vector<const Trace*>& traces, const Excludes& excludes) {
  if (grid_) {
    CellGrid sifted = *grid_;
    const CellTables* tables = options_.tables.get();
    sifted.sift(task, traces, excludes, tables != nullptr && tables->shape() == sifted.shape() ? tables : nullptr,
                options_.threads);
    if (sifted.size() == 0) return false;
    grid_ = std::move(sifted);
    list_when_few();
    weigh();
    return true;
  }
  std::vector<char> is_possible(cells_.size());
  support::for_ranges(cells_.size(), options_.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Pose pose = geometry::pose_from(cells_[i].centre);
      const double r = radius(cells_[i]);
      is_possible[i] = !(excludes && excludes(pose, r)) &&
                       std::all_of(traces.begin(), traces.end(),
                                   [&](const Trace* t) { return belief::may_reproduce(task, *t, pose, r); });
    }
  });
  std::vector<Cell> kept = chosen(cells_, is_possible);
  if (kept.empty()) return false;
  cells_ = std::move(kept);
  weigh();
  return true;
}

/// Whether the cell may have given the whole history. The trace that it can't have given moves to the front of `order`,
/// to be the first that the next cell is asked for.
bool CellBelief::may_reproduce(const Task& task, const std::vector<Trace>& history, std::vector<std::size_t>& order,
                               const Cell& cell, Effort& effort) const {
  const Pose pose = geometry::pose_from(cell.centre);
  const double r = radius(cell);
  const auto impossible = std::find_if(order.begin(), order.end(), [&](std::size_t i) {
    return !history[i].doubted && !belief::may_reproduce(task, history[i], pose, r, &effort);
  });
  if (impossible == order.end()) return true;
  std::rotate(order.begin(), impossible, impossible + 1);
  return false;
}

bool CellBelief::any_coarser(const std::vector<Cell>& cells, double wanted) const {
  return std::any_of(cells.begin(), cells.end(), [&](const Cell& cell) { return radius(cell) > wanted; });
}

/// Finds the cell, or the word of the grid's members and then the cell.
Cell CellBelief::draw_weighed(support::Rng& rng) const {
  const double at = std::min(rng.uniform() * weight(), std::nextafter(weight(), 0.0));
  const auto found = std::upper_bound(weighed_.begin(), weighed_.end(), at);
  const auto i = static_cast<std::size_t>(found - weighed_.begin());
  if (!grid_) return cells_[i];
  const Bitset& members = grid_->members();
  double left = at - (i > 0 ? weighed_[i - 1] : 0.0);
  Cell drawn;
  for (std::size_t member = 64 * i; left >= 0.0 && member < std::min(members.size(), 64 * (i + 1)); ++member) {
    if (!members.test(member)) continue;
    drawn.centre = grid_->centre(member);
    left -= weight(drawn);
  }
  return drawn;
}

Cell CellBelief::draw_cell(support::Rng& rng) const { return weighed_.empty() ? any_cell(rng) : draw_weighed(rng); }

PoseVector CellBelief::draw_in(const Cell& cell, support::Rng& rng) const {
  const PoseVector half = half_width(cell);
  PoseVector v = cell.centre;
  for (int d = 0; d < 6; ++d) v[d] += half[d] * rng.uniform(-1.0, 1.0);
  return v;
}

/// With the coarsest ones split, up to `most` of them, and the halves that can't have given the history left out.
std::vector<Cell> CellBelief::halves_of_coarsest(const Task& task, const std::vector<Trace>& history,
                                                 const std::vector<Cell>& cells, std::size_t most, double finest,
                                                 Effort* effort, const support::Cancellation& cancellation) const {
  const double split_from = 0.8 * coarsest(cells);
  std::vector<Cell> candidates, kept;
  for (const Cell& cell : cells) {
    if (radius(cell) <= std::max(split_from, finest) || candidates.size() >= 2 * most)
      kept.push_back(cell);
    else
      for (const Cell& half : frame_.halves(cell)) candidates.push_back(half);
  }
  const std::size_t batches = (candidates.size() + batch - 1) / batch;
  std::vector<char> is_possible(candidates.size());
  std::vector<Effort> efforts(batches);
  support::for_ranges(batches, options_.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      cancellation.check();
      std::vector<std::size_t> order = latest_first(history);
      for (std::size_t i = b * batch; i < std::min(candidates.size(), (b + 1) * batch); ++i)
        is_possible[i] = may_reproduce(task, history, order, candidates[i], efforts[b]);
    }
  });
  if (effort)
    for (const Effort& of_batch : efforts) effort->looks += of_batch.looks;
  const std::vector<Cell> possible = chosen(candidates, is_possible);
  kept.insert(kept.end(), possible.begin(), possible.end());
  return kept;
}

/// `count` of them, each by its weight, at even steps from a first one by lot.
std::vector<Cell> CellBelief::thinned(const std::vector<Cell>& cells, std::size_t count, support::Rng& rng) const {
  double total = 0.0;
  for (const Cell& cell : cells) total += weight(cell);
  const double step = total / static_cast<double>(count);
  double next = step * rng.uniform();
  std::vector<Cell> kept;
  double passed = 0.0;
  for (const Cell& cell : cells)
    for (passed += weight(cell); next < passed; next += step) kept.push_back(cell);
  return kept;
}

std::vector<Cell> CellBelief::draw_parts(const Task& task, const std::vector<Trace>& history, std::size_t count,
                                         double wanted, support::Rng& rng, const support::Deadline& deadline) const {
  std::vector<Cell> parts = by_lot(count, rng);
  while (any_coarser(parts, wanted) && deadline.used_fraction() < latest_draw) {
    parts = halves_of_coarsest(task, history, parts, parts.size(), wanted, nullptr, deadline.cancellation());
    if (parts.size() > 2 * count) parts = thinned(parts, count, rng);
  }
  return parts.size() > count ? thinned(parts, count, rng) : parts;
}

/// Whatever their weight; all if there are no more.
std::vector<Cell> CellBelief::by_lot(std::size_t count, support::Rng& rng) const {
  if (size() <= count) return cells();
  std::vector<Cell> drawn;
  while (drawn.size() < count) drawn.push_back(any_cell(rng));
  return drawn;
}

/// Whatever its weight.
Cell CellBelief::any_cell(support::Rng& rng) const {
  const std::size_t i = rng.below(size());
  return grid_ ? Cell{grid_->centre(grid_->members().member(i)), {}} : cells_[i];
}

bool CellBelief::refine(const Task& task, const std::vector<Trace>& history,
                        const std::function<bool(const Cell&)>& fine) {
  if (grid_) return true;
  const std::size_t least_room = std::max<std::size_t>(1, options_.most / 16);
  std::vector<Cell> open = cells_, done;
  Effort effort;
  std::size_t splits = first_splits;
  bool is_possible = true;
  while (is_possible) {
    const auto first_done = std::stable_partition(open.begin(), open.end(), std::not_fn(fine));
    done.insert(done.end(), first_done, open.end());
    open.erase(first_done, open.end());
    const std::size_t count = open.size() + done.size();
    if (count + least_room > options_.most || effort.looks >= options_.most_looks ||
        !any_coarser(open, options_.finest_radius))
      break;
    const std::uint64_t before = effort.looks;
    splits = std::min(splits, options_.most - count);
    std::vector<Cell> halves = halves_of_coarsest(task, history, open, splits, options_.finest_radius, &effort);
    splits =
        more_splits(splits, effort.looks - before, options_.most_looks - std::min(options_.most_looks, effort.looks));
    is_possible = !halves.empty() || !done.empty();
    if (is_possible) open = std::move(halves);
  }
  cells_ = std::move(open);
  cells_.insert(cells_.end(), done.begin(), done.end());
  weigh();
  return is_possible;
}

/// What may have given the history of one cell, as far as it is known.
struct CellBelief::Inside {
  std::vector<Cell> parts;
  Effort effort;
  bool is_known = false;  ///< they are all fine enough
};

CellBelief::Inside CellBelief::inside(const Task& task, const std::vector<Trace>& history, const Cell& whole,
                                      const std::function<bool(const Cell&)>& fine, std::uint64_t most_looks) const {
  Inside found;
  std::vector<std::size_t> order = latest_first(history);
  std::vector<Cell> open{whole};
  while (!open.empty() && found.effort.looks < most_looks) {
    const Cell cell = open.back();
    open.pop_back();
    if (fine(cell)) {
      found.parts.push_back(cell);
      continue;
    }
    if (radius(cell) <= finest_part) return {{whole}, found.effort};
    for (const Cell& half : frame_.halves(cell))
      if (may_reproduce(task, history, order, half, found.effort)) open.push_back(half);
  }
  found.is_known = open.empty();
  found.parts.insert(found.parts.end(), open.begin(), open.end());
  return found;
}

/// In rounds of cells, from all over: what a round may take is a share of what is left, so that one hard cell does not
/// take it all.
Looked CellBelief::look_inside(const Task& task, const std::vector<Trace>& history,
                               const std::function<bool(const Cell&)>& fine, std::uint64_t most_looks) {
  if (size() > parts_per_cell * options_.most) return Looked::gave_up;
  const std::vector<Cell> wholes = cells();
  const std::vector<std::size_t> from_all_over = strided(wholes.size());
  std::vector<Inside> found;
  for (const Cell& whole : wholes) found.push_back({{whole}, {}});
  bool all_known = true;
  for (std::size_t first = 0, last = 0; first < wholes.size() && all_known; first = last) {
    last = std::min(wholes.size(), 2 * first + first_round);
    const std::uint64_t each = most_looks / first_round;
    support::for_ranges(last - first, options_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = first + begin; i < first + end; ++i)
        found[from_all_over[i]] = inside(task, history, wholes[from_all_over[i]], fine, each);
    });
    for (std::size_t i = first; i < last; ++i) {
      const Inside& cell = found[from_all_over[i]];
      all_known = all_known && cell.is_known && cell.effort.looks <= most_looks;
      most_looks -= std::min(most_looks, cell.effort.looks);
    }
  }
  if (std::all_of(found.begin(), found.end(), [](const Inside& cell) { return cell.parts.empty(); }))
    return Looked::none;
  if (!all_known && grid_) return Looked::gave_up;
  replace(wholes, found, (all_known ? parts_per_cell : parts_meanwhile) * options_.most);
  return all_known ? Looked::all : Looked::gave_up;
}

/// By their parts, those with the fewest first, as long as there is room.
void CellBelief::replace(const std::vector<Cell>& wholes, const std::vector<Inside>& found, std::size_t room) {
  std::vector<std::size_t> fewest_first;
  for (std::size_t i = 0; i < wholes.size(); ++i)
    if (!found[i].parts.empty()) fewest_first.push_back(i);
  std::stable_sort(fewest_first.begin(), fewest_first.end(),
                   [&](std::size_t a, std::size_t b) { return found[a].parts.size() < found[b].parts.size(); });
  std::vector<Cell> kept;
  std::size_t whole = fewest_first.size();
  for (const std::size_t i : fewest_first) {
    --whole;
    if (kept.size() + found[i].parts.size() + whole <= room)
      kept.insert(kept.end(), found[i].parts.begin(), found[i].parts.end());
    else
      kept.push_back(wholes[i]);
  }
  cells_ = std::move(kept);
  grid_.reset();
  weigh();
}

double CellBelief::estimated_looks(const Task& task, const std::vector<Trace>& history, double wanted, double most,
                                   support::Rng& rng) const {
  std::vector<Cell> parts = by_lot(lot, rng);
  double all = static_cast<double>(size()), looks = 0.0;
  while (looks <= most && any_coarser(parts, wanted)) {
    const auto before = static_cast<double>(parts.size());
    Effort effort;
    parts = halves_of_coarsest(task, history, parts, parts.size(), wanted, &effort);
    looks += static_cast<double>(effort.looks) * all / before;
    all *= static_cast<double>(parts.size()) / before;
    if (parts.size() > 2 * lot) parts = thinned(parts, lot, rng);
  }
  return looks;
}

}  // namespace tactus::belief
