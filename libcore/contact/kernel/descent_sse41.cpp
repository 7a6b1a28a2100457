// SPDX-License-Identifier: BSD-3-Clause
#include <immintrin.h>

#include "contact/kernel/descent.inl.hpp"

namespace tactus::contact::kernel {
namespace {

struct Sse41 {
  static constexpr int parts = 4;
  struct F {
    __m128 v[parts];
  };
  struct I {
    __m128i v[parts];
  };

  template <typename Work>
  static F each(Work work) {
    return {{work(0), work(1), work(2), work(3)}};
  }
  template <typename Work>
  static I each_int(Work work) {
    return {{work(0), work(1), work(2), work(3)}};
  }
  template <typename Work>
  static std::uint32_t mask(Work work) {
    std::uint32_t m = 0;
    for (int k = 0; k < parts; ++k) m |= static_cast<std::uint32_t>(_mm_movemask_ps(work(k))) << 4 * k;
    return m;
  }

  static F set(float a) {
    return each([&](int) { return _mm_set1_ps(a); });
  }
  static F load(const float* p) {
    return each([&](int k) { return _mm_load_ps(p + 4 * k); });
  }
  static void store(float* p, const F& a) {
    for (int k = 0; k < parts; ++k) _mm_storeu_ps(p + 4 * k, a.v[k]);
  }
  static F add(const F& a, const F& b) {
    return each([&](int k) { return _mm_add_ps(a.v[k], b.v[k]); });
  }
  static F sub(const F& a, const F& b) {
    return each([&](int k) { return _mm_sub_ps(a.v[k], b.v[k]); });
  }
  static F mul(const F& a, const F& b) {
    return each([&](int k) { return _mm_mul_ps(a.v[k], b.v[k]); });
  }
  static F min(const F& a, const F& b) {
    return each([&](int k) { return _mm_min_ps(a.v[k], b.v[k]); });
  }
  static F max(const F& a, const F& b) {
    return each([&](int k) { return _mm_max_ps(a.v[k], b.v[k]); });
  }
  static F magnitude(const F& a) {
    return each([&](int k) { return _mm_andnot_ps(_mm_set1_ps(-0.0f), a.v[k]); });
  }
  static F sqrt(const F& a) {
    return each([&](int k) { return _mm_sqrt_ps(a.v[k]); });
  }
  static F floor(const F& a) {
    return each([&](int k) { return _mm_floor_ps(a.v[k]); });
  }
  static std::uint32_t less(const F& a, const F& b) {
    return mask([&](int k) { return _mm_cmplt_ps(a.v[k], b.v[k]); });
  }
  static std::uint32_t less_equal(const F& a, const F& b) {
    return mask([&](int k) { return _mm_cmple_ps(a.v[k], b.v[k]); });
  }
  static __m128 spread(std::uint32_t m) {
    const __m128i bits = _mm_setr_epi32(1, 2, 4, 8);
    return _mm_castsi128_ps(_mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32(static_cast<std::int32_t>(m)), bits), bits));
  }
  static F select(std::uint32_t m, const F& a, const F& b) {
    return each([&](int k) { return _mm_blendv_ps(b.v[k], a.v[k], spread(m >> 4 * k)); });
  }
  static float least(const F& a) {
    alignas(16) float v[4];
    _mm_store_ps(v, _mm_min_ps(_mm_min_ps(a.v[0], a.v[1]), _mm_min_ps(a.v[2], a.v[3])));
    for (int i = 1; i < 4; ++i) v[0] = v[i] < v[0] ? v[i] : v[0];
    return v[0];
  }
  static I set_int(std::int32_t a) {
    return each_int([&](int) { return _mm_set1_epi32(a); });
  }
  static I load_int(const std::int32_t* p) {
    return each_int([&](int k) { return _mm_load_si128(reinterpret_cast<const __m128i*>(p) + k); });
  }
  static I add_int(const I& a, const I& b) {
    return each_int([&](int k) { return _mm_add_epi32(a.v[k], b.v[k]); });
  }
  static I sub_int(const I& a, const I& b) {
    return each_int([&](int k) { return _mm_sub_epi32(a.v[k], b.v[k]); });
  }
  static I mul_int(const I& a, const I& b) {
    return each_int([&](int k) { return _mm_mullo_epi32(a.v[k], b.v[k]); });
  }
  static I to_int(const F& a) {
    return each_int([&](int k) { return _mm_cvttps_epi32(a.v[k]); });
  }
  static std::uint32_t negative(const I& a) {
    return mask([&](int k) { return _mm_castsi128_ps(a.v[k]); });
  }
  static void compress(std::int32_t* p, std::uint32_t m, const I& a) {
    alignas(16) std::int32_t v[lanes];
    for (int k = 0; k < parts; ++k) _mm_store_si128(reinterpret_cast<__m128i*>(v) + k, a.v[k]);
    for (; m != 0; m &= m - 1) *p++ = v[__builtin_ctz(m)];
  }
  static F gather(const std::int16_t* base, const I& index) {
    alignas(16) std::int32_t at[lanes];
    for (int k = 0; k < parts; ++k) _mm_store_si128(reinterpret_cast<__m128i*>(at) + k, index.v[k]);
    return each([&](int k) {
      const std::int32_t* i = at + 4 * k;
      return _mm_cvtepi32_ps(_mm_setr_epi32(base[i[0]], base[i[1]], base[i[2]], base[i[3]]));
    });
  }
};

}  // namespace

const Kernel sse41{"sse41",           [] { return __builtin_cpu_supports("sse4.1") != 0; },
                   Over<Sse41>::walk, Over<Sse41>::measure,
                   Over<Sse41>::near, Over<Sse41>::facets_near};

}  // namespace tactus::contact::kernel
