// SPDX-License-Identifier: BSD-3-Clause
#include <smmintrin.h>

#include "contact/kernel/voxels.inl.hpp"

namespace tactus::contact::kernel {
namespace {

struct Sse41Voxels {
  static constexpr int width = 4;
  using F = __m128;
  using I = __m128i;

  static F set(float a) { return _mm_set1_ps(a); }
  static F load(const float* p) { return _mm_loadu_ps(p); }
  static void store(float* p, F a) { _mm_storeu_ps(p, a); }
  static F add(F a, F b) { return _mm_add_ps(a, b); }
  static F sub(F a, F b) { return _mm_sub_ps(a, b); }
  static F mul(F a, F b) { return _mm_mul_ps(a, b); }
  static F min(F a, F b) { return _mm_min_ps(a, b); }
  static F max(F a, F b) { return _mm_max_ps(a, b); }
  static F sqrt(F a) { return _mm_sqrt_ps(a); }
  static float least(F a) {
    const F half = _mm_min_ps(a, _mm_movehl_ps(a, a));
    return _mm_cvtss_f32(_mm_min_ss(half, _mm_shuffle_ps(half, half, 1)));
  }
  static std::uint32_t less(F a, F b) { return static_cast<std::uint32_t>(_mm_movemask_ps(_mm_cmplt_ps(a, b))); }
  static F select(std::uint32_t m, F a, F b) {
    const I lane = _mm_setr_epi32(1, 2, 4, 8);
    const I chosen = _mm_cmpeq_epi32(_mm_and_si128(set_int(static_cast<std::int32_t>(m)), lane), lane);
    return _mm_blendv_ps(b, a, _mm_castsi128_ps(chosen));
  }
  static I set_int(std::int32_t a) { return _mm_set1_epi32(a); }
  static I add_int(I a, I b) { return _mm_add_epi32(a, b); }
  static I mul_int(I a, I b) { return _mm_mullo_epi32(a, b); }
  static I to_int(F a) { return _mm_cvttps_epi32(a); }
  static F to_float(I a) { return _mm_cvtepi32_ps(a); }
  static F gather(const float* base, I index) {
    return _mm_setr_ps(base[_mm_extract_epi32(index, 0)], base[_mm_extract_epi32(index, 1)],
                       base[_mm_extract_epi32(index, 2)], base[_mm_extract_epi32(index, 3)]);
  }
};

bool supported() { return __builtin_cpu_supports("sse4.1") && __builtin_cpu_supports("popcnt"); }

}  // namespace

constinit const VoxelKernel voxels_sse41 = VoxelsOver<Sse41Voxels>::kernel("sse4.1", &supported);

}  // namespace tactus::contact::kernel
