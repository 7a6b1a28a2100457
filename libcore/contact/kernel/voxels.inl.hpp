// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/kernel/voxels.hpp"

/// The kernels over a vector type `V` of `V::width` floats (`V::F`) and integers (`V::I`), with masks of as many bits.
/// `V` is local to its file, so that no code compiled for one machine is linked into that for another.
namespace tactus::contact::kernel {

template <typename V>
struct VoxelsOver {
  using F = typename V::F;
  using I = typename V::I;
  static constexpr float never = 1e30f;
  static constexpr float probes[] = {1.0f, 2.0f, 4.0f};  // spacings from the point asked about

  struct Bounds {
    F lower, upper;  // m
  };

  /// The sample nearest to a place.
  struct Sample {
    F at[3];
    I index;
    F distance;  // m
  };

  static F squared_length(F x, F y, F z) { return V::add(V::add(V::mul(x, x), V::mul(y, y)), V::mul(z, z)); }

  static Sample sample_near(const VoxelField& field, const F (&p)[3]) {
    Sample sample;
    sample.index = V::set_int(0);
    for (int d = 0; d < 3; ++d) {
      const F on_lattice = V::min(V::max(p[d], V::set(0.0f)), V::set(field.last[d]));
      const I nearest = V::to_int(V::add(on_lattice, V::set(0.5f)));
      sample.at[d] = V::to_float(nearest);
      sample.index = V::add_int(sample.index, V::mul_int(nearest, V::set_int(field.stride[d])));
    }
    sample.distance = V::gather(field.samples, sample.index);
    return sample;
  }

  /// What a sample says about the distance at p: it is 1-Lipschitz.
  static Bounds bounds_from(const Sample& sample, const VoxelField& field, const F (&p)[3], float slack) {
    const F squared =
        squared_length(V::sub(p[0], sample.at[0]), V::sub(p[1], sample.at[1]), V::sub(p[2], sample.at[2]));
    const F error = V::add(V::mul(V::sqrt(squared), V::set(field.spacing)), V::set(slack));
    return {V::sub(sample.distance, error), V::add(sample.distance, error)};
  }

  static F from_box(const VoxelField& field, const F (&p)[3], float slack) {
    F away[3];
    for (int d = 0; d < 3; ++d)
      away[d] =
          V::max(V::max(V::sub(V::set(field.box_low[d]), p[d]), V::sub(p[d], V::set(field.box_high[d]))), V::set(0.0f));
    return V::sub(V::mul(V::sqrt(squared_length(away[0], away[1], away[2])), V::set(field.spacing)), V::set(slack));
  }

  /// The slope of the distance at a sample, per direction.
  static F slope(const Sample& sample, const VoxelField& field, int d) {
    const F before = V::max(V::sub(sample.at[d], V::set(1.0f)), V::set(0.0f));
    const F after = V::min(V::add(sample.at[d], V::set(1.0f)), V::set(field.last[d]));
    const auto at = [&](F neighbour) {
      const I step = V::mul_int(V::to_int(V::sub(neighbour, sample.at[d])), V::set_int(field.stride[d]));
      return V::gather(field.samples, V::add_int(sample.index, step));
    };
    return V::mul(V::sub(at(after), at(before)), V::set(0.5f / field.spacing));
  }

  /// Samples straight away from the surface bound the distance best: along the slope it changes as fast as it can.
  static Bounds tightened(Bounds bounds, const Sample& sample, const VoxelField& field, const F (&p)[3], float slack) {
    const F slopes[3] = {slope(sample, field, 0), slope(sample, field, 1), slope(sample, field, 2)};
    F estimate = sample.distance;
    for (int d = 0; d < 3; ++d)
      estimate = V::add(estimate, V::mul(V::mul(slopes[d], V::sub(p[d], sample.at[d])), V::set(field.spacing)));
    const std::uint32_t inside = V::less(estimate, V::set(0.0f));
    for (const float steps : probes) {
      const F away = V::select(inside, V::set(-steps), V::set(steps));
      const F probe[3] = {V::add(p[0], V::mul(away, slopes[0])), V::add(p[1], V::mul(away, slopes[1])),
                          V::add(p[2], V::mul(away, slopes[2]))};
      const Bounds from_probe = bounds_from(sample_near(field, probe), field, p, slack);
      bounds.lower = V::max(bounds.lower, from_probe.lower);
      bounds.upper = V::min(bounds.upper, from_probe.upper);
    }
    return bounds;
  }

  static std::uint32_t undecided(const Bounds& bounds) {
    return ~(V::less(bounds.upper, V::set(0.0f)) | V::less(V::set(0.0f), bounds.lower));
  }

