// SPDX-License-Identifier: BSD-3-Clause
#include "scenario/reader.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "scenario/scalar.hpp"

namespace tactus::scenario {
namespace {

namespace fs = std::filesystem;
using geometry::Vector3;

int line_of(const YAML::Node& node) { return std::max(0, node.Mark().line) + 1; }

/// A quoted scalar is text, whatever it looks like.
std::optional<double> number_in(const YAML::Node& node) {
  if (!node.IsScalar() || node.Tag() == "!") return std::nullopt;
  return number_from(node.Scalar());
}

/// The first `most` bytes of a longer text, less those of a character of UTF-8 that does not end there.
std::string beginning_of(const std::string& text, std::size_t most) {
  constexpr std::size_t after_the_first = 3;  // bytes of a character at most
  std::size_t end = most;
  while (most - end < after_the_first && (text[end] & 0xC0) == 0x80) --end;
  return text.substr(0, end);
}

std::string description_of(const YAML::Node& node) {
  constexpr std::size_t longest = 60;
  if (node.IsMap()) return "a map";
  if (node.IsSequence()) return "a list of " + std::to_string(node.size());
  if (!node.IsScalar()) return "nothing";
  const std::string& text = node.Scalar();
  if (number_in(node)) return text;
  return '"' + (text.size() > longest ? beginning_of(text, longest) + "..." : text) + '"';
}

std::vector<Place> elements_of(const Place& list) {
  std::vector<Place> elements;
  for (const YAML::Node& node : list.node)
    elements.push_back({node, line_of(node), list.path + '[' + std::to_string(elements.size()) + ']'});
  return elements;
}

}  // namespace

bool Range::contains(double x) const { return std::isfinite(x) && (low_excluded ? x > low : x >= low) && x <= high; }

std::string Range::text(const std::string& noun) const {
  const bool bounded_below = std::isfinite(low), bounded_above = std::isfinite(high);
  if (!bounded_below) return noun + (bounded_above ? " of at most " + number_text(high) : "");
  const std::string above = (low_excluded    ? " greater than "
                             : bounded_above ? " from "
                                             : " of at least ") +
                            number_text(low);
  if (!bounded_above) return noun + above;
  return noun + above + (low_excluded ? " and at most " : " to ") + number_text(high);
}

void Findings::add(int line, const std::string& key_path, const std::string& found, const std::string& expected) {
  const std::string where = file_ + ':' + std::to_string(line) + (key_path.empty() ? "" : ": " + key_path);
  by_line_.emplace(line, support::Problem{where, found, expected});
}

std::vector<support::Problem> Findings::in_order_of_lines() const {
  std::vector<support::Problem> problems;
  for (const auto& [line, problem] : by_line_) problems.push_back(problem);
  return problems;
}

Reader::Reader(Place map, Findings& findings) : map_(std::move(map)), findings_(findings) {
  for (const auto& entry : map_.node) {
    const int line = line_of(entry.first);
    if (!entry.first.IsScalar()) {
      findings_.add(line, map_.path, description_of(entry.first) + " as a key", "a word");
      continue;
    }
    const std::string key = entry.first.Scalar();
    const auto [first, is_new] = entries_.try_emplace(key, Place{entry.second, line, path_of(key)});
    if (!is_new)
      findings_.add(line, path_of(key), "the key a second time",
                    "it once (it is on line " + std::to_string(first->second.line) + ')');
  }
}

void Reader::text(const std::string& key, std::string& out, Need need) {
  const Place* place = find(key, "text", need);
  if (place == nullptr) return;
  if (!place->node.IsScalar() || place->node.Scalar().empty()) return wrong(*place, "text");
  out = place->node.Scalar();
}

void Reader::choice(const std::string& key, std::string& out, const std::vector<std::string>& choices) {
  const Place* place = find(key, alternatives(choices), Need::optional);
  if (place == nullptr) return;
  const std::string word = place->node.IsScalar() ? place->node.Scalar() : "";
  if (std::find(choices.begin(), choices.end(), word) == choices.end())
    return wrong(*place, alternatives(choices) + suggestion(word, choices));
  out = word;
}

void Reader::number(const std::string& key, double& out, const Range& range, Need need) {
  if (const Place* place = find(key, range.text("a number"), need)) read_number(*place, range, "a number", out);
}

void Reader::whole_number(const std::string& key, double& out, const Range& range, double largest) {
  const Place* place = find(key, range.text("a whole number"), Need::optional);
  double value = 0.0;
  if (place == nullptr || !read_number(*place, range, "a whole number", value)) return;
  if (value != std::floor(value)) return wrong(*place, range.text("a whole number"));
  // doubles beyond 2^53 skip integers
  const Range representable{range.low, std::min(largest, 0x1p53)};
  if (!representable.contains(value)) return wrong(*place, representable.text("a whole number"));
  out = value;
}

void Reader::numbers(const std::string& key, std::vector<double>& out, const Range& range, Need need) {
  if (const Place* place = find(key, "a list of numbers", need)) read_numbers(*place, range, "a list of numbers", out);
}

void Reader::vector(const std::string& key, Vector3& out, const Range& range, Need need) {
  if (const Place* place = find(key, "a list of 3 numbers", need)) read_three(*place, range, out);
}

void Reader::scale(const std::string& key, Vector3& out) {
  const Place* place = find(key, "", Need::optional);
  if (place == nullptr) return;
  Vector3 read = out;
  double one = 0.0;
  if (place->node.IsSequence())
    read_three(*place, any_number, read);
  else if (read_number(*place, any_number, "one number or a list of 3", one))
    read.setConstant(one);
  if ((read.array() == 0.0).any()) return wrong(*place, "numbers other than 0");
  out = read;
}

void Reader::file(const std::string& key, fs::path& out, Need need) {
  if (const Place* place = find(key, "the path of a file", need)) read_path(*place, false, out);
}

void Reader::folders(const std::string& key, std::map<std::string, fs::path>& out) {
  section(key, [&](Reader& names) {
    for (const auto& [name, place] : names.entries_) {
      names.known_.push_back(name);
      read_path(place, true, out[name]);
    }
  });
}

void Reader::pose(geometry::PoseVector& out) {
  Vector3 xyz(out[0], out[1], out[2]), rpy(out[3], out[4], out[5]);
  vector("xyz", xyz, any_number);
  vector("rpy", rpy, any_number);
  out = {xyz.x(), xyz.y(), xyz.z(), rpy.x(), rpy.y(), rpy.z()};
}

void Reader::pose(const std::string& key, geometry::PoseVector& out, Need need) {
  section(
      key, [&](Reader& in) { in.pose(out); }, need);
}

void Reader::pose(const std::string& key, geometry::Pose& out, Need need) {
  geometry::PoseVector vector = geometry::pose_vector(out);
  pose(key, vector, need);
  out = geometry::pose_from(vector);
}

void Reader::poses(const std::string& key, std::vector<geometry::Pose>& out, Need need) {
  const std::string expected = "a map or a list of maps";
  const Place* place = find(key, expected, need);
  if (place == nullptr) return;
  const bool one = place->node.IsMap();
  if (!one && !(place->node.IsSequence() && place->node.size() > 0)) return wrong(*place, expected);
  out.clear();
  for (const Place& element : one ? std::vector{*place} : elements_of(*place)) {
    geometry::PoseVector pose{};
    read_map(element, [&](Reader& in) { in.pose(pose); });
    out.push_back(geometry::pose_from(pose));
  }
}

void Reader::section(const std::string& key, const Read& read, Need need) {
  if (const Place* place = find(key, "a map", need)) read_map(*place, read);
}

void Reader::sections(const std::string& key, const Read& read) {
  const Place* place = find(key, "a list of maps", Need::optional);
  if (place == nullptr) return;
  if (!place->node.IsSequence()) return wrong(*place, "a list of maps");
  for (const Place& element : elements_of(*place)) read_map(element, read);
}

void Reader::note(const std::string& key, const std::string& found, const std::string& expected) {
  const auto entry = entries_.find(key);
  findings_.add(entry == entries_.end() ? map_.line : entry->second.line, path_of(key), found, expected);
}

void Reader::finish() {
  for (const auto& [key, place] : entries_)
    if (std::find(known_.begin(), known_.end(), key) == known_.end())
      findings_.add(place.line, place.path, "a key that isn't known", alternatives(known_) + suggestion(key, known_));
}

const Place* Reader::find(const std::string& key, const std::string& expected, Need need) {
  known_.push_back(key);
  const auto entry = entries_.find(key);
  if (entry != entries_.end()) return &entry->second;
  if (need == Need::required) note(key, "nothing", expected);
  return nullptr;
}

bool Reader::read_number(const Place& place, const Range& range, const std::string& noun, double& out) {
  const std::optional<double> value = number_in(place.node);
  if (!value || !range.contains(*value)) {
    wrong(place, range.text(value && !std::isfinite(*value) ? "a finite number" : noun));
    return false;
  }
  out = *value;
  return true;
}

bool Reader::read_numbers(const Place& place, const Range& range, const std::string& expected,
                          std::vector<double>& out) {
  if (!place.node.IsSequence()) {
    wrong(place, expected);
    return false;
  }
  std::vector<double> read;
  for (const Place& element : elements_of(place)) {
    double value = 0.0;
    if (read_number(element, range, "a number", value)) read.push_back(value);
  }
  if (read.size() < place.node.size()) return false;
  out = read;
  return true;
}

void Reader::read_three(const Place& place, const Range& range, Vector3& out) {
  std::vector<double> read;
  if (!read_numbers(place, range, "a list of 3 numbers", read)) return;
  if (read.size() != 3) return wrong(place, "a list of 3 numbers");
  out = Vector3(read[0], read[1], read[2]);
}

void Reader::read_path(const Place& place, bool folder, fs::path& out) {
  const std::string expected = folder ? "the path of a folder" : "the path of a file";
  if (!place.node.IsScalar() || place.node.Scalar().empty()) return wrong(place, expected);
  const fs::path path = (findings_.base_dir() / place.node.Scalar()).lexically_normal();
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (folder ? fs::is_directory(status) : fs::is_regular_file(status)) {
    out = path;
    return;
  }
  const std::string what = fs::exists(status) ? ", which is something else" : ", which isn't there";
  findings_.add(place.line, place.path, path.string() + what, expected);
}

void Reader::read_map(const Place& place, const Read& read) {
  if (!place.node.IsMap()) return wrong(place, "a map");
  Reader reader(place, findings_);
  read(reader);
  reader.finish();
}

void Reader::wrong(const Place& place, const std::string& expected) {
  findings_.add(place.line, place.path, description_of(place.node), expected);
}

std::string Reader::path_of(const std::string& key) const {
  if (map_.path.empty() || key.empty()) return map_.path + key;
  return map_.path + '.' + key;
}

}  // namespace tactus::scenario
