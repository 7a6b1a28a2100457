// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/voxel_grid.hpp"

#include <algorithm>
#include <cmath>

#include "support/error.hpp"

namespace tactus::geometry {

VoxelGrid::VoxelGrid(const Box& box, double pitch, std::size_t max_voxels) : origin_(box.low), pitch_(pitch) {
  double total = 1.0;
  for (int d = 0; d < 3; ++d) {
    const double cells = std::max(1.0, std::ceil(box.size()[d] / pitch - 1e-9));
    total *= cells;
    if (total > static_cast<double>(max_voxels))
      throw support::Error(support::Status::invalid_argument, "voxel grid: a pitch of " + std::to_string(pitch) +
                                                                  " m gives more than " + std::to_string(max_voxels) +
                                                                  " voxels; a coarser one is needed");
    shape_[d] = static_cast<int>(cells);
  }
}

std::array<int, 3> VoxelGrid::coordinates(std::size_t i) const {
  const auto nx = static_cast<std::size_t>(shape_[0]), ny = static_cast<std::size_t>(shape_[1]);
  return {static_cast<int>(i % nx), static_cast<int>(i / nx % ny), static_cast<int>(i / (nx * ny))};
}

Vector3 VoxelGrid::centre(std::size_t i) const {
  const std::array<int, 3> c = coordinates(i);
  return centre(c[0], c[1], c[2]);
}

std::optional<std::size_t> VoxelGrid::voxel_at(const Vector3& p) const {
  const Vector3 cell = ((p - origin_) / pitch_).array().floor();
  for (int d = 0; d < 3; ++d)
    if (!(cell[d] >= 0.0 && cell[d] < shape_[d])) return std::nullopt;
  return index(static_cast<int>(cell[0]), static_cast<int>(cell[1]), static_cast<int>(cell[2]));
}

void VoxelGrid::range(const Box& box, std::array<int, 3>& low, std::array<int, 3>& high) const {
  for (int d = 0; d < 3; ++d) {
    const double n = shape_[d];
    low[d] = static_cast<int>(std::clamp(std::ceil((box.low[d] - origin_[d]) / pitch_ - 0.5 - 1e-9), 0.0, n));
    high[d] = static_cast<int>(std::clamp(std::floor((box.high[d] - origin_[d]) / pitch_ - 0.5 + 1e-9) + 1.0, 0.0, n));
  }
}

}  // namespace tactus::geometry
