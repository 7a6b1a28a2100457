// SPDX-License-Identifier: BSD-3-Clause
#include "support/bytes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "support/error.hpp"
#include "support/rng.hpp"

namespace tactus::support {
namespace {

constexpr std::size_t length_at = 12;  // after magic and version
constexpr std::size_t head = length_at + 8;
constexpr std::size_t tail = 8;  // the checksum

std::uint64_t little_endian(const std::uint8_t* bytes, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value |= std::uint64_t{bytes[i]} << (8 * i);
  return value;
}

}  // namespace

std::uint64_t checksum(const std::uint8_t* bytes, std::size_t size) {
  std::uint64_t sum = mix(size);
  for (std::size_t i = 0; i < size; i += 8)
    sum = mix(sum ^ little_endian(bytes + i, std::min<std::size_t>(8, size - i)));
  return sum;
}

ByteWriter::ByteWriter(const Seal& seal) {
  for (const char letter : seal.magic) u8(static_cast<std::uint8_t>(letter));
  u32(seal.version);
  u64(0);
}

void ByteWriter::put(std::uint64_t value, int count) {
  for (int i = 0; i < count; ++i) bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

void ByteWriter::f64(double value) { u64(std::bit_cast<std::uint64_t>(value)); }

std::vector<std::uint8_t> ByteWriter::sealed() {
  const std::uint64_t length = bytes_.size() - head;
  for (std::size_t i = 0; i < 8; ++i) bytes_[length_at + i] = static_cast<std::uint8_t>(length >> (8 * i));
  u64(checksum(bytes_.data(), bytes_.size()));
  return std::move(bytes_);
}

ByteReader::ByteReader(const Seal& seal, const char* object, const std::uint8_t* bytes, std::size_t size)
    : object_(object), at_(bytes + (bytes == nullptr ? 0 : head)), end_(at_) {
  if (bytes == nullptr || size < head + tail)
    fail("length", std::to_string(bytes == nullptr ? 0 : size) + " bytes", "at least " + std::to_string(head + tail));
  if (!std::equal(seal.magic.begin(), seal.magic.end(), bytes,
                  [](char letter, std::uint8_t byte) { return static_cast<std::uint8_t>(letter) == byte; }))
    fail("magic", "other bytes", "'" + std::string(seal.magic.begin(), seal.magic.end()) + "' at the beginning");
  const std::uint64_t version = little_endian(bytes + seal.magic.size(), 4);
  if (version != seal.version) fail("version", std::to_string(version), std::to_string(seal.version));
  const std::uint64_t length = little_endian(bytes + length_at, 8);
  if (length != size - head - tail)
    fail("length", std::to_string(size - head - tail) + " bytes of content", std::to_string(length));
  end_ = bytes + size - tail;
  if (checksum(bytes, size - tail) != little_endian(end_, tail))
    fail("checksum", "one that does not fit the content", "bytes as they were saved");
}

std::uint64_t ByteReader::get(std::size_t count, const char* field) {
  const auto left = static_cast<std::size_t>(end_ - at_);
  if (left < count) fail(field, std::to_string(left) + " bytes left", std::to_string(count));
  const std::uint64_t value = little_endian(at_, count);
  at_ += count;
  return value;
}

double ByteReader::f64(const char* field) { return std::bit_cast<double>(get(8, field)); }

double ByteReader::finite(const char* field) {
  const double value = f64(field);
  if (!std::isfinite(value)) fail(field, std::to_string(value), "a finite number");
  return value;
}

bool ByteReader::flag(const char* field) {
  const std::uint8_t value = u8(field);
  if (value > 1) fail(field, std::to_string(value), "0 or 1");
  return value == 1;
}

std::size_t ByteReader::count(std::size_t bytes_each, const char* field) {
  const std::uint64_t value = u64(field);
  const auto left = static_cast<std::size_t>(end_ - at_);
  if (value > left / bytes_each) fail(field, std::to_string(value), "at most " + std::to_string(left / bytes_each));
  return static_cast<std::size_t>(value);
}

void ByteReader::finish() const {
  if (at_ != end_) fail("end", std::to_string(end_ - at_) + " bytes more", "none");
}

void ByteReader::fail(const char* field, const std::string& found, const std::string& expected) const {
  throw Error(Status::bad_saved_state,
              std::string(object_) + ": " + field + ": found " + found + ", expected " + expected);
}

}  // namespace tactus::support
