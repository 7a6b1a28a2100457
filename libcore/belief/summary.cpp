// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>

#include "belief/belief.hpp"

namespace tactus::belief {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// The volume of one task tolerance in the free dimensions: what need not be told apart.
double tolerance_volume(const Task& task) {
  double product = 1.0;
  for (int d = 0; d < 6; ++d)
    if (task.scene().prior.width[d] > 0.0)
      product *= 2.0 * (d < 3 ? task.scene().target.position_tolerance : task.scene().target.angle_tolerance);
  return product;
}

/// Sines and cosines of six numbers, worked out again only where they change: cells of a grid come row by row.
class Turns {
 public:
  void at(const PoseVector& v) {
    for (int d = 0; d < 6; ++d)
      if (v[d] != last_[d]) last_[d] = v[d], sine_[d] = std::sin(v[d]), cosine_[d] = std::cos(v[d]);
  }
  const Vector6& sine() const { return sine_; }
  const Vector6& cosine() const { return cosine_; }

 private:
  Vector6 last_ = Vector6::Zero(), sine_ = Vector6::Zero(), cosine_ = Vector6::Ones();
};

/// Circular mean of the angles, arithmetic mean of the positions.
Vector6 mean_of(const CellBelief& cells, double total) {
  Vector6 sum = Vector6::Zero(), sine = Vector6::Zero(), cosine = Vector6::Zero();
  Turns turns;
  cells.for_each_weighed([&](const Cell& cell, const PoseVector&, double weight) {
    const double share = weight / total;
    turns.at(cell.centre);
    sum += share * Eigen::Map<const Vector6>(cell.centre.data());
    sine += share * turns.sine();
    cosine += share * turns.cosine();
  });
  for (int d = 3; d < 6; ++d) sum[d] = scene::nearest_angle(std::atan2(sine[d], cosine[d]), sum[d]);
  return sum;
}

/// Of a cell's centre, the shorter way round.
Vector6 offset(const Cell& cell, const Vector6& from) {
  Vector6 off = Eigen::Map<const Vector6>(cell.centre.data()) - from;
  for (int d = 3; d < 6; ++d) off[d] = scene::nearest_angle(cell.centre[d], from[d]) - from[d];
  return off;
}

/// Where the cells lie about their mean, but for the negligible ones.
struct Span {
  Vector6 mean = Vector6::Zero(), low = Vector6::Constant(1e300), high = -low;
  Vector6 middle() const { return mean + 0.5 * (low + high); }
};

Span span_of(const CellBelief& cells, double total) {
  Span span{mean_of(cells, total)};
  cells.for_each_weighed([&](const Cell& cell, const PoseVector& half_width, double weight) {
    if (weight <= 0.0 || cell.bits > negligible_bits) return;
    const Eigen::Map<const Vector6> half(half_width.data());
    const Vector6 off = offset(cell, span.mean);
    span.low = span.low.cwiseMin(off - half);
    span.high = span.high.cwiseMax(off + half);
  });
  return span;
}

/// Cells put together that no task tolerance tells apart.
class Boxes {
  static constexpr double beside_edge = 1e-6;  ///< of a box: a cell on an edge is on one side, whatever the rounding

 public:
  Boxes(const Task& task, const Vector6& middle) : middle_(middle) {
    for (int d = 0; d < 6; ++d)
      wide_[d] = 2.0 * (d < 3 ? task.scene().target.position_tolerance : task.scene().target.angle_tolerance);
  }

  void add(const Cell& cell, const PoseVector& half_width, double share) {
    const Vector6 off = offset(cell, middle_);
    std::uint64_t key = 0;
    double tolerances = 1.0;
    for (int d = 0; d < 6; ++d) {
      const double width = 2.0 * half_width[d];
      if (width <= 0.0) continue;
      if (width > wide_[d]) {
        tolerances *= width / wide_[d];
        key = support::mix(key ^ std::bit_cast<std::uint64_t>(cell.centre[d])) ^ cell.splits[d];
      } else {
        const double box = std::floor(off[d] / wide_[d] + 0.5 + beside_edge);
        key = support::mix(key ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(box)));
      }
    }
    const auto [found, is_new] = index_.try_emplace(key, shares_.size());
    if (is_new) shares_.emplace_back(0.0, tolerances);
    shares_[found->second].first += share;
  }

