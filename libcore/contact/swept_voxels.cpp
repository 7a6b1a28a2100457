// SPDX-License-Identifier: BSD-3-Clause
#include "contact/swept_voxels.hpp"

#include <algorithm>
#include <cmath>

#include "contact/solid.hpp"

namespace tactus::contact {
namespace {

geometry::Box box_at(const Body& body, const Pose& base_from_body) {
  return moved_box(body.tree().box(), base_from_body);
}

bool inside(const Body& body, const Vector3& p) {
  if (!body.tree().box().contains(p)) return false;
  const geometry::DistanceBounds bounds = body.field().bounds(p);
  if (bounds.upper < 0.0 || bounds.lower > 0.0) return bounds.upper < 0.0;
  return body.tree().contains(p);
}

/// Squared distances along one line of the grid, in voxels: the lower envelope of parabolas.
void transform_line(std::vector<float>& line, std::vector<float>& result, std::vector<int>& apex,
                    std::vector<float>& begin) {
  const int n = static_cast<int>(line.size());
  int last = 0;
  apex[0] = 0;
  begin[0] = -1e30f;
  begin[1] = 1e30f;
  const auto meet = [&](int p, int q) {
    const auto fp = static_cast<float>(p), fq = static_cast<float>(q);
    return ((line[q] + fq * fq) - (line[p] + fp * fp)) / (2.0f * (fq - fp));
  };
  for (int q = 1; q < n; ++q) {
    while (last > 0 && meet(apex[last], q) <= begin[last]) --last;
    const float at = meet(apex[last], q);
    if (last > 0 || at > begin[0]) ++last;
    apex[last] = q;
    begin[last] = last == 0 ? -1e30f : at;
    begin[last + 1] = 1e30f;
  }
  for (int q = 0, k = 0; q < n; ++q) {
    while (begin[k + 1] < static_cast<float>(q)) ++k;
    const auto away = static_cast<float>(q - apex[k]);
    result[q] = away * away + line[apex[k]];
  }
}

}  // namespace

SweptVoxels swept_voxels(const RobotBodies& bodies, const BodyPath& path, const VoxelGrid& grid) {
  SweptVoxels swept;
  Bitset seen(grid.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const Pose body_from_base = path.base_from_body(i, b).inverse();
      grid.for_each_in(box_at(bodies.body(b), path.base_from_body(i, b)),
                       [&](std::size_t voxel, const Vector3& centre) {
                         if (seen.test(voxel) || !inside(bodies.body(b), body_from_base * centre)) return;
                         seen.set(voxel);
                         swept.voxels.push_back(static_cast<std::uint32_t>(voxel));
                       });
    }
    swept.entered.push_back(static_cast<std::uint32_t>(swept.voxels.size()));
  }
  return swept;
}

Bitset contact_candidates(const RobotBodies& bodies, const BodyPath& path, std::size_t stop, const VoxelGrid& grid,
                          double slack) {
  Bitset candidates(grid.size());
  const double near = grid.half_diagonal() + slack;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Body& body = bodies.body(b);
    const Pose body_from_base = path.base_from_body(stop, b).inverse();
    const Pose before_from_base = path.base_from_body(stop == 0 ? 0 : stop - 1, b).inverse();
    grid.for_each_in(box_at(body, path.base_from_body(stop, b)).inflated(near),
                     [&](std::size_t voxel, const Vector3& centre) {
                       const geometry::DistanceBounds at_stop = body.field().bounds(body_from_base * centre);
                       if (at_stop.lower > near || at_stop.upper < -near) return;
                       if (body.field().bounds(before_from_base * centre).upper < -near) return;
                       candidates.set(voxel);
                     });
  }
  return candidates;
}

std::vector<float> distance_to(const Bitset& from, const VoxelGrid& grid) {
  constexpr float far = 1e12f;
  std::vector<float> squared(grid.size(), far);
  from.for_each([&](std::size_t voxel) { squared[voxel] = 0.0f; });
  const std::array<int, 3> shape = grid.shape();
  std::array<std::size_t, 3> stride{1, static_cast<std::size_t>(shape[0]),
                                    static_cast<std::size_t>(shape[0]) * shape[1]};
  for (int d = 0; d < 3; ++d) {
    const int n = shape[d];
    std::vector<float> line(n), result(n), begin(n + 1);
    std::vector<int> apex(n);
    const int u = (d + 1) % 3, v = (d + 2) % 3;
    for (int i = 0; i < shape[u]; ++i)
      for (int j = 0; j < shape[v]; ++j) {
        float* first = squared.data() + i * stride[u] + j * stride[v];
        for (int k = 0; k < n; ++k) line[k] = first[k * stride[d]];
        transform_line(line, result, apex, begin);
        for (int k = 0; k < n; ++k) first[k * stride[d]] = result[k];
      }
  }
  for (float& value : squared) value = value >= far ? 1e30f : std::sqrt(value) * static_cast<float>(grid.pitch());
  return squared;
}

}  // namespace tactus::contact
