// SPDX-License-Identifier: BSD-3-Clause
#include "belief/weighed_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "support/parallel.hpp"

namespace tactus::belief {
namespace {

constexpr std::size_t fewer = 5;           // cells carry the weight than are split where none has any
constexpr std::size_t halved_at_once = 3;  // times as many, at most
constexpr double heavy = 2.0;           // times the weight that each would have if all had the same: a cell is halved
constexpr double lightest = 0.02;       // of that: none lighter is
constexpr double light = 0.01;          // of that, two cells together: they are joined, and heavier ones if there is
                                        // no room
constexpr double lost = 1e-4;           // of that, or of a part that is halved: nothing more is asked of a cell
constexpr double rounding = 1e-9;       // m and rad
constexpr double least_window = 0.001;  // m: stops that are nearer to each other are one

/// Where else on its way a robot might have stopped, as far as the stops can be told apart.
double stops(const action::Sensing& sensing, const Trace& trace) {
  double length = 0.0;
  for (std::size_t i = 1; i < trace.path.size(); ++i)
    length +=
        (trace.bodies.base_from_body(i, 0).translation() - trace.bodies.base_from_body(i - 1, 0).translation()).norm();
  return std::max(2.0, length / (least_window + sensing.stopping_distance));
}

/// Draws `count` of `from` by their weights, at even steps from a first one by lot.
std::vector<WeighedCells::Weighed> drawn(const std::vector<WeighedCells::Weighed>& from,
                                         const std::vector<double>& weights, std::size_t count, support::Rng& rng) {
  double total = 0.0;
  for (const double weight : weights) total += weight;
  const double step = total / static_cast<double>(count);
  double next = step * rng.uniform(), passed = 0.0;
  std::vector<WeighedCells::Weighed> result;
  for (std::size_t i = 0; i < from.size(); ++i)
    for (passed += weights[i]; next < passed && result.size() < count; next += step) result.push_back(from[i]);
  return result;
}

bool is_open(const Doubt& doubt) { return !doubt.is_certain; }

std::vector<std::size_t> wrong(const std::vector<Doubt>& doubts) {
  std::vector<std::size_t> traces;
  for (const Doubt& doubt : doubts)
    if (doubt.is_certain && (traces.empty() || traces.back() != doubt.trace)) traces.push_back(doubt.trace);
  return traces;
}

}  // namespace

FaultBits::FaultBits(const action::Sensing& sensing)
    : missed(-std::log2(sensing.missed_contacts)), imagined(-std::log2(sensing.false_contacts)) {}

WeighedCells::WeighedCells(const Task& task, const action::Sensing& sensing, const CellOptions& options)
    : prior_(task.scene().prior),
      sensing_(sensing),
      bits_(sensing),
      options_(options),
      wanted_(options.most / fewer),
      cells_{{{prior_.centre}}} {
  for (int d = 0; d < 6; ++d) frame_.half[d] = 0.5 * prior_.width[d];
  frame_.reach = task.target_reach();
  density_ = CellPrior(prior_, frame_);
  for (Cell cell; halved_.size() < most_splits; ++cell.splits[halved_.back()]) halved_.push_back(frame_.widest(cell));
}

double WeighedCells::bits_of(const std::vector<Trace>& history, const Weighed& weighed) const {
  double before = 0.0, after = 0.0;
  for (const Doubt& doubt : weighed.doubts) {
    if (!doubt.is_certain || doubt.fault == Fault::inside) continue;
    (doubt.trace < weighed.floor_of ? before : after) +=
        doubt.fault == Fault::missed ? bits_.missed : bits_.imagined + std::log2(stops(sensing_, history[doubt.trace]));
  }
  return std::max(before, weighed.floor) + after;
}

/// Adds the doubts that one trace raises, in the order of the faults.
void WeighedCells::ask(const Task& task, const std::vector<Trace>& history, std::size_t trace, Weighed& weighed) const {
  const Trace& seen = history[trace];
  const Pose pose = geometry::pose_from(weighed.cell.centre);
  const double radius = frame_.radius(weighed.cell);
  const auto add = [&](Fault fault, bool is_certain) {
    weighed.doubts.push_back({static_cast<std::uint16_t>(trace), fault, is_certain});
  };
  Fit free = fit_free(task, seen, pose, radius, 0);
  SetOut out;
  if (free != Fit::all && trace > 0) out = set_out(task, seen, pose, radius);
  if (out.clear > 0) {
    const bool is_known = out.inside == out.clear;
    free = fit_free(task, seen, pose, radius, out.clear);
    if (free == Fit::all && !is_known) free = Fit::some;
  }
  if (free != Fit::all) add(Fault::missed, free == Fit::none);
  Fit touch = Fit::all;
  if (seen.contact) touch = out.inside >= seen.touch ? Fit::none : fit_touch(task, seen, pose, radius);
  if (touch != Fit::all) add(Fault::imagined, touch == Fit::none);
  if (out.inside > 0) add(Fault::inside, true);
}

/// What is certain of a whole is so of its halves; the rest is asked again, as long as they weigh enough to matter.
std::array<WeighedCells::Weighed, 2> WeighedCells::halves(const Task& task, const std::vector<Trace>& history,
                                                          const Weighed& whole, double enough) const {
  const std::array<Cell, 2> cells = frame_.halves(whole.cell);
  std::array<Weighed, 2> parts{Weighed{cells[0], {}, whole.floor, whole.floor_of},
                               Weighed{cells[1], {}, whole.floor, whole.floor_of}};
  for (Weighed& part : parts) {
    for (auto first = whole.doubts.begin(), last = first; first != whole.doubts.end(); first = last) {
      last = std::find_if(first, whole.doubts.end(), [&](const Doubt& doubt) { return doubt.trace != first->trace; });
      if (weight(part.cell) < enough || std::none_of(first, last, is_open))
        part.doubts.insert(part.doubts.end(), first, last);
      else
        ask(task, history, first->trace, part);
      part.cell.bits = bits_of(history, part);
    }
  }
  return parts;
}

/// The cell that two are the halves of; none if they aren't.
std::optional<Cell> WeighedCells::whole_of(const Cell& low, const Cell& high) const {
  const std::size_t splits = low.all_splits();
  if (splits == 0 || low.splits != high.splits) return std::nullopt;
  const int d = halved_[splits - 1];
  const double width = 2.0 * frame_.half_width(low)[d];
  const double before = (low.centre[d] - prior_.centre[d] + frame_.half[d]) / width;
  if (static_cast<std::int64_t>(before) % 2 != 0) return std::nullopt;
  for (int other = 0; other < 6; ++other)
    if (std::abs(high.centre[other] - low.centre[other] - (other == d ? width : 0.0)) > rounding) return std::nullopt;
  Cell whole = low;
  whole.centre[d] = 0.5 * (low.centre[d] + high.centre[d]);
  --whole.splits[d];
  return whole;
}

/// The cell that two are the halves of. What is certain of both is so of it, and the rest open.
std::optional<WeighedCells::Weighed> WeighedCells::joined(const std::vector<Trace>& history, const Weighed& low,
                                                          const Weighed& high) const {
  const std::optional<Cell> cell = whole_of(low.cell, high.cell);
  if (!cell) return std::nullopt;
  Weighed whole{*cell, {}, std::min(low.cell.bits, high.cell.bits), static_cast<std::uint16_t>(seen_)};
  const auto before = [](const Doubt& a, const Doubt& b) {
    return a.trace != b.trace ? a.trace < b.trace : a.fault < b.fault;
  };
  std::vector<Doubt> both;
  std::merge(low.doubts.begin(), low.doubts.end(), high.doubts.begin(), high.doubts.end(), std::back_inserter(both),
             before);
  for (auto doubt = both.begin(); doubt != both.end(); ++doubt) {
    const auto next = doubt + 1;
    const bool in_both = next != both.end() && next->trace == doubt->trace && next->fault == doubt->fault;
    whole.doubts.push_back({doubt->trace, doubt->fault, in_both && doubt->is_certain && next->is_certain});
    if (in_both) ++doubt;
  }
  whole.cell.bits = bits_of(history, whole);
  return whole;
}

/// As a share of what it would be without doubts beyond those of the likeliest cell.
double WeighedCells::weight(const Cell& cell) const {
  return std::exp2(least_ - cell.bits) * frame_.volume(cell) * density_.density(cell);
}

double WeighedCells::likeliest() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Weighed& weighed : cells_) least = std::min(least, weighed.cell.bits);
  return least;
}

