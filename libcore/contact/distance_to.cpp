// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "contact/swept_voxels.hpp"

namespace tactus::contact {
namespace {

constexpr float far = kernel::no_member;
constexpr int batch = kernel::columns_per_batch;

/// Squared distances along x, in voxels: from the member before and the member after.
void along_x(const Bitset& from, const VoxelGrid& grid, std::vector<float>& squared) {
  const int nx = grid.shape()[0];
  for (std::size_t first = 0; first < grid.size(); first += nx) {
    float away = far;
    for (int x = 0; x < nx; ++x) {
      away = from.test(first + x) ? 0.0f : away + 1.0f;
      squared[first + x] = away;
    }
    if (away >= far) continue;
    for (int x = nx - 1; x >= 0; --x) {
      away = std::min(away + 1.0f, squared[first + x]);
      squared[first + x] = std::min(away * away, far);
    }
  }
}

/// Columns of a grid along y or z: column (i, j) begins at i + j * `apart`, its rows are `stride` floats apart.
struct Columns {
  int width, count;  ///< i < width, j < count
  std::size_t apart;
  int length;
  std::size_t stride;

  /// Calls `visit(first float, column in the batch, how many)` for each run of neighbours in the batch from `begin`.
  template <typename Visit>
  void for_each_run(int begin, Visit&& visit) const {
    const int end = std::min(begin + batch, width * count);
    for (int c = begin; c < end;) {
      const int run = std::min(width - c % width, end - c);
      visit(static_cast<std::size_t>(c % width) + static_cast<std::size_t>(c / width) * apart, c - begin, run);
      c += run;
    }
  }
};

void along(const Columns& columns, const kernel::VoxelKernel& kernel, std::vector<float>& squared) {
  std::vector<float> before(static_cast<std::size_t>(columns.length) * batch, far), after(before.size());
  for (int begin = 0; begin < columns.width * columns.count; begin += batch) {
    columns.for_each_run(begin, [&](std::size_t first, int column, int run) {
      for (int k = 0; k < columns.length; ++k)
        std::copy_n(&squared[first + k * columns.stride], run, &before[k * batch + column]);
    });
    kernel.nearest(before.data(), columns.length, after.data());
    columns.for_each_run(begin, [&](std::size_t first, int column, int run) {
      for (int k = 0; k < columns.length; ++k)
        std::copy_n(&after[k * batch + column], run, &squared[first + k * columns.stride]);
    });
  }
}

}  // namespace

std::vector<float> distance_to(const Bitset& from, const VoxelGrid& grid, const kernel::VoxelKernel& kernel) {
  const auto [nx, ny, nz] = grid.shape();
  const std::size_t row = static_cast<std::size_t>(nx), layer = row * ny;
  std::vector<float> squared(grid.size());
  along_x(from, grid, squared);
  along({nx, nz, layer, ny, row}, kernel, squared);
  along({nx * ny, 1, 0, nz, layer}, kernel, squared);
  const auto pitch = static_cast<float>(grid.pitch());
  for (float& value : squared) value = value >= far ? 1e30f : std::sqrt(value) * pitch;
  return squared;
}

}  // namespace tactus::contact
