// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tinyxml.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "support/error.hpp"

namespace tactus::robot {

/// TinyXML recurses into nested elements and takes quadratic time over the attributes of one: both are counted before
/// it sees the text.
struct XmlLimits {
  std::size_t bytes = 8u << 20;
  std::size_t elements = 200'000;
  std::size_t depth = 64;
  std::size_t attributes = 64;  ///< of one element
};

/// Reads a regular file into `document`, every white space inside attribute values made a blank (XML asks for that,
/// TinyXML does not do it). Throws `file_not_found`, `file_unreadable`, or `bad_robot` for what is over the limits or
/// not well-formed.
void read_xml(const std::filesystem::path& file, TiXmlDocument& document, const XmlLimits& limits = {});

/// Collects what is wrong in one XML file.
class XmlReport {
 public:
  explicit XmlReport(const std::filesystem::path& file) : file_(file.string()) {}

  /// `noun` says what stands at the element: "link forearm_link".
  void add(const TiXmlElement& element, const std::string& noun, const std::string& found, const std::string& expected);
  void add(int row, const std::string& noun, const std::string& found, const std::string& expected);
  bool empty() const { return problems_.empty(); }
  /// Throws `bad_robot` with all of them, if there are any.
  void throw_if_any() const;

 private:
  std::string file_;
  std::vector<support::Problem> problems_;
};

/// The element's attribute; empty if it has none of that name.
std::string attribute(const TiXmlElement& element, const char* name);

/// The numbers of a blank-separated list; none if one of them is not a finite number.
std::optional<std::vector<double>> finite_numbers(const std::string& text);

}  // namespace tactus::robot
