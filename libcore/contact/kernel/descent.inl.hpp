// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/kernel/descent.hpp"

/// The kernels over a vector type `V` of sixteen floats (`V::F`) and integers (`V::I`) with masks of sixteen bits.
namespace tactus::contact::kernel {

template <typename V>
struct Over {
  using F = typename V::F;
  using I = typename V::I;

  /// Of the squared distance to the nearest sample, in spacings: on the lattice it is at most 3/4.
  static constexpr float off_lattice = 0.7501f;

  struct Bounds {
    F lower, upper;
  };

  struct Points {
    F v[3];
  };

  static float magnitude(float a) { return a < 0.0f ? -a : a; }

  static Points centres(const Block& block) {
    return {{V::load(block.centre[0]), V::load(block.centre[1]), V::load(block.centre[2])}};
  }

  static Points placed(const Placement& p, const Points& points) {
    Points result;
    for (int row = 0; row < 3; ++row) {
      const float* r = p.rotation + 3 * row;
      result.v[row] = V::add(V::add(V::mul(V::set(r[0]), points.v[0]), V::mul(V::set(r[1]), points.v[1])),
                             V::add(V::mul(V::set(r[2]), points.v[2]), V::set(p.translation[row])));
    }
    return result;
  }

  /// Sixteen points against the samples nearest to them: the distance is 1-Lipschitz.
  static Bounds bounds(const Field& field, int level, const Points& p) {
    const Lattice& lattice = field.lattices[level];
    F squared = V::set(0.0f);
    I index = V::set_int(0);
    for (int d = 0; d < 3; ++d) {
      const F scaled = V::mul(V::sub(p.v[d], V::set(lattice.origin[d])), V::set(lattice.inverse_spacing));
      const F nearest = V::min(V::max(V::floor(V::add(scaled, V::set(0.5f))), V::set(0.0f)), V::set(lattice.last[d]));
      const F offset = V::sub(scaled, nearest);
      squared = V::add(squared, V::mul(offset, offset));
      index = V::add_int(index, V::mul_int(V::to_int(nearest), V::set_int(lattice.stride[d])));
    }
    const F sample = V::mul(V::gather(lattice.samples, index), V::set(field.quantum));
    const F error = V::add(V::mul(V::sqrt(squared), V::set(lattice.spacing)), V::set(field.slack));
    Bounds result{V::sub(sample, error), V::add(sample, error)};
    if (V::less(V::set(off_lattice), squared) != 0) result.lower = V::max(result.lower, outside(field, p));
    return result;
  }

  /// The distance to the box of the surface, for the points outside it; very negative for the others.
  static F outside(const Field& field, const Points& p) {
    F squared = V::set(0.0f);
    for (int d = 0; d < 3; ++d) {
      const F away = V::sub(V::magnitude(V::sub(p.v[d], V::set(field.box_centre[d]))), V::set(field.box_half[d]));
      const F beyond = V::max(away, V::set(0.0f));
      squared = V::add(squared, V::mul(beyond, beyond));
    }
    const F distance = V::sub(V::sqrt(squared), V::set(field.slack));
    return V::select(V::less(V::set(0.0f), distance), distance, V::set(-1e30f));
  }

  /// The target's box as seen along the axes of a placed body.
  struct Surroundings {
    float centre[3], half[3];  ///< m
    float turned[9];           ///< magnitudes of target_from_body's rotation

    Surroundings(const Field& field, const Placement& p) {
      for (int column = 0; column < 3; ++column) {
        centre[column] = 0.0f;
        half[column] = field.slack;
        for (int row = 0; row < 3; ++row) {
          const float entry = p.rotation[3 * row + column];
          turned[3 * row + column] = magnitude(entry);
          centre[column] += entry * (field.box_centre[row] - p.translation[row]);
          half[column] += magnitude(entry) * field.box_half[row];
        }
      }
    }
  };

  /// How far the boxes of a block are from the target's, along the normals of either's faces.
  static F box_gap(const Block& block, const Field& field, const Surroundings& around, const Points& in_body,
                   const Points& in_target) {
    const F half[3] = {V::load(block.half[0]), V::load(block.half[1]), V::load(block.half[2])};
    F gap = V::set(-1e30f);
    for (int d = 0; d < 3; ++d) {
      const F away = V::magnitude(V::sub(in_body.v[d], V::set(around.centre[d])));
      gap = V::max(gap, V::sub(V::sub(away, V::set(around.half[d])), half[d]));
    }
    for (int row = 0; row < 3; ++row) {
      const float* turned = around.turned + 3 * row;
      const F away = V::magnitude(V::sub(in_target.v[row], V::set(field.box_centre[row])));
      const F wide = V::add(V::add(V::mul(V::set(turned[0]), half[0]), V::mul(V::set(turned[1]), half[1])),
                            V::add(V::mul(V::set(turned[2]), half[2]), V::set(field.box_half[row] + field.slack)));
      gap = V::max(gap, V::sub(away, wide));
    }
    return gap;
  }

