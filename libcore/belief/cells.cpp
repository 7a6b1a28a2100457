// SPDX-License-Identifier: BSD-3-Clause
#include "belief/cells.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::belief {
CellBelief::CellBelief(const Task& task, const CellOptions& options) : options_(options) {
  for (const Vector3& v : task.scene().target.mesh.vertices) reach_ = std::max(reach_, v.norm());
  grid_.emplace(task.scene().prior, options.position, options.angle, options.most_at_first, reach_);
  initial_half_ = grid_->half_width();
  list_when_few();
}

/// A list takes over once its cells may be split.
void CellBelief::list_when_few() {
  if (!grid_ || 2 * grid_->size() > options_.most) return;
  cells_ = cells();
  grid_.reset();
}

CellBelief CellBelief::restored(const Task& task, const CellOptions& options, Bitset members) {
  CellBelief belief(task, options);
  belief.grid_->assign(std::move(members));
  return belief;
}

CellBelief CellBelief::restored(const Task& task, const CellOptions& options, std::vector<Cell> cells) {
  CellBelief belief(task, options);
  belief.grid_.reset();
  belief.cells_ = std::move(cells);
  return belief;
}

std::vector<Cell> CellBelief::cells() const {
  if (!grid_) return cells_;
  std::vector<Cell> all;
  all.reserve(size());
  for_each([&](const Cell& cell) { all.push_back(cell); });
  return all;
}

PoseVector CellBelief::half_width(const Cell& cell) const {
  PoseVector half = initial_half_;
  for (int d = 0; d < 6; ++d) half[d] = std::ldexp(half[d], -cell.splits[d]);
  return half;
}

double CellBelief::radius(const Cell& cell) const { return scene::cell_radius(half_width(cell), reach_); }

double CellBelief::volume(const Cell& cell) const {
  double product = 1.0;
  for (const double half : half_width(cell)) product *= half > 0.0 ? 2.0 * half : 1.0;
  return product;
}

double CellBelief::volume() const {
  if (grid_) return static_cast<double>(size()) * volume(Cell{});
  double total = 0.0;
  for (const Cell& cell : cells_) total += volume(cell);
  return total;
}

bool CellBelief::update(const Task& task, const std::vector<const Trace*>& traces, const Excludes& excludes) {
  if (grid_) {
    CellGrid sifted = *grid_;
    sifted.sift(task, traces, excludes);
    if (sifted.size() == 0) return false;
    grid_ = std::move(sifted);
    list_when_few();
    return true;
  }
  std::vector<Cell> kept;
  for (const Cell& cell : cells_) {
    const Pose pose = geometry::pose_from(cell.centre);
    const double r = radius(cell);
    if (excludes && excludes(pose, r)) continue;
    if (std::all_of(traces.begin(), traces.end(),
                    [&](const Trace* trace) { return may_reproduce(task, *trace, pose, r); }))
      kept.push_back(cell);
  }
  if (kept.empty()) return false;
  cells_ = std::move(kept);
  return true;
}

/// Halves the dimension along which the target's points move most.
void CellBelief::split(const Cell& cell, std::vector<Cell>& halves) const {
  const PoseVector half = half_width(cell);
  int widest = 0;
  double most = -1.0;
  for (int d = 0; d < 6; ++d) {
    const double moves = d < 3 ? half[d] : half[d] * reach_;
    if (moves > most) most = moves, widest = d;
  }
  for (const double sign : {-0.5, 0.5}) {
    Cell part = cell;
    part.centre[widest] += sign * half[widest];
    ++part.splits[widest];
    halves.push_back(part);
  }
}

Cell CellBelief::draw_cell(support::Rng& rng) const {
  if (grid_) return {grid_->centre(grid_->members().member(rng.below(grid_->size()))), {}};
  double left = rng.uniform() * volume();
  for (const Cell& cell : cells_)
    if ((left -= volume(cell)) <= 0.0) return cell;
  return cells_.back();
}

std::optional<Projection> CellBelief::draw(const Task& task, const std::vector<Trace>& history,
                                           support::Rng& rng) const {
  const Cell cell = draw_cell(rng);
  const PoseVector half = half_width(cell);
  PoseVector seed = cell.centre;
  for (int d = 0; d < 6; ++d) seed[d] += half[d] * rng.uniform(-1.0, 1.0);
  return projected(task, history, seed);
}

bool CellBelief::refine(const Task& task, const std::vector<Trace>& history,
                        const std::function<bool(const CellBelief&)>& enough) {
  while (!grid_ && 2 * cells_.size() <= options_.most && !(enough && enough(*this))) {
    double coarsest = 0.0;
    for (const Cell& cell : cells_) coarsest = std::max(coarsest, radius(cell));
    if (coarsest <= options_.finest_radius) break;
    std::vector<Cell> candidates, kept;
    for (const Cell& cell : cells_) {
      if (radius(cell) > 0.8 * coarsest && may_split(cell))
        split(cell, candidates);
      else
        kept.push_back(cell);
    }
    for (const Cell& cell : candidates)
      if (may_reproduce(task, history, geometry::pose_from(cell.centre), radius(cell))) kept.push_back(cell);
    if (kept.empty()) return false;
    cells_ = std::move(kept);
  }
  return true;
}

}  // namespace tactus::belief