double WeighedCells::total() const {
  double sum = 0.0;
  for (const Weighed& weighed : cells_) sum += weight(weighed.cell);
  return sum;
}

/// Those that weigh no more than this together, and again what comes of them.
void WeighedCells::join_lighter(const std::vector<Trace>& history, double most) {
  std::vector<Weighed> kept;
  for (Weighed& weighed : cells_) {
    kept.push_back(std::move(weighed));
    while (kept.size() > 1) {
      auto whole = joined(history, kept[kept.size() - 2], kept.back());
      if (!whole || weight(whole->cell) > most) break;
      kept.pop_back();
      kept.back() = std::move(*whole);
    }
  }
  cells_ = std::move(kept);
  least_ = likeliest();
}

void WeighedCells::make_room(const std::vector<Trace>& history) {
  double share = light;
  do join_lighter(history, share * total() / static_cast<double>(wanted_));
  while (cells_.size() > wanted_ && (share *= 2.0) < heavy);
}

/// More than can be told of the cell can be told of its halves: what they explain, or where they are.
bool WeighedCells::may_halve(const Weighed& weighed) const {
  const double radius = frame_.radius(weighed.cell);
  return radius > part_radius ||
         (radius > options_.finest_radius && std::any_of(weighed.doubts.begin(), weighed.doubts.end(), is_open));
}