  static void measure(const Block& block, const Field& field, const Placement& placement, float* lower, float* upper) {
    const Bounds at = bounds(field, 0, placed(placement, centres(block)));
    V::store(lower, at.lower);
    V::store(upper, at.upper);
  }

  /// Puts blocks on the stack, that of the least key last.
  static void push(const Block& block, std::uint32_t which, const F& key, Walk& walk) {
    const F keys = V::select(which, key, V::set(none_above));
    const std::uint32_t least = which & V::less_equal(keys, V::set(V::least(keys)));
    const int lane = __builtin_ctz(least != 0 ? least : which);
    std::int32_t* const added = walk.stack + walk.depth;
    V::compress(added, which, V::load_int(block.next));
    walk.depth += __builtin_popcount(which);
    added[__builtin_popcount(which & ((1u << lane) - 1u))] = walk.stack[walk.depth - 1];
    walk.stack[walk.depth - 1] = block.next[lane];
  }

  /// A block of which the boxes don't tell enough.
  struct Open {
    const Block* block;
    Points centres;  ///< in the target's frame
    F gap;           ///< above the threshold, of the boxes
    int level;       ///< of the field
  };

  /// Takes blocks from the stack until one is open, and passes over those that are not; false if none is.
  static bool next_open(const Block* blocks, const Field& field, const Surroundings& around, const Placement& placement,
                        F threshold, F& clearance, Walk& walk, Open& open) {
    while (walk.depth > 0) {
      const std::int32_t next = walk.stack[--walk.depth];
      open.block = &blocks[next / 4];
      open.level = next % 4;
      const Points in_body = centres(*open.block);
      open.centres = placed(placement, in_body);
      open.gap = V::sub(box_gap(*open.block, field, around, in_body, open.centres), threshold);
      if (V::less_equal(open.gap, V::set(0.0f)) != 0) return true;
      clearance = V::min(clearance, open.gap);
    }
    return false;
  }

  /// Decides the parts of a block by the distances at their centres: whether one is hit, and what else to look at.
  static bool hit(const Open& opened, const Bounds& at, const Question& question, F& clearance, Walk& walk) {
    const Block& block = *opened.block;
    const F zero = V::set(0.0f), threshold = V::set(question.threshold);
    const std::uint32_t is_piece = V::negative(V::load_int(block.next));
    F radius = V::load(block.radius), core = V::load(block.core);
    if (question.threshold < 0.0f) {
      if (!question.errs_to_hit) radius = V::select(is_piece, zero, radius);
      core = V::min(core, zero);
    } else if (question.errs_to_hit) {
      core = V::select(is_piece & V::less(radius, threshold), radius, core);
    }
    if (V::less(at.upper, V::add(threshold, core)) != 0) return true;

    const F gap = V::max(opened.gap, V::sub(V::sub(at.lower, threshold), radius));
    const std::uint32_t open = V::less_equal(gap, zero);
    clearance = V::min(clearance, V::select(open, V::set(none_above), gap));
    std::uint32_t inner = open & ~is_piece;
    const std::uint32_t fine = inner & V::less(radius, V::set(question.detail));
    if (fine != 0) {
      if (question.errs_to_hit) return true;
      clearance = zero;
      inner &= ~fine;
    }
    const std::uint32_t pieces = open & is_piece;
    V::compress(walk.pieces + walk.piece_count, pieces, V::sub_int(V::set_int(-1), V::load_int(block.next)));
    walk.piece_count += __builtin_popcount(pieces);
    if (inner != 0) push(block, inner, V::sub(at.upper, core), walk);
    return false;
  }

  /// Two blocks at a time: the one's samples are awaited while the other's are on their way.
  static Verdict walk(const Block* blocks, const Field& field, const Placement& placement, const Question& question,
                      Walk& walk) {
    const F threshold = V::set(question.threshold);
    const Surroundings around(field, placement);
    F clearance = V::set(walk.clearance);
    walk.piece_count = 0;
    Open a, b;
    while (walk.piece_count <= Walk::most_pieces - 2 * lanes &&
           next_open(blocks, field, around, placement, threshold, clearance, walk, a)) {
      if (next_open(blocks, field, around, placement, threshold, clearance, walk, b)) {
        const Bounds at_a = bounds(field, a.level, a.centres), at_b = bounds(field, b.level, b.centres);
        if (hit(a, at_a, question, clearance, walk) || hit(b, at_b, question, clearance, walk)) return Verdict::hit;
      } else if (hit(a, bounds(field, a.level, a.centres), question, clearance, walk)) {
        return Verdict::hit;
      }
    }
    walk.clearance = V::least(clearance);
    return walk.depth > 0 || walk.piece_count > 0 ? Verdict::undecided : Verdict::free;
  }

