// SPDX-License-Identifier: BSD-3-Clause
#include "robot/xml_file.hpp"

#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

namespace tactus::robot {
namespace {

using support::Error;
using support::Status;

std::string read_text(const std::filesystem::path& file, std::size_t limit) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    throw Error(Status::file_not_found, file.string() + ": found no such file, expected an XML file");
  if (!std::filesystem::is_regular_file(file, ignored))
    throw Error(Status::file_unreadable, file.string() + ": found something that is not a regular file");
  std::ifstream stream(file, std::ios::binary);
  std::string text(limit + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!stream && !stream.eof()) throw Error(Status::file_unreadable, file.string() + ": the file can't be read");
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

struct Tag {
  std::size_t end = 0;  ///< index of its '>'
  std::size_t attributes = 0;
  bool closes_itself = false;
};

Tag scan_tag(const std::string& text, std::size_t begin) {
  Tag tag;
  char quote = 0;
  for (tag.end = begin; tag.end < text.size(); ++tag.end) {
    const char c = text[tag.end];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '=') {
      ++tag.attributes;
    } else if (c == '>') {
      break;
    }
  }
  tag.closes_itself = text[tag.end - 1] == '/';
  return tag;
}

std::size_t skip_past(const std::string& text, const char* mark, std::size_t from) {
  const std::size_t at = text.find(mark, from);
  return at == std::string::npos ? text.size() : at;
}

/// What of the limits the text breaks, in words; empty if nothing. Counts what TinyXML may take for a tag, and rather
/// too many.
std::string find_excess(const std::string& text, const XmlLimits& limits) {
  if (text.size() > limits.bytes) return "more than " + std::to_string(limits.bytes) + " bytes";
  if (text.find('\0') != std::string::npos) return "a zero byte";
  std::size_t depth = 0, elements = 0;
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    if (text.compare(at, 4, "<!--") == 0) {
      at = skip_past(text, "-->", at + 4);
    } else if (text.compare(at, 9, "<![CDATA[") == 0) {
      at = skip_past(text, "]]>", at + 9);
    } else if (text.compare(at, 2, "</") == 0) {
      if (depth-- == 0) return "an end tag without its start";
    } else if (text.compare(at, 2, "<!") != 0 && text.compare(at, 2, "<?") != 0) {
      const Tag tag = scan_tag(text, at + 1);
      at = tag.end;
      if (!tag.closes_itself) ++depth;
      if (++elements > limits.elements) return "more than " + std::to_string(limits.elements) + " elements";
      if (depth > limits.depth) return "elements nested deeper than " + std::to_string(limits.depth);
      if (tag.attributes > limits.attributes)
        return "an element with more than " + std::to_string(limits.attributes) + " attributes";
    }
  }
  return {};
}

void blank_white_space(TiXmlElement& element) {
  for (TiXmlAttribute* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    std::string value = a->ValueStr();
    for (char& c : value)
      if (c == '\t' || c == '\n' || c == '\r') c = ' ';
    a->SetValue(value);
  }
  for (TiXmlElement* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
    blank_white_space(*child);
}

}  // namespace

void read_xml(const std::filesystem::path& file, TiXmlDocument& document, const XmlLimits& limits) {
  const std::string text = read_text(file, limits.bytes);
  XmlReport report(file);
  const std::string excess = find_excess(text, limits);
  if (!excess.empty()) {
    report.add(1, "file", excess, "an XML file of reasonable size");
    report.throw_if_any();
  }
  document.Parse(text.c_str(), nullptr, TIXML_ENCODING_UTF8);
  if (document.Error())
    report.add(document.ErrorRow(), "XML", document.ErrorDesc(), "a well-formed document");
  else if (document.RootElement() == nullptr)
    report.add(1, "XML", "no element", "a root element");
  report.throw_if_any();
  blank_white_space(*document.RootElement());
}

void XmlReport::add(const TiXmlElement& element, const std::string& noun, const std::string& found,
                    const std::string& expected) {
  add(element.Row(), noun, found, expected);
}

void XmlReport::add(int row, const std::string& noun, const std::string& found, const std::string& expected) {
  problems_.push_back({file_ + ':' + std::to_string(row) + ": " + noun, found, expected});
}

void XmlReport::throw_if_any() const { support::throw_if_any(problems_, Status::bad_robot, file_); }

std::string attribute(const TiXmlElement& element, const char* name) {
  const char* value = element.Attribute(name);
  return value == nullptr ? std::string() : std::string(value);
}

std::optional<std::vector<double>> finite_numbers(const std::string& text) {
  std::vector<double> numbers;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const char* const end = word.data() + word.size();
    const char* const begin = word.data() + (word.front() == '+' ? 1 : 0);
    double number = 0.0;
    const auto [stop, failure] = std::from_chars(begin, end, number);
    if (failure != std::errc() || stop != end || !std::isfinite(number)) return std::nullopt;
    numbers.push_back(number);
  }
  return numbers;
}

}  // namespace tactus::robot
