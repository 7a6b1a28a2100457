// SPDX-License-Identifier: BSD-3-Clause
#include "bench/voxels_baseline.hpp"

#include <algorithm>
#include <cmath>

#include "contact/solid.hpp"

namespace tactus::bench::plain {
namespace {

bool inside(const contact::Body& body, const geometry::Vector3& p) {
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
      const geometry::Pose body_from_base = path.base_from_body(i, b).inverse();
      grid.for_each_in(contact::moved_box(bodies.body(b).tree().box(), path.base_from_body(i, b)),
                       [&](std::size_t voxel, const geometry::Vector3& centre) {
                         if (seen.test(voxel) || !inside(bodies.body(b), body_from_base * centre)) return;
                         seen.set(voxel);
                         swept.voxels.push_back(static_cast<std::uint32_t>(voxel));
                       });
    }
    swept.entered.push_back(static_cast<std::uint32_t>(swept.voxels.size()));
  }
  return swept;
}

std::vector<std::uint32_t> entered_of(const SweptVoxels& swept, const Bitset& set) {
  std::vector<std::uint32_t> counts;
  std::size_t k = 0;
  for (const std::uint32_t end : swept.entered) {
    counts.push_back(0);
    for (; k < end; ++k) counts.back() += set.test(swept.voxels[k]) ? 1U : 0U;
  }
  return counts;
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

Bitset after_contact(const belief::VoxelModel& model, Bitset possibly_occupied, Bitset candidates) {
  const double half_diagonal = model.grid.half_diagonal();
  for (bool first = true;; first = false) {
    const std::vector<float> to_possible = distance_to(possibly_occupied, model.grid);
    Bitset kept(model.grid.size()), unoccupied(model.grid.size());
    candidates.for_each([&](std::size_t v) {
      if (to_possible[v] <= model.cover + half_diagonal + 1e-6) kept.set(v);
    });
    if (!first && kept == candidates) return possibly_occupied;
    candidates = std::move(kept);
    const std::vector<float> distance = distance_to(candidates, model.grid);
    possibly_occupied.for_each([&](std::size_t v) {
      if (distance[v] > model.diameter + half_diagonal + 1e-6) unoccupied.set(v);
    });
    possibly_occupied.and_not(unoccupied);
  }
}

}  // namespace tactus::bench::plain
