// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numbers>

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

/// Circular mean of the angles, arithmetic mean of the positions.
Vector6 mean_of(const CellBelief& cells, double total) {
  Vector6 sum = Vector6::Zero(), sine = Vector6::Zero(), cosine = Vector6::Zero();
  cells.for_each([&](const Cell& cell) {
    const double share = cells.weight(cell) / total;
    for (int d = 0; d < 6; ++d) {
      sum[d] += share * cell.centre[d];
      sine[d] += share * std::sin(cell.centre[d]);
      cosine[d] += share * std::cos(cell.centre[d]);
    }
  });
  for (int d = 3; d < 6; ++d) sum[d] = scene::nearest_angle(std::atan2(sine[d], cosine[d]), sum[d]);
  return sum;
}

/// `bits` is the entropy in units of the task tolerance: within a cell the target is uniform.
void describe_cells(const CellBelief& cells, const Task& task, Summary& summary) {
  const double total = cells.weight();
  const Vector6 mean = mean_of(cells, total);
  Vector6 low = Vector6::Constant(1e300), high = -low;
  Matrix6 covariance = Matrix6::Zero();
  double bits = std::log2(total / tolerance_volume(task));
  cells.for_each([&](const Cell& cell) {
    Vector6 off, half;
    for (int d = 0; d < 6; ++d) {
      off[d] = (d < 3 ? cell.centre[d] : scene::nearest_angle(cell.centre[d], mean[d])) - mean[d];
      half[d] = cells.half_width(cell)[d];
    }
    const double weight = cells.weight(cell), share = weight / total;
    if (weight <= 0.0) return;
    if (cell.bits <= negligible_bits) {
      low = low.cwiseMin(off - half);
      high = high.cwiseMax(off + half);
    }
    covariance += share * (off * off.transpose() + Matrix6(half.cwiseAbs2().asDiagonal()) / 3.0);
    bits -= share * std::log2(weight / cells.volume(cell));
  });
  summary.cells = cells.size();
  summary.bits = std::max(0.0, bits);
  for (int d = 0; d < 6; ++d) summary.mean[d] = mean[d], summary.extent[d] = high[d] - low[d];
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