  /// Of the signed distance at voxels of which those in `open` matter.
  static Bounds bounds(const VoxelField& field, const GridPlace& place, const float (&first)[3], const float* x,
                       const float* y, std::uint32_t open) {
    const F fx = V::load(x), fy = V::load(y);
    F p[3];
    for (int d = 0; d < 3; ++d)
      p[d] =
          V::add(V::add(V::mul(fx, V::set(place.along_x[d])), V::mul(fy, V::set(place.along_y[d]))), V::set(first[d]));
    const Sample sample = sample_near(field, p);
    Bounds bounds = bounds_from(sample, field, p, place.slack);
    bounds.lower = V::max(bounds.lower, from_box(field, p, place.slack));
    return (open & undecided(bounds)) == 0 ? bounds : tightened(bounds, sample, field, p, place.slack);
  }

  static std::int32_t look(const VoxelField& field, const GridPlace& place, const VoxelBlocks& blocks,
                           const BlockRange& range, float travelled, BlockFound* found) {
    std::int32_t count = 0;
    for (std::int32_t z = range.low; z < range.high; ++z) {
      float first[3];
      for (int d = 0; d < 3; ++d) first[d] = place.first[d] + static_cast<float>(z) * place.along_z[d];
      const std::int32_t layer = z * blocks.per_layer, end = layer + range.end;
      for (std::int32_t some = layer + range.begin; some < end; some += V::width) {
        const std::uint32_t all = (1U << (end - some < V::width ? end - some : V::width)) - 1U;
        std::uint32_t due = all & ~V::less(V::set(travelled), V::load(blocks.due + some));
        for (; due != 0; due &= due - 1) {
          const std::int32_t block = some + __builtin_ctz(due);
          const BlockFound at = look(field, place, blocks, first, block, block - layer, travelled);
          if ((at.inside | at.undecided) != 0) found[count++] = at;
        }
      }
    }
    return count;
  }

  /// `of_layer`: the block's number in its layer.
  static BlockFound look(const VoxelField& field, const GridPlace& place, const VoxelBlocks& blocks,
                         const float (&first)[3], std::int32_t block, std::int32_t of_layer, float travelled) {
    const std::uint32_t open = blocks.open[block];
    std::uint32_t inside = 0, undecided_ones = 0;
    F clearance = V::set(never);
    for (int lane = 0; lane < voxels_per_block && open != 0; lane += V::width) {
      const std::uint32_t of_lanes = (open >> lane) & ((1U << V::width) - 1U);
      const int at = of_layer * voxels_per_block + lane;
      const Bounds b = bounds(field, place, first, blocks.x + at, blocks.y + at, of_lanes);
      const std::uint32_t in = of_lanes & V::less(b.upper, V::set(0.0f));
      inside |= in << lane;
      undecided_ones |= (of_lanes & undecided(b)) << lane;
      clearance = V::min(clearance, V::select(of_lanes & ~in, b.lower, V::set(never)));
    }
    const float least = V::least(clearance);
    blocks.open[block] = static_cast<std::uint16_t>(open & ~inside);
    blocks.due[block] = least > 0.0f ? travelled + least : travelled;
    return {block, static_cast<std::uint16_t>(inside), static_cast<std::uint16_t>(undecided_ones)};
  }

  static bool has_member(const float* row) {
    std::uint32_t members = 0;
    for (int column = 0; column < columns_per_batch; column += V::width)
      members |= V::less(V::load(row + column), V::set(no_member));
    return members != 0;
  }

  static void nearest(const float* squared, std::int32_t length, float* nearest) {
    std::int32_t first = 0, last = length - 1;
    while (first < last && !has_member(squared + first * columns_per_batch)) ++first;
    while (first < last && !has_member(squared + last * columns_per_batch)) --last;
    for (std::int32_t i = 0; i < length; ++i) nearest_to(squared, first, last, i, nearest + i * columns_per_batch);
  }

  /// Outwards from row i through those from `first` to `last` until nothing farther off can be nearer. Beyond an end
  /// its row is taken again as if it were farther off than it is, which changes nothing.
  static void nearest_to(const float* squared, std::int32_t first, std::int32_t last, std::int32_t i, float* nearest) {
    constexpr int parts = columns_per_batch / V::width;
    F least[parts];
    for (int part = 0; part < parts; ++part) least[part] = V::load(squared + i * columns_per_batch + part * V::width);
    const std::int32_t farthest = i - first > last - i ? i - first : last - i;
    for (std::int32_t away = i < first ? first - i : i > last ? i - last : 1; away <= farthest; ++away) {
      const float* below = squared + (i - away < first ? first : i - away) * columns_per_batch;
      const float* above = squared + (i + away > last ? last : i + away) * columns_per_batch;
      const F added = V::set(static_cast<float>(away) * static_cast<float>(away));
      std::uint32_t farther = 0;
      for (int part = 0; part < parts; ++part) {
        const int at = part * V::width;
        least[part] = V::min(least[part], V::add(V::min(V::load(below + at), V::load(above + at)), added));
        farther |= V::less(added, least[part]);
      }
      if (farther == 0) break;
    }
    for (int part = 0; part < parts; ++part) V::store(nearest + part * V::width, least[part]);
  }

  static constexpr VoxelKernel kernel(const char* name, bool (*supported)()) {
    return {name, supported, &look, &nearest};
  }
};

}  // namespace tactus::contact::kernel
