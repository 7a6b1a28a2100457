// SPDX-License-Identifier: BSD-3-Clause
#include "belief/cells.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::belief {
CellBelief::CellBelief(const Task& task, const CellOptions& options) : options_(options) {
  for (const Vector3& v : task.scene().target.mesh.vertices) reach_ = std::max(reach_, v.norm());
  const scene::Prior& prior = task.scene().prior;
  for (int d = 0; d < 6; ++d) {
    const double wanted = d < 3 ? options.position : options.angle;
    const double count = std::max(1.0, std::ceil(prior.width[d] / wanted - 1e-9));
    initial_half_[d] = 0.5 * prior.width[d] / count;
  }
}

CellBelief::CellBelief(const Task& task, const CellOptions& options,
                       const std::function<bool(const Pose&, double)>& keep)
    : CellBelief(task, options) {
  const scene::Prior& prior = task.scene().prior;
  std::array<int, 6> count{};
  std::size_t total = 1;
  for (int d = 0; d < 6; ++d) {
    count[d] = initial_half_[d] > 0.0 ? static_cast<int>(std::lround(0.5 * prior.width[d] / initial_half_[d])) : 1;
    total *= static_cast<std::size_t>(count[d]);
  }
  for (std::size_t i = 0; i < total; ++i) {
    Cell cell;
    std::size_t rest = i;
    for (int d = 0; d < 6; ++d) {
      const auto k = static_cast<double>(rest % static_cast<std::size_t>(count[d]));
      rest /= static_cast<std::size_t>(count[d]);
      cell.centre[d] = prior.centre[d] - 0.5 * prior.width[d] + initial_half_[d] * (2.0 * k + 1.0);
    }
    if (keep(geometry::pose_from(cell.centre), radius(cell))) cells_.push_back(cell);
  }
}

CellBelief CellBelief::restored(const Task& task, const CellOptions& options, std::vector<Cell> cells) {
  CellBelief belief(task, options);
  belief.cells_ = std::move(cells);
  return belief;
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

bool CellBelief::update(const Task& task, const Trace& trace) {
  std::vector<Cell> kept;
  for (const Cell& cell : cells_)
    if (may_reproduce(task, trace, geometry::pose_from(cell.centre), radius(cell))) kept.push_back(cell);
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

bool CellBelief::possible(const Task& task, const std::vector<Trace>& history, const Cell& cell) const {
  const Pose pose = geometry::pose_from(cell.centre);
  const double r = radius(cell);
  return std::all_of(history.rbegin(), history.rend(),
                     [&](const Trace& trace) { return may_reproduce(task, trace, pose, r); });
}

std::size_t CellBelief::draw_cell(support::Rng& rng) const {
  double total = 0.0;
  for (const Cell& cell : cells_) total += volume(cell);
  double left = rng.uniform() * total;
  for (std::size_t i = 0; i < cells_.size(); ++i)
    if ((left -= volume(cells_[i])) <= 0.0) return i;
  return cells_.size() - 1;
}

std::optional<Projection> CellBelief::draw(const Task& task, const std::vector<Trace>& history,
                                           support::Rng& rng) const {
  const Cell& cell = cells_[draw_cell(rng)];
  const PoseVector half = half_width(cell);
  PoseVector seed = cell.centre;
  for (int d = 0; d < 6; ++d) seed[d] += half[d] * rng.uniform(-1.0, 1.0);
  return projected(task, history, seed);
}

bool CellBelief::refine(const Task& task, const std::vector<Trace>& history,
                        const std::function<bool(const CellBelief&)>& enough) {
  while (2 * cells_.size() <= options_.most && !(enough && enough(*this))) {
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
      if (possible(task, history, cell)) kept.push_back(cell);
    if (kept.empty()) return false;
    cells_ = std::move(kept);
  }
  return true;
}

}  // namespace tactus::belief
