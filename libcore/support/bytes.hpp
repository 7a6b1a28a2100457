// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tactus::support {

/// What a saved object begins with: eight letters that say what it is, and the version of its layout.
struct Seal {
  std::array<char, 8> magic;
  std::uint32_t version;
};

/// Writes a saved object, little-endian on every machine: magic, version, length of the content, content, checksum.
class ByteWriter {
 public:
  explicit ByteWriter(const Seal& seal);

  void u8(std::uint8_t value) { bytes_.push_back(value); }
  void u32(std::uint32_t value) { put(value, 4); }
  void u64(std::uint64_t value) { put(value, 8); }
  void f64(double value);

  /// Fills in the length, adds the checksum and gives the bytes away.
  std::vector<std::uint8_t> sealed();

 private:
  void put(std::uint64_t value, int count);

  std::vector<std::uint8_t> bytes_;
};

/// Reads what a `ByteWriter` wrote. Every read is checked against the end of the content, so that no bytes whatever
/// make it read beyond, and every count against what is left, so that none makes the caller allocate more than a small
/// multiple of the input.
///
/// Throws `bad_saved_state` with the object's name and the field at fault. The bytes must outlive the reader.
class ByteReader {
 public:
  /// Checks magic, version, length and checksum. `object` is named in errors ("saved belief").
  ByteReader(const Seal& seal, const char* object, const std::uint8_t* bytes, std::size_t size);

  std::uint8_t u8(const char* field) { return static_cast<std::uint8_t>(get(1, field)); }
  std::uint32_t u32(const char* field) { return static_cast<std::uint32_t>(get(4, field)); }
  std::uint64_t u64(const char* field) { return get(8, field); }
  double f64(const char* field);     ///< any bits
  double finite(const char* field);  ///< neither infinite nor a NaN
  bool flag(const char* field);      ///< 0 or 1

  /// A number of things that take `bytes_each` (>= 1) or more bytes of content each.
  std::size_t count(std::size_t bytes_each, const char* field);

  /// All of the content must have been read.
  void finish() const;

  /// Throws: `field` is not as it must be.
  [[noreturn]] void fail(const char* field, const std::string& found, const std::string& expected) const;

 private:
  std::uint64_t get(std::size_t count, const char* field);

  const char* object_;
  const std::uint8_t* at_;
  const std::uint8_t* end_;
};

/// A 64-bit hash of bytes, the same on every machine. Differs for inputs of one length that differ in one word of eight
/// bytes.
std::uint64_t checksum(const std::uint8_t* bytes, std::size_t size);

}  // namespace tactus::support
