// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/kernel/descent.hpp"

/// The kernels over a vector type `V` of sixteen floats (`V::F`) and integers (`V::I`) with masks of sixteen bits.
namespace tactus::contact::kernel {

template <typename V>
struct Over {
  using F = typename V::F;
  using I = typename V::I;

  struct Bounds {
    F lower, upper;
  };

  static F turned(const Placement& p, int row, F x, F y, F z) {
    const float* r = p.rotation + 3 * row;
    return V::add(V::add(V::mul(V::set(r[0]), x), V::mul(V::set(r[1]), y)),
                  V::add(V::mul(V::set(r[2]), z), V::set(p.translation[row])));
  }

  /// Sixteen points against the samples nearest to them: the distance is 1-Lipschitz.
  static Bounds bounds(const Field& field, F x, F y, F z) {
    const F p[3] = {x, y, z};
    F squared = V::set(0.0f), off_lattice = V::set(0.0f);
    I index = V::set_int(0);
    for (int d = 0; d < 3; ++d) {
      const F scaled = V::mul(V::sub(p[d], V::set(field.origin[d])), V::set(field.inverse_spacing));
      const F nearest = V::min(V::max(V::floor(V::add(scaled, V::set(0.5f))), V::set(0.0f)), V::set(field.last[d]));
      const F offset = V::sub(scaled, nearest);
      squared = V::add(squared, V::mul(offset, offset));
      off_lattice = V::max(off_lattice, V::max(offset, V::sub(V::set(0.0f), offset)));
      index = V::add_int(index, V::mul_int(V::to_int(nearest), V::set_int(field.stride[d])));
    }
    const F sample = V::mul(V::gather(field.samples, index), V::set(field.quantum));
    const F error = V::add(V::mul(V::sqrt(squared), V::set(field.spacing)), V::set(field.slack));
    Bounds result{V::sub(sample, error), V::add(sample, error)};
    if (V::less(V::set(0.5001f), off_lattice) != 0) result.lower = V::max(result.lower, outside(field, p));
    return result;
  }

  /// The distance to the box of the surface, for the points outside it; very negative for the others.
  static F outside(const Field& field, const F (&p)[3]) {
    F squared = V::set(0.0f);
    for (int d = 0; d < 3; ++d) {
      const F below = V::sub(V::set(field.box_low[d]), p[d]), above = V::sub(p[d], V::set(field.box_high[d]));
      const F away = V::max(V::max(below, above), V::set(0.0f));
      squared = V::add(squared, V::mul(away, away));
    }
    const F distance = V::sub(V::sqrt(squared), V::set(field.slack));
    return V::select(V::less(V::set(0.0f), distance), distance, V::set(-1e30f));
  }

  static Bounds bounds(const Block& block, const Field& field, const Placement& placement) {
    const F x = V::load(block.x), y = V::load(block.y), z = V::load(block.z);
    return bounds(field, turned(placement, 0, x, y, z), turned(placement, 1, x, y, z), turned(placement, 2, x, y, z));
  }

  static void measure(const Block& block, const Field& field, const Placement& placement, float* lower, float* upper) {
    const Bounds at = bounds(block, field, placement);
    V::store(lower, at.lower);
    V::store(upper, at.upper);
  }