  double entropy() const {
    double bits = 0.0;
    for (const auto& [share, tolerances] : shares_)
      if (share > 0.0) bits += share * std::log2(tolerances / share);
    return std::max(0.0, bits);
  }

 private:
  Vector6 middle_, wide_;
  std::unordered_map<std::uint64_t, std::size_t> index_;
  std::vector<std::pair<double, double>> shares_;  ///< of the weight, and of how many tolerances
};

bool are_by_volume(const CellBelief& cells) { return cells.grid() && cells.is_uniform(); }

/// The entropy of the pose in steps of the task tolerance: within a cell the target is uniform. Of a grid without
/// weights by its volume, as if no cell were smaller than that.
double bits_of(const CellBelief& cells, const Task& task, double total, const Vector6& middle) {
  if (are_by_volume(cells)) return std::max(0.0, std::log2(total / tolerance_volume(task)));
  Boxes boxes(task, middle);
  cells.for_each_weighed([&](const Cell& cell, const PoseVector& half_width, double weight) {
    if (weight > 0.0) boxes.add(cell, half_width, weight / total);
  });
  return boxes.entropy();
}

void describe_cells(const CellBelief& cells, const Task& task, Summary& summary) {
  const double total = cells.weight();
  const Span span = span_of(cells, total);
  Matrix6 covariance = Matrix6::Zero();
  cells.for_each_weighed([&](const Cell& cell, const PoseVector& half_width, double weight) {
    const Eigen::Map<const Vector6> half(half_width.data());
    const Vector6 off = offset(cell, span.mean);
    covariance += weight / total * (off * off.transpose() + Matrix6(half.cwiseAbs2().asDiagonal()) / 3.0);
  });
  summary.cells = cells.size();
  summary.bits = bits_of(cells, task, total, span.middle());
  for (int d = 0; d < 6; ++d) summary.mean[d] = span.mean[d], summary.extent[d] = span.high[d] - span.low[d];
  std::copy(covariance.data(), covariance.data() + 36, summary.covariance.begin());
}

/// Phase 1 knows a volume only: the middle and the extents of PO stand for the position, the prior for the turns; the
/// target's pose is taken to be uniform over them.
void describe_voxels(const VoxelBelief& voxels, const Task& task, Summary& summary) {
  const VoxelGrid& grid = voxels.model().grid;
  geometry::Box box;
  voxels.possibly_occupied().for_each([&](std::size_t v) { box.add(grid.centre(v)); });
  const scene::Prior& prior = task.scene().prior;
  summary.possibly_occupied = voxels.possibly_occupied().count();
  summary.volume = static_cast<double>(summary.possibly_occupied) * std::pow(grid.pitch(), 3);
  summary.mean = prior.centre;
  summary.extent = prior.width;
  double poses =
      static_cast<double>(summary.possibly_occupied) / static_cast<double>(grid.size()) / tolerance_volume(task);
  for (int d = 0; d < 6; ++d) {
    if (prior.width[d] > 0.0) poses *= prior.width[d];
    if (d < 3 && prior.width[d] > 0.0 && !box.empty()) {
      summary.extent[d] = std::min(prior.width[d], box.size()[d]);
      summary.mean[d] =
          std::clamp(box.centre()[d], prior.centre[d] - 0.5 * prior.width[d], prior.centre[d] + 0.5 * prior.width[d]);
    }
    summary.covariance[d * 7] = summary.extent[d] * summary.extent[d] / 12.0;
  }
  summary.bits = std::log2(std::max(1.0, poses));
}

}  // namespace

double Belief::bits() const {
  if (!cells_) return summary().bits;
  const double total = cells_->weight();
  const Vector6 middle = are_by_volume(*cells_) ? Vector6::Zero() : span_of(*cells_, total).middle();
  return bits_of(*cells_, task(), total, middle);
}

Summary Belief::summary() const {
  Summary summary;
  summary.phase = phase();
  summary.health = health_;
  summary.observations = history_.size();
  for (const Trace& trace : history_) {
    summary.contacts += trace.contact;
    summary.doubted += trace.doubted;
  }
  if (cells_)
    describe_cells(*cells_, task(), summary);
  else
    describe_voxels(*voxels_, task(), summary);
  return summary;
}

}  // namespace tactus::belief
