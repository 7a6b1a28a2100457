// SPDX-License-Identifier: BSD-3-Clause
#include <immintrin.h>

#include "contact/kernel/voxels.inl.hpp"

namespace tactus::contact::kernel {
namespace {

struct Avx512Voxels {
  static constexpr int width = 16;
  using F = __m512;
  using I = __m512i;

  static F set(float a) { return _mm512_set1_ps(a); }
  static F load(const float* p) { return _mm512_loadu_ps(p); }
  static void store(float* p, F a) { _mm512_storeu_ps(p, a); }
  static F add(F a, F b) { return _mm512_add_ps(a, b); }
  static F sub(F a, F b) { return _mm512_sub_ps(a, b); }
  static F mul(F a, F b) { return _mm512_mul_ps(a, b); }
  static F min(F a, F b) { return _mm512_min_ps(a, b); }
  static F max(F a, F b) { return _mm512_max_ps(a, b); }
  static F sqrt(F a) { return _mm512_sqrt_ps(a); }
  static float least(F a) { return _mm512_reduce_min_ps(a); }
  static std::uint32_t less(F a, F b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
  static F select(std::uint32_t m, F a, F b) { return _mm512_mask_blend_ps(static_cast<__mmask16>(m), b, a); }
  static I set_int(std::int32_t a) { return _mm512_set1_epi32(a); }
  static I add_int(I a, I b) { return _mm512_add_epi32(a, b); }
  static I mul_int(I a, I b) { return _mm512_mullo_epi32(a, b); }
  static I to_int(F a) { return _mm512_cvttps_epi32(a); }
  static F to_float(I a) { return _mm512_cvtepi32_ps(a); }
  static F gather(const float* base, I index) { return _mm512_i32gather_ps(index, base, 4); }
};

bool supported() { return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("popcnt"); }

}  // namespace

constinit const VoxelKernel voxels_avx512 = VoxelsOver<Avx512Voxels>::kernel("avx512", &supported);

}  // namespace tactus::contact::kernel