  /// Separating axes along the normals of both boxes' faces, in the target's frame.
  static std::uint32_t near(const PoseBlock& body_pose, const Extent& body, const Placement& target_from_base,
                            const Extent& target, float reach) {
    F rotation[9], centre[3];
    std::uint32_t result = 0xffffu;
    for (int row = 0; row < 3; ++row) {
      const float* r = target_from_base.rotation + 3 * row;
      const F a = V::set(r[0]), b = V::set(r[1]), c = V::set(r[2]);
      const auto product = [&](const float(&x)[lanes], const float(&y)[lanes], const float(&z)[lanes]) {
        return V::add(V::add(V::mul(a, V::load(x)), V::mul(b, V::load(y))), V::mul(c, V::load(z)));
      };
      F wide = V::set(target.half[row] + reach);
      centre[row] = V::add(product(body_pose.translation[0], body_pose.translation[1], body_pose.translation[2]),
                           V::set(target_from_base.translation[row] - target.centre[row]));
      for (int column = 0; column < 3; ++column) {
        F& entry = rotation[3 * row + column];
        entry = product(body_pose.rotation[column], body_pose.rotation[3 + column], body_pose.rotation[6 + column]);
        centre[row] = V::add(centre[row], V::mul(entry, V::set(body.centre[column])));
        wide = V::add(wide, V::mul(V::magnitude(entry), V::set(body.half[column])));
      }
      result &= V::less_equal(V::magnitude(centre[row]), wide);
      if (result == 0) return 0;
    }
    for (int column = 0; column < 3; ++column) {
      F wide = V::set(body.half[column] + reach), along = V::set(0.0f);
      for (int row = 0; row < 3; ++row) {
        wide = V::add(wide, V::mul(V::magnitude(rotation[3 * row + column]), V::set(target.half[row])));
        along = V::add(along, V::mul(rotation[3 * row + column], centre[row]));
      }
      result &= V::less_equal(V::magnitude(along), wide);
    }
    return result;
  }

  static Facet placed(const Placement& p, const Facet& facet) {
    Facet result;
    const auto turned = [&p](const float* v, int row) {
      const float* r = p.rotation + 3 * row;
      return r[0] * v[0] + r[1] * v[1] + r[2] * v[2];
    };
    for (int row = 0; row < 3; ++row) {
      for (int k = 0; k < 3; ++k) result.corner[k][row] = turned(facet.corner[k], row) + p.translation[row];
      for (int k = 0; k < Facet::planes; ++k) result.plane[k][row] = turned(facet.plane[k], row);
    }
    for (int k = 0; k < Facet::planes; ++k) {
      const float* n = result.plane[k];
      result.plane[k][3] =
          facet.plane[k][3] + n[0] * p.translation[0] + n[1] * p.translation[1] + n[2] * p.translation[2];
    }
    return result;
  }

  struct Span {
    F low, high;
  };

  /// How far the corners of triangles are beyond a plane each, at the least and at the most.
  static Span beyond(const F (&plane)[4], const F (&corner)[3][3]) {
    F at[3];
    for (int k = 0; k < 3; ++k)
      at[k] = V::sub(V::add(V::add(V::mul(plane[0], corner[k][0]), V::mul(plane[1], corner[k][1])),
                            V::mul(plane[2], corner[k][2])),
                     plane[3]);
    return {V::min(V::min(at[0], at[1]), at[2]), V::max(V::max(at[0], at[1]), at[2])};
  }

  static std::uint32_t facets_near(const Facet& facet, const Placement& placement, const FacetBlock& target,
                                   float reach) {
    const Facet ours = placed(placement, facet);
    F our_corner[3][3], corner[3][3];
    for (int k = 0; k < 3; ++k)
      for (int d = 0; d < 3; ++d) {
        our_corner[k][d] = V::set(ours.corner[k][d]);
        corner[k][d] = V::load(target.corner[k][d]);
      }
    const F most = V::set(reach), least = V::set(-reach);
    std::uint32_t near = 0xffffu;
    for (int k = 0; k < Facet::planes && near != 0; ++k) {
      const F plane[4] = {V::load(target.plane[k][0]), V::load(target.plane[k][1]), V::load(target.plane[k][2]),
                          V::load(target.plane[k][3])};
      const float* p = ours.plane[k];
      const F our_plane[4] = {V::set(p[0]), V::set(p[1]), V::set(p[2]), V::set(p[3])};
      const Span us = beyond(plane, our_corner), them = beyond(our_plane, corner);
      near &= V::less_equal(us.low, most) & V::less_equal(them.low, most);
      if (k == 0) near &= V::less_equal(least, us.high) & V::less_equal(least, them.high);
    }
    return near;
  }
};

}  // namespace tactus::contact::kernel
