// SPDX-License-Identifier: BSD-3-Clause
#include <immintrin.h>

#include "contact/kernel/voxels.inl.hpp"

namespace tactus::contact::kernel {
namespace {

struct Avx2Voxels {
  static constexpr int width = 8;
  using F = __m256;
  using I = __m256i;

  static F set(float a) { return _mm256_set1_ps(a); }
  static F load(const float* p) { return _mm256_loadu_ps(p); }
  static void store(float* p, F a) { _mm256_storeu_ps(p, a); }
  static F add(F a, F b) { return _mm256_add_ps(a, b); }
  static F sub(F a, F b) { return _mm256_sub_ps(a, b); }
  static F mul(F a, F b) { return _mm256_mul_ps(a, b); }
  static F min(F a, F b) { return _mm256_min_ps(a, b); }
  static F max(F a, F b) { return _mm256_max_ps(a, b); }
  static F sqrt(F a) { return _mm256_sqrt_ps(a); }
  static float least(F a) {
    __m128 half = _mm_min_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
    half = _mm_min_ps(half, _mm_movehl_ps(half, half));
    return _mm_cvtss_f32(_mm_min_ss(half, _mm_shuffle_ps(half, half, 1)));
  }
  static std::uint32_t less(F a, F b) {
    return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LT_OQ)));
  }
  static F select(std::uint32_t m, F a, F b) {
    const I lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    const I chosen = _mm256_cmpeq_epi32(_mm256_and_si256(set_int(static_cast<std::int32_t>(m)), lane), lane);
    return _mm256_blendv_ps(b, a, _mm256_castsi256_ps(chosen));
  }
  static I set_int(std::int32_t a) { return _mm256_set1_epi32(a); }
  static I add_int(I a, I b) { return _mm256_add_epi32(a, b); }
  static I mul_int(I a, I b) { return _mm256_mullo_epi32(a, b); }
  static I to_int(F a) { return _mm256_cvttps_epi32(a); }
  static F to_float(I a) { return _mm256_cvtepi32_ps(a); }
  static F gather(const float* base, I index) { return _mm256_i32gather_ps(base, index, 4); }
};

bool supported() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("popcnt"); }

}  // namespace

constinit const VoxelKernel voxels_avx2 = VoxelsOver<Avx2Voxels>::kernel("avx2", &supported);

}  // namespace tactus::contact::kernel