/// Those that weigh more than this, up to so many; returns how many.
std::size_t WeighedCells::halve_heavier(const Task& task, const std::vector<Trace>& history, double most_weight,
                                        std::size_t most) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < cells_.size() && chosen.size() < most; ++i)
    if (weight(cells_[i].cell) > most_weight && may_halve(cells_[i])) chosen.push_back(i);
  const double enough = lost * total() / static_cast<double>(wanted_);
  std::vector<std::array<Weighed, 2>> parts(chosen.size());
  support::for_ranges(chosen.size(), options_.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) parts[i] = halves(task, history, cells_[chosen[i]], enough);
  });
  std::vector<Weighed> next;
  next.reserve(cells_.size() + chosen.size());
  auto half = parts.begin();
  auto at = chosen.begin();
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (at == chosen.end() || *at != i) {
      next.push_back(std::move(cells_[i]));
      continue;
    }
    for (Weighed& part : *half) next.push_back(std::move(part));
    ++half, ++at;
  }
  cells_ = std::move(next);
  least_ = likeliest();
  return chosen.size();
}

/// Halves what is heavy, and then what is less so, as long as there are few cells.
void WeighedCells::refine(const Task& task, const std::vector<Trace>& history) {
  std::size_t left = halved_at_once * wanted_;
  for (double share = heavy; share >= lightest && cells_.size() < wanted_; share *= 0.5)
    while (std::isfinite(least_)) {
      const double most = share * total() / static_cast<double>(wanted_);
      const std::size_t halved = halve_heavier(task, history, most, left);
      if (halved == 0) break;
      left -= halved;
    }
}

bool WeighedCells::update(const Task& task, const std::vector<Trace>& history) {
  support::for_ranges(cells_.size(), options_.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t trace = seen_; trace < history.size(); ++trace) ask(task, history, trace, cells_[i]);
      cells_[i].cell.bits = bits_of(history, cells_[i]);
    }
  });
  seen_ = history.size();
  least_ = likeliest();
  if (!std::isfinite(least_)) return false;
  make_room(history);
  refine(task, history);
  return std::isfinite(least_);
}

std::vector<Cell> WeighedCells::cells() const {
  std::vector<Cell> cells;
  cells.reserve(cells_.size());
  for (const Weighed& weighed : cells_) {
    cells.push_back(weighed.cell);
    cells.back().bits -= least_;
  }
  return cells;
}

std::vector<std::size_t> WeighedCells::doubted() const {
  std::map<std::vector<std::size_t>, double> explanations;
  for (const Weighed& weighed : cells_) explanations[wrong(weighed.doubts)] += weight(weighed.cell);
  const auto heaviest = std::max_element(explanations.begin(), explanations.end(),
                                         [](const auto& a, const auto& b) { return a.second < b.second; });
  return heaviest->first;
}

std::vector<WeighedCells::Weighed> WeighedCells::draw_parts(const Task& task, const std::vector<Trace>& history,
                                                            std::size_t count, double radius, support::Rng& rng,
                                                            const support::Deadline& deadline) const {
  std::vector<double> weights;
  for (const Weighed& weighed : cells_) weights.push_back(weight(weighed.cell));
  std::vector<Weighed> parts = drawn(cells_, weights, count, rng);
  weights.assign(parts.size(), 1.0);
  const auto coarsest = [&] {
    double most = 0.0;
    for (const Weighed& part : parts) most = std::max(most, frame_.radius(part.cell));
    return most;
  };
  for (double most = coarsest(); most > radius && deadline.used_fraction() < latest_draw; most = coarsest()) {
    std::vector<std::array<Weighed, 2>> pairs(parts.size());
    support::for_ranges(parts.size(), options_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        if (frame_.radius(parts[i].cell) > std::max(radius, 0.8 * most))
          pairs[i] = halves(task, history, parts[i], lost * weight(parts[i].cell));
    });
    std::vector<Weighed> next;
    std::vector<double> next_weights;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (frame_.radius(parts[i].cell) <= std::max(radius, 0.8 * most)) {
        next.push_back(std::move(parts[i]));
        next_weights.push_back(weights[i]);
        continue;
      }
      const double before = weight(parts[i].cell);
      for (Weighed& half : pairs[i]) {
        next_weights.push_back(weights[i] * weight(half.cell) / before);
        next.push_back(std::move(half));
      }
    }
    parts = drawn(next, next_weights, count, rng);
    weights.assign(parts.size(), 1.0);
  }
  return parts;
}

std::vector<const Trace*> WeighedCells::explained(const std::vector<Trace>& history, const std::vector<Doubt>& doubts) {
  std::vector<const Trace*> traces;
  const std::vector<std::size_t> left_out = wrong(doubts);
  for (std::size_t i = 0; i < history.size(); ++i)
    if (std::find(left_out.begin(), left_out.end(), i) == left_out.end()) traces.push_back(&history[i]);
  return traces;
}

bool WeighedCells::restore(std::vector<Weighed> cells, const std::vector<Trace>& history) {
  cells_ = std::move(cells);
  for (Weighed& weighed : cells_) weighed.cell.bits = bits_of(history, weighed);
  seen_ = history.size();
  least_ = likeliest();
  return std::isfinite(least_);
}

}  // namespace tactus::belief
