// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

/// The inner loops of swept voxels at the machine's width. What they read and write is plain data: these files see no
/// Eigen, FCL or standard container, so that each may be compiled for its own instructions. All kernels do the same
/// IEEE operations in the same order and give the same bits.
namespace tactus::contact::kernel {

/// Neighbouring voxels of a layer (one z of a grid) that are looked at together, along x and on into the next rows.
inline constexpr int voxels_per_block = 16;

/// Columns of a grid that are transformed together.
inline constexpr int columns_per_batch = 32;

/// The square of a distance, in voxels, to what there is none of: no less than this.
inline constexpr float no_member = 1e12f;

/// Samples of a signed distance on a lattice, x fastest. Places are in units of its spacing from the first sample.
struct VoxelField {
  const float* samples;           ///< m
  float last[3];                  ///< place of the last sample
  std::int32_t stride[3];         ///< between neighbouring samples
  float spacing;                  ///< m
  float box_low[3], box_high[3];  ///< place of the surface's box
};

/// A grid in the frame of a field at a waypoint: where voxel (x, y, z) is.
struct GridPlace {
  float first[3];                            ///< place of the centre of voxel (0, 0, 0)
  float along_x[3], along_y[3], along_z[3];  ///< from one voxel to the next
  float slack;                               ///< m that rounding may be wrong by
};

/// What is known of a grid's blocks. Those of a layer follow those of the layer below it.
struct VoxelBlocks {
  std::int32_t per_layer;
  const float *x, *y;   ///< coordinates by voxel of a layer, padded to whole blocks
  std::uint16_t* open;  ///< by block: its voxels that have not been entered
  float* due;           ///< by block: how far the body travels before it may enter an open one, m; sixteen more at the
                        ///< end are readable
};

/// The blocks [begin, end) of each of the layers [low, high).
struct BlockRange {
  std::int32_t low, high, begin, end;
};

/// A block with voxels whose centres are inside, or may be.
struct BlockFound {
  std::int32_t block;
  std::uint16_t inside, undecided;  ///< open voxels
};

struct VoxelKernel {
  const char* name;

  /// Whether the machine has the instructions.
  bool (*supported)();

  /// Looks those blocks up whose time has come when the body has travelled this far (m), and says when they are due
  /// again. What is found inside is no longer open. Returns how many blocks were `found`, at most those of the range.
  std::int32_t (*look)(const VoxelField& field, const GridPlace& place, const VoxelBlocks& blocks,
                       const BlockRange& range, float travelled, BlockFound* found);

  /// nearest[i] = min over k of squared[k] + (i - k)^2 in every one of `columns_per_batch` columns of `length`, row by
  /// row. O(length) where all are near; at worst O(length) for each row between the first and the last with a member.
  void (*nearest)(const float* squared, std::int32_t length, float* nearest);
};

extern const VoxelKernel voxels_portable;
#ifdef TACTUS_X86
extern const VoxelKernel voxels_sse41, voxels_avx2, voxels_avx512;
#endif

/// All that were built, the widest first; null at the end.
const VoxelKernel* const* voxel_kernels();

/// The widest that the machine has.
const VoxelKernel& fastest_voxel_kernel();

}  // namespace tactus::contact::kernel
