// SPDX-License-Identifier: BSD-3-Clause
#include <immintrin.h>

#include "contact/kernel/descent.inl.hpp"

namespace tactus::contact::kernel {
namespace {

struct Avx2 {
  struct F {
    __m256 low, high;
  };
  struct I {
    __m256i low, high;
  };

  static std::uint32_t mask(__m256 low, __m256 high) {
    return static_cast<std::uint32_t>(_mm256_movemask_ps(low)) | static_cast<std::uint32_t>(_mm256_movemask_ps(high))
                                                                     << 8;
  }

  static F set(float a) { return {_mm256_set1_ps(a), _mm256_set1_ps(a)}; }
  static F load(const float* p) { return {_mm256_load_ps(p), _mm256_load_ps(p + 8)}; }
  static void store(float* p, const F& a) {
    _mm256_storeu_ps(p, a.low);
    _mm256_storeu_ps(p + 8, a.high);
  }
  static F add(const F& a, const F& b) { return {_mm256_add_ps(a.low, b.low), _mm256_add_ps(a.high, b.high)}; }
  static F sub(const F& a, const F& b) { return {_mm256_sub_ps(a.low, b.low), _mm256_sub_ps(a.high, b.high)}; }
  static F mul(const F& a, const F& b) { return {_mm256_mul_ps(a.low, b.low), _mm256_mul_ps(a.high, b.high)}; }
  static F min(const F& a, const F& b) { return {_mm256_min_ps(a.low, b.low), _mm256_min_ps(a.high, b.high)}; }
  static F max(const F& a, const F& b) { return {_mm256_max_ps(a.low, b.low), _mm256_max_ps(a.high, b.high)}; }
  static __m256 magnitude(__m256 a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a); }
  static F magnitude(const F& a) { return {magnitude(a.low), magnitude(a.high)}; }
  static F sqrt(const F& a) { return {_mm256_sqrt_ps(a.low), _mm256_sqrt_ps(a.high)}; }
  static F floor(const F& a) { return {_mm256_floor_ps(a.low), _mm256_floor_ps(a.high)}; }
  static std::uint32_t less(const F& a, const F& b) {
    return mask(_mm256_cmp_ps(a.low, b.low, _CMP_LT_OQ), _mm256_cmp_ps(a.high, b.high, _CMP_LT_OQ));
  }
  static std::uint32_t less_equal(const F& a, const F& b) {
    return mask(_mm256_cmp_ps(a.low, b.low, _CMP_LE_OQ), _mm256_cmp_ps(a.high, b.high, _CMP_LE_OQ));
  }
  static __m256 spread(std::uint32_t m) {
    const __m256i bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    return _mm256_castsi256_ps(
        _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(static_cast<std::int32_t>(m)), bits), bits));
  }
  static F select(std::uint32_t m, const F& a, const F& b) {
    return {_mm256_blendv_ps(b.low, a.low, spread(m)), _mm256_blendv_ps(b.high, a.high, spread(m >> 8))};
  }
  static float least(const F& a) {
    alignas(32) float v[8];
    _mm256_store_ps(v, _mm256_min_ps(a.low, a.high));
    for (int i = 1; i < 8; ++i) v[0] = v[i] < v[0] ? v[i] : v[0];
    return v[0];
  }
  static I set_int(std::int32_t a) { return {_mm256_set1_epi32(a), _mm256_set1_epi32(a)}; }
  static I load_int(const std::int32_t* p) {
    const auto* blocks = reinterpret_cast<const __m256i*>(p);
    return {_mm256_load_si256(blocks), _mm256_load_si256(blocks + 1)};
  }
  static I add_int(const I& a, const I& b) {
    return {_mm256_add_epi32(a.low, b.low), _mm256_add_epi32(a.high, b.high)};
  }
  static I sub_int(const I& a, const I& b) {
    return {_mm256_sub_epi32(a.low, b.low), _mm256_sub_epi32(a.high, b.high)};
  }
  static I mul_int(const I& a, const I& b) {
    return {_mm256_mullo_epi32(a.low, b.low), _mm256_mullo_epi32(a.high, b.high)};
  }
  static I to_int(const F& a) { return {_mm256_cvttps_epi32(a.low), _mm256_cvttps_epi32(a.high)}; }
  static std::uint32_t negative(const I& a) { return mask(_mm256_castsi256_ps(a.low), _mm256_castsi256_ps(a.high)); }
  static void compress(std::int32_t* p, std::uint32_t m, const I& a) {
    alignas(32) std::int32_t v[lanes];
    _mm256_store_si256(reinterpret_cast<__m256i*>(v), a.low);
    _mm256_store_si256(reinterpret_cast<__m256i*>(v + 8), a.high);
    for (; m != 0; m &= m - 1) *p++ = v[__builtin_ctz(m)];
  }
  static __m256 gather(const std::int16_t* base, __m256i index) {
    const __m256i pairs = _mm256_i32gather_epi32(reinterpret_cast<const int*>(base), index, 2);
    return _mm256_cvtepi32_ps(_mm256_srai_epi32(_mm256_slli_epi32(pairs, 16), 16));
  }
  static F gather(const std::int16_t* base, const I& index) {
    return {gather(base, index.low), gather(base, index.high)};
  }
};

}  // namespace

const Kernel avx2{"avx2",           [] { return __builtin_cpu_supports("avx2") != 0; },
                  Over<Avx2>::walk, Over<Avx2>::measure,
                  Over<Avx2>::near, Over<Avx2>::facets_near};

}  // namespace tactus::contact::kernel
