// SPDX-License-Identifier: BSD-3-Clause
#include "contact/kernel/voxels.hpp"

namespace tactus::contact::kernel {

const VoxelKernel* const* voxel_kernels() {
#ifdef TACTUS_X86
  static constexpr const VoxelKernel* all[] = {&voxels_avx512, &voxels_avx2, &voxels_sse41, &voxels_portable, nullptr};
#else
  static constexpr const VoxelKernel* all[] = {&voxels_portable, nullptr};
#endif
  return all;
}

const VoxelKernel& fastest_voxel_kernel() {
  static const VoxelKernel* const fastest = [] {
    const VoxelKernel* const* kernel = voxel_kernels();
    while (!(*kernel)->supported()) ++kernel;
    return *kernel;
  }();
  return *fastest;
}

}  // namespace tactus::contact::kernel