  static Verdict walk(const Block* blocks, const Field& field, const Placement& placement, const Question& question,
                      Walk& walk) {
    alignas(64) float gaps[lanes];
    const F threshold = V::set(question.threshold);
    walk.piece_count = 0;
    while (walk.depth > 0) {
      if (walk.piece_count > Walk::most_pieces - lanes) return Verdict::undecided;
      const Block& block = blocks[walk.stack[--walk.depth]];
      const Bounds at = bounds(block, field, placement);
      const std::uint32_t is_piece = V::negative(V::load_int(block.next));
      F radius = V::load(block.radius);
      const std::uint32_t is_ball = V::less(V::set(0.5f * no_ball), radius);
      F certain = threshold;
      if (question.threshold < 0.0f)
        radius = V::select(is_piece & is_ball, V::set(0.0f), radius);
      else if (question.by_balls)
        certain = V::select(V::less(radius, threshold), V::add(threshold, radius), threshold);
      if ((is_piece & is_ball & V::less(at.upper, certain)) != 0) return Verdict::hit;

      const F above = V::sub(at.lower, threshold), gap = V::sub(above, radius);
      const std::uint32_t clear = V::less(V::set(0.0f), gap);
      const F wanted = V::min(V::set(walk.clearance), V::set(question.enough));
      const std::uint32_t settled =
          clear & (is_piece | V::less_equal(wanted, gap) | V::less_equal(V::mul(radius, V::set(1.25f)), above));
      const std::uint32_t open = is_ball & ~settled;
      std::uint32_t inner = open & ~is_piece;
      const std::uint32_t fine = inner & V::less(radius, V::set(question.detail));
      if (fine != 0 && question.threshold > 0.0f) return Verdict::hit;
      inner &= ~fine;
      const float lowest = V::least(V::select(is_ball & ~inner, gap, V::set(1e30f)));
      if (lowest < walk.clearance) walk.clearance = lowest;

      for (std::uint32_t left = open & is_piece; left != 0; left &= left - 1)
        walk.pieces[walk.piece_count++] = ~block.next[__builtin_ctz(left)];
      if (inner == 0) continue;
      V::store(gaps, gap);
      int nearest = __builtin_ctz(inner);
      for (std::uint32_t left = inner & (inner - 1); left != 0; left &= left - 1) {
        int lane = __builtin_ctz(left);
        if (gaps[lane] < gaps[nearest]) {
          const int swapped = nearest;
          nearest = lane;
          lane = swapped;
        }
        walk.stack[walk.depth++] = block.next[lane];
      }
      walk.stack[walk.depth++] = block.next[nearest];
    }
    return walk.piece_count > 0 ? Verdict::undecided : Verdict::free;
  }

  static F magnitude(F a) { return V::max(a, V::sub(V::set(0.0f), a)); }

  /// Separating axes along the normals of both boxes' faces, in the target's frame.
  static std::uint32_t near(const PoseBlock& body_pose, const Extent& body, const Placement& target_from_base,
                            const Extent& target, float reach) {
    F rotation[9], centre[3];
    for (int row = 0; row < 3; ++row) {
      const float* r = target_from_base.rotation + 3 * row;
      const F a = V::set(r[0]), b = V::set(r[1]), c = V::set(r[2]);
      const auto product = [&](const F& x, const F& y, const F& z) {
        return V::add(V::add(V::mul(a, x), V::mul(b, y)), V::mul(c, z));
      };
      for (int column = 0; column < 3; ++column)
        rotation[3 * row + column] =
            product(V::load(body_pose.rotation[column]), V::load(body_pose.rotation[3 + column]),
                    V::load(body_pose.rotation[6 + column]));
      centre[row] = V::add(product(V::load(body_pose.translation[0]), V::load(body_pose.translation[1]),
                                   V::load(body_pose.translation[2])),
                           V::set(target_from_base.translation[row] - target.centre[row]));
    }
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        centre[row] = V::add(centre[row], V::mul(rotation[3 * row + column], V::set(body.centre[column])));

    std::uint32_t result = 0xffffu;
    for (int row = 0; row < 3; ++row) {
      F wide = V::set(target.half[row] + reach);
      for (int column = 0; column < 3; ++column)
        wide = V::add(wide, V::mul(magnitude(rotation[3 * row + column]), V::set(body.half[column])));
      result &= V::less_equal(magnitude(centre[row]), wide);
    }
    for (int column = 0; column < 3; ++column) {
      F wide = V::set(body.half[column] + reach), along = V::set(0.0f);
      for (int row = 0; row < 3; ++row) {
        wide = V::add(wide, V::mul(magnitude(rotation[3 * row + column]), V::set(target.half[row])));
        along = V::add(along, V::mul(rotation[3 * row + column], centre[row]));
      }
      result &= V::less_equal(magnitude(along), wide);
    }
    return result;
  }
};

}  // namespace tactus::contact::kernel
