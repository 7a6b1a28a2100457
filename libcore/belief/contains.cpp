// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "belief/belief.hpp"

namespace tactus::belief {
namespace {

constexpr double tolerance = 1e-9;      // m and rad
constexpr double incredible_bits = 20;  // a millionth

/// Whether every voxel centre inside the target is possibly occupied.
bool fits(const VoxelBelief& voxels, const geometry::DistanceField& field, const Pose& base_from_target) {
  const VoxelGrid& grid = voxels.model().grid;
  const geometry::Box& local = field.tree().box();
  const Vector3 centre = base_from_target * local.centre();
  const Vector3 half = base_from_target.linear().cwiseAbs() * (0.5 * local.size());
  const Pose target_from_base = base_from_target.inverse();
  bool all = true;
  grid.for_each_in({centre - half, centre + half}, [&](std::size_t voxel, const Vector3& p) {
    if (!all || voxels.possibly_occupied().test(voxel)) return;
    const Vector3 q = target_from_base * p;
    all = field.bounds(q).lower >= -tolerance || field.exact(q) >= -tolerance;
  });
  return all;
}

}  // namespace

bool Belief::contains(const Pose& base_from_target) const {
  if (!task().scene().prior.contains(base_from_target)) return false;
  if (!cells_) return fits(*voxels_, task().target_contact().field(), base_from_target);
  if (cells_->grid()) return cells_->grid()->holds(base_from_target, tolerance);
  return !cells_->all_of([&](const Cell& cell) {
    return cell.bits > incredible_bits || !scene::box_holds(cell.centre, cells_->half_width(cell), base_from_target);
  });
}

}  // namespace tactus::belief
