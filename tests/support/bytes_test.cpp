// SPDX-License-Identifier: BSD-3-Clause
#include "support/bytes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/error.hpp"
#include "support/rng.hpp"

namespace tactus::support {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr Seal seal{{'T', 'E', 'S', 'T', 'I', 'N', 'G', '!'}, 3};

Bytes sample() {
  ByteWriter to(seal);
  to.u8(0xab);
  to.u32(0x01020304);
  to.u64(0x0102030405060708);
  to.f64(-0.1);
  to.f64(std::numeric_limits<double>::infinity());
  return to.sealed();
}

ByteReader reader(const Bytes& bytes) { return {seal, "thing", bytes.data(), bytes.size()}; }

template <typename Work>
std::string error_of(Work work) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::bad_saved_state);
    return error.what();
  }
  return "none";
}

TEST(Bytes, ComeBackAsTheyWere) {
  const Bytes bytes = sample();
  ByteReader from = reader(bytes);
  EXPECT_EQ(from.u8("a"), 0xab);
  EXPECT_EQ(from.u32("b"), 0x01020304u);
  EXPECT_EQ(from.u64("c"), 0x0102030405060708u);
  EXPECT_EQ(from.f64("d"), -0.1);
  EXPECT_EQ(from.f64("e"), std::numeric_limits<double>::infinity());
  EXPECT_NO_THROW(from.finish());
}

/// Saved on one machine, restored on another: the layout is written down here.
TEST(Bytes, AreLittleEndianWithMagicVersionAndLengthInFront) {
  const Bytes bytes = sample();
  const Bytes head{'T', 'E', 'S', 'T',  'I', 'N', 'G', '!', 3, 0, 0, 0, 29, 0, 0, 0, 0,
                   0,   0,   0,   0xab, 4,   3,   2,   1,   8, 7, 6, 5, 4,  3, 2, 1};
  ASSERT_EQ(bytes.size(), 20u + 29u + 8u);
  EXPECT_TRUE(std::equal(head.begin(), head.end(), bytes.begin()));
}

TEST(Bytes, AnyOneChangedIsNoticed) {
  const Bytes bytes = sample();
  for (std::size_t at = 0; at < bytes.size(); ++at)
    for (int bit = 0; bit < 8; ++bit) {
      Bytes broken = bytes;
      broken[at] = static_cast<std::uint8_t>(broken[at] ^ (1 << bit));
      EXPECT_NE(error_of([&] { reader(broken); }), "none") << at;
    }
}

TEST(Bytes, MissingOrAddedAreNoticed) {
  const Bytes bytes = sample();
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_NE(error_of([&] { ByteReader(seal, "thing", bytes.data(), size); }), "none") << size;
  Bytes longer = bytes;
  longer.push_back(0);
  EXPECT_NE(error_of([&] { reader(longer); }), "none");
  EXPECT_NE(error_of([&] { ByteReader(seal, "thing", nullptr, 100); }), "none");
}

TEST(Bytes, ErrorsNameTheObjectAndTheField) {
  const Bytes bytes = sample();
  ByteReader from = reader(bytes);
  EXPECT_EQ(error_of([&] { from.flag("contact"); }), "thing: contact: found 171, expected 0 or 1");
  from.u32("b"), from.u64("c"), from.f64("d");
  EXPECT_NE(error_of([&] { from.finite("speed"); }).find("thing: speed: found inf"), std::string::npos);
}

TEST(Bytes, NothingIsReadBeyondTheContent) {
  const Bytes bytes = sample();
  ByteReader from = reader(bytes);
  from.u8("a"), from.u32("b"), from.u64("c"), from.f64("d");
  EXPECT_NE(error_of([&] { from.finish(); }), "none");
  from.f64("e");
  EXPECT_NE(error_of([&] { from.u8("more"); }).find("more"), std::string::npos);
}

TEST(Bytes, CountsAreCheckedAgainstWhatIsLeft) {
  for (const std::uint64_t count : {std::uint64_t{3}, std::uint64_t{4}, UINT64_MAX, UINT64_MAX / 8 + 1}) {
    ByteWriter to(seal);
    to.u64(count);
    for (int i = 0; i < 3; ++i) to.u64(0);
    const Bytes bytes = to.sealed();
    ByteReader from = reader(bytes);
    if (count == 3) {
      EXPECT_EQ(from.count(8, "members"), 3u);
    } else {
      EXPECT_NE(error_of([&] { from.count(8, "members"); }).find("members"), std::string::npos);
    }
  }
}

TEST(Checksum, DependsOnEveryByteAndOnTheLength) {
  Rng rng(1);
  for (std::size_t size = 0; size < 40; ++size) {
    Bytes bytes(size);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(rng.next());
    const std::uint64_t sum = checksum(bytes.data(), size);
    Bytes longer = bytes;
    longer.push_back(0);
    EXPECT_NE(checksum(longer.data(), size + 1), sum);
    for (std::size_t at = 0; at < size; ++at) {
      Bytes other = bytes;
      other[at] = static_cast<std::uint8_t>(other[at] + 1);
      EXPECT_NE(checksum(other.data(), size), sum);
    }
  }
}

}  // namespace
}  // namespace tactus::support
