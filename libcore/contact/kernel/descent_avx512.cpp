// SPDX-License-Identifier: BSD-3-Clause
#include <immintrin.h>

#include "contact/kernel/descent.inl.hpp"

namespace tactus::contact::kernel {
namespace {

struct Avx512 {
  using F = __m512;
  using I = __m512i;

  static F set(float a) { return _mm512_set1_ps(a); }
  static F load(const float* p) { return _mm512_load_ps(p); }
  static void store(float* p, F a) { _mm512_storeu_ps(p, a); }
  static F add(F a, F b) { return _mm512_add_ps(a, b); }
  static F sub(F a, F b) { return _mm512_sub_ps(a, b); }
  static F mul(F a, F b) { return _mm512_mul_ps(a, b); }
  static F min(F a, F b) { return _mm512_min_ps(a, b); }
  static F max(F a, F b) { return _mm512_max_ps(a, b); }
  static F magnitude(F a) { return _mm512_abs_ps(a); }
  static F sqrt(F a) { return _mm512_sqrt_ps(a); }
  static F floor(F a) { return _mm512_roundscale_ps(a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC); }
  static std::uint32_t less(F a, F b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
  static std::uint32_t less_equal(F a, F b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
  static F select(std::uint32_t m, F a, F b) { return _mm512_mask_blend_ps(static_cast<__mmask16>(m), b, a); }
  static float least(F a) { return _mm512_reduce_min_ps(a); }
  static I set_int(std::int32_t a) { return _mm512_set1_epi32(a); }
  static I load_int(const std::int32_t* p) { return _mm512_load_si512(p); }
  static I add_int(I a, I b) { return _mm512_add_epi32(a, b); }
  static I sub_int(I a, I b) { return _mm512_sub_epi32(a, b); }
  static I mul_int(I a, I b) { return _mm512_mullo_epi32(a, b); }
  static I to_int(F a) { return _mm512_cvttps_epi32(a); }
  static std::uint32_t negative(I a) { return _mm512_cmplt_epi32_mask(a, _mm512_setzero_si512()); }
  static void compress(std::int32_t* p, std::uint32_t m, I a) {
    _mm512_storeu_si512(p, _mm512_maskz_compress_epi32(static_cast<__mmask16>(m), a));
  }
  static F gather(const std::int16_t* base, I index) {
    const I pairs = _mm512_i32gather_epi32(index, base, 2);
    return _mm512_cvtepi32_ps(_mm512_srai_epi32(_mm512_slli_epi32(pairs, 16), 16));
  }
};

}  // namespace

const Kernel avx512{"avx512",           [] { return __builtin_cpu_supports("avx512f") != 0; },
                    Over<Avx512>::walk, Over<Avx512>::measure,
                    Over<Avx512>::near, Over<Avx512>::facets_near};

}  // namespace tactus::contact::kernel
