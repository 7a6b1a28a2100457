// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "contact/kernel/voxels.inl.hpp"

namespace tactus::contact::kernel {
namespace {

struct PortableVoxels {
  static constexpr int width = 1;
  using F = float;
  using I = std::int32_t;

  static F set(float a) { return a; }
  static F load(const float* p) { return *p; }
  static void store(float* p, F a) { *p = a; }
  static F add(F a, F b) { return a + b; }
  static F sub(F a, F b) { return a - b; }
  static F mul(F a, F b) { return a * b; }
  static F min(F a, F b) { return a < b ? a : b; }
  static F max(F a, F b) { return a > b ? a : b; }
  static F sqrt(F a) { return std::sqrt(a); }
  static float least(F a) { return a; }
  static std::uint32_t less(F a, F b) { return a < b ? 1U : 0U; }
  static F select(std::uint32_t m, F a, F b) { return m != 0 ? a : b; }
  static I set_int(std::int32_t a) { return a; }
  static I add_int(I a, I b) { return a + b; }
  static I mul_int(I a, I b) { return a * b; }
  static I to_int(F a) { return static_cast<I>(a); }
  static F to_float(I a) { return static_cast<F>(a); }
  static F gather(const float* base, I index) { return base[index]; }
};

bool supported() { return true; }

}  // namespace

constinit const VoxelKernel voxels_portable = VoxelsOver<PortableVoxels>::kernel("portable", &supported);

}  // namespace tactus::contact::kernel
