// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

/// The inner loops of contact prediction at the machine's width. What they read and write is plain data: these files
/// see no Eigen, FCL or standard container, so that each may be compiled for its own instructions. All kernels do the
/// same IEEE operations in the same order and give the same bits.
namespace tactus::contact::kernel {

inline constexpr int lanes = 16;

/// Sixteen parts of a surface, each in a ball and in a box about the same centre, and each made of the parts of a
/// further block or a single piece. A lane that holds none has halves and a core of `no_part`.
struct alignas(64) Block {
  float centre[3][lanes];  ///< m, in the body's frame
  float radius[lanes];     ///< m
  float core[lanes];       ///< m: the body's solid holds a ball of this radius about the centre; where it is negative,
                           ///< a point of the surface is no farther than that from the centre
  float half[3][lanes];    ///< m: half the sides of the box, along the body's axes
  std::int32_t next[lanes];  ///< of a block its `link`; of a piece the complement of its index
};
inline constexpr float no_part = -1e30f;
inline constexpr float none_above = 1e30f;  ///< m: a clearance before anything has been passed over

/// Samples of a signed distance on a lattice, x fastest, in units of the field's quantum.
struct Lattice {
  const std::int16_t* samples;  ///< one more than there are is readable
  float origin[3];              ///< m
  float spacing, inverse_spacing;
  float last[3];  ///< index of the last sample
  std::int32_t stride[3];
};

/// A signed distance, sampled ever more coarsely: large parts of a surface need no fine samples, and coarse ones stay
/// near the processor.
struct Field {
  static constexpr int levels = 3;

  Lattice lattices[levels];          ///< the finest first
  float quantum;                     ///< m
  float box_centre[3], box_half[3];  ///< m, of the surface
  float slack;                       ///< m that rounding may be wrong by
};

/// A block and the level of the field that is fine enough for it, in one number.
constexpr std::int32_t link(std::int32_t block, int level) { return block * 4 + level; }

/// target_from_body: the rotation row by row, and the translation in metres.
struct Placement {
  float rotation[9];
  float translation[3];
};

/// What is asked of a tree of balls at a placement: does its surface come closer than `threshold` to the target's, or
/// does (threshold < 0) a point of it lie deeper than that?
struct Question {
  float threshold;   ///< m
  float detail;      ///< m: balls smaller than this are not gone into
  bool errs_to_hit;  ///< they are taken for a hit, and pieces for their balls; else for none, and for their centres
};

enum class Verdict : std::int32_t { free, hit, undecided };

/// A walk through a tree that can be resumed: `stack` links to the blocks still to be looked at. While
/// `Verdict::undecided` comes back, the pieces listed have to be decided by their triangles; if `depth` is not 0 the
/// walk then goes on when called again.
struct Walk {
  static constexpr int most_pieces = 64;
  static constexpr int most_blocks = 256;  ///< for trees of 9 levels, two blocks looked at together

  std::int32_t stack[most_blocks + lanes];  ///< sixteen are written at once, of which some may not count
  std::int32_t depth;
  std::int32_t pieces[most_pieces];
  std::int32_t piece_count;
  float clearance;  ///< m above the threshold of all that has been passed over: pieces listed don't count

  void start(std::int32_t root) {
    stack[0] = root;
    depth = 1;
    piece_count = 0;
    clearance = none_above;
  }
};

/// The poses of a body at sixteen waypoints, waypoint by lane.
struct alignas(64) PoseBlock {
  float rotation[9][lanes];
  float translation[3][lanes];
};

/// A box in the frame of what it belongs to.
struct Extent {
  float centre[3], half[3];  ///< m
};

/// A triangle and planes that it does not reach beyond: its own, of which both sides count, and those that stand on its
/// edges. A plane is a unit normal and its offset in metres; one of zeros parts nothing.
struct Facet {
  static constexpr int planes = 4;

  float corner[3][3];
  float plane[planes][4];
};

/// Sixteen facets. A lane that holds none has a first plane that all lies beyond.
struct alignas(64) FacetBlock {
  float corner[3][3][lanes];
  float plane[Facet::planes][4][lanes];
};
inline constexpr float beyond_all = -1e30f;  ///< the offset of such a plane

struct Kernel {
  const char* name;

  /// Whether the machine has the instructions.
  bool (*supported)();

  /// Goes on with a walk.
  Verdict (*walk)(const Block* blocks, const Field& field, const Placement& target_from_body, const Question& question,
                  Walk& walk);

  /// Bounds of the distance at the centres of a block's parts, on the finest lattice.
  void (*measure)(const Block& block, const Field& field, const Placement& target_from_body, float lower[lanes],
                  float upper[lanes]);

  /// By lane whether the body's box is within `reach` m of the target's, or can't be told apart from that by the faces'
  /// normals.
  std::uint32_t (*near)(const PoseBlock& base_from_body, const Extent& body, const Placement& target_from_base,
                        const Extent& target, float reach);

  /// By lane whether a facet of the target may be within `reach` m of a body's: not if a plane of either parts them.
  std::uint32_t (*facets_near)(const Facet& facet, const Placement& target_from_body, const FacetBlock& target,
                               float reach);
};

extern const Kernel portable;
#ifdef TACTUS_X86
extern const Kernel sse41, avx2, avx512;
#endif

/// All that were built, the widest first; null at the end.
const Kernel* const* kernels();

/// The widest that the machine has.
const Kernel& fastest();

}  // namespace tactus::contact::kernel
