// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "geometry/mesh.hpp"

namespace tactus::geometry {

/// Cubes of `pitch` metres that fill a box; a voxel stands for its centre. Voxels are numbered x fastest, z slowest.
class VoxelGrid {
 public:
  VoxelGrid() = default;
  /// Covers `box`: at least one voxel in each direction. Throws `invalid_argument` above `max_voxels`.
  VoxelGrid(const Box& box, double pitch, std::size_t max_voxels = 50'000'000);

  double pitch() const { return pitch_; }
  double half_diagonal() const { return 0.5 * std::sqrt(3.0) * pitch_; }
  const std::array<int, 3>& shape() const { return shape_; }
  std::size_t size() const { return static_cast<std::size_t>(shape_[0]) * shape_[1] * shape_[2]; }
  Box box() const { return {origin_, origin_ + pitch_ * Vector3(shape_[0], shape_[1], shape_[2])}; }

  std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(shape_[0]) * (y + static_cast<std::size_t>(shape_[1]) * z);
  }
  std::array<int, 3> coordinates(std::size_t index) const;
  Vector3 centre(std::size_t index) const;
  Vector3 centre(int x, int y, int z) const { return origin_ + pitch_ * Vector3(x + 0.5, y + 0.5, z + 0.5); }

  /// The voxel whose cube holds `p`; none outside the grid.
  std::optional<std::size_t> voxel_at(const Vector3& p) const;

  /// The range of voxel coordinates whose centres may lie in `box`: low inclusive, high exclusive; empty ranges have
  /// low >= high.
  void range(const Box& box, std::array<int, 3>& low, std::array<int, 3>& high) const;

  /// Calls `visit(index, centre)` for every voxel whose centre may lie in `box`.
  template <typename Visit>
  void for_each_in(const Box& box, Visit&& visit) const {
    std::array<int, 3> low, high;
    range(box, low, high);
    for (int z = low[2]; z < high[2]; ++z)
      for (int y = low[1]; y < high[1]; ++y)
        for (int x = low[0]; x < high[0]; ++x) visit(index(x, y, z), centre(x, y, z));
  }

 private:
  Vector3 origin_ = Vector3::Zero();
  double pitch_ = 1.0;
  std::array<int, 3> shape_{0, 0, 0};
};

}  // namespace tactus::geometry
