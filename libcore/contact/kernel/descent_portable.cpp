// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "contact/kernel/descent.inl.hpp"

namespace tactus::contact::kernel {
namespace {

struct Portable {
  struct F {
    float v[lanes];
  };
  struct I {
    std::int32_t v[lanes];
  };

  template <typename Work>
  static F each(Work work) {
    F r;
    for (int i = 0; i < lanes; ++i) r.v[i] = work(i);
    return r;
  }
  template <typename Work>
  static I each_int(Work work) {
    I r;
    for (int i = 0; i < lanes; ++i) r.v[i] = work(i);
    return r;
  }
  template <typename Test>
  static std::uint32_t mask(Test test) {
    std::uint32_t m = 0;
    for (int i = 0; i < lanes; ++i) m |= static_cast<std::uint32_t>(test(i)) << i;
    return m;
  }

  static F set(float a) {
    return each([&](int) { return a; });
  }
  static F load(const float* p) {
    return each([&](int i) { return p[i]; });
  }
  static void store(float* p, const F& a) {
    for (int i = 0; i < lanes; ++i) p[i] = a.v[i];
  }
  static F add(const F& a, const F& b) {
    return each([&](int i) { return a.v[i] + b.v[i]; });
  }
  static F sub(const F& a, const F& b) {
    return each([&](int i) { return a.v[i] - b.v[i]; });
  }
  static F mul(const F& a, const F& b) {
    return each([&](int i) { return a.v[i] * b.v[i]; });
  }
  static F min(const F& a, const F& b) {
    return each([&](int i) { return a.v[i] < b.v[i] ? a.v[i] : b.v[i]; });
  }
  static F max(const F& a, const F& b) {
    return each([&](int i) { return a.v[i] > b.v[i] ? a.v[i] : b.v[i]; });
  }
  static F magnitude(const F& a) {
    return each([&](int i) { return std::fabs(a.v[i]); });
  }
  static F sqrt(const F& a) {
    return each([&](int i) { return std::sqrt(a.v[i]); });
  }
  static F floor(const F& a) {
    return each([&](int i) { return std::floor(a.v[i]); });
  }
  static std::uint32_t less(const F& a, const F& b) {
    return mask([&](int i) { return a.v[i] < b.v[i]; });
  }
  static std::uint32_t less_equal(const F& a, const F& b) {
    return mask([&](int i) { return a.v[i] <= b.v[i]; });
  }
  static F select(std::uint32_t m, const F& a, const F& b) {
    return each([&](int i) { return (m >> i & 1u) != 0 ? a.v[i] : b.v[i]; });
  }
  static float least(const F& a) {
    float r = a.v[0];
    for (int i = 1; i < lanes; ++i) r = a.v[i] < r ? a.v[i] : r;
    return r;
  }
  static I set_int(std::int32_t a) {
    return each_int([&](int) { return a; });
  }
  static I load_int(const std::int32_t* p) {
    return each_int([&](int i) { return p[i]; });
  }
  static I add_int(const I& a, const I& b) {
    return each_int([&](int i) { return a.v[i] + b.v[i]; });
  }
  static I sub_int(const I& a, const I& b) {
    return each_int([&](int i) { return a.v[i] - b.v[i]; });
  }
  static I mul_int(const I& a, const I& b) {
    return each_int([&](int i) { return a.v[i] * b.v[i]; });
  }
  static I to_int(const F& a) {
    return each_int([&](int i) { return static_cast<std::int32_t>(a.v[i]); });
  }
  static std::uint32_t negative(const I& a) {
    return mask([&](int i) { return a.v[i] < 0; });
  }
  static void compress(std::int32_t* p, std::uint32_t m, const I& a) {
    for (; m != 0; m &= m - 1) *p++ = a.v[__builtin_ctz(m)];
  }
  static F gather(const std::int16_t* base, const I& index) {
    return each([&](int i) { return static_cast<float>(base[index.v[i]]); });
  }
};

}  // namespace

const Kernel portable{"portable",           [] { return true; },        Over<Portable>::walk, Over<Portable>::measure,
                      Over<Portable>::near, Over<Portable>::facets_near};

}  // namespace tactus::contact::kernel
