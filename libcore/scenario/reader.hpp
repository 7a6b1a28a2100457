// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <yaml-cpp/yaml.h>

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "geometry/pose.hpp"
#include "support/error.hpp"

namespace tactus::scenario {

enum class Need { optional, required };

/// The numbers that a key may have; infinity is none of them.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_excluded = false;

  bool contains(double x) const;
  std::string text(const std::string& noun) const;  ///< "a number greater than 0" if `noun` is "a number"
};
inline constexpr Range any_number{};
inline constexpr Range positive{0.0, std::numeric_limits<double>::infinity(), true};
inline constexpr Range not_negative{0.0};
inline constexpr Range at_least_one{1.0};

/// What all readers of one file share: its name, the folder its paths start from, and what was found wrong so far.
class Findings {
 public:
  Findings(std::string file, std::filesystem::path base_dir) : file_(std::move(file)), base_dir_(std::move(base_dir)) {}

  const std::filesystem::path& base_dir() const { return base_dir_; }
  void add(int line, const std::string& key_path, const std::string& found, const std::string& expected);
  std::vector<support::Problem> in_order_of_lines() const;

 private:
  std::string file_;
  std::filesystem::path base_dir_;
  std::multimap<int, support::Problem> by_line_;
};

/// A value in the file, the line it stands on (from 1), and its name: "prior.width.y", "world[2].box", empty at the
/// top.
struct Place {
  YAML::Node node;
  int line;
  std::string path;
};

/// Reads one map, key by key, and notes every mistake instead of stopping at the first.
///
/// Each method reads one key into `out`, whose value is left alone (it is the default) where the key is absent or
/// wrong. After the last key, `finish` notes the keys that nobody asked for.
class Reader {
 public:
  using Read = std::function<void(Reader&)>;

  Reader(Place map, Findings& findings);

  bool has(const std::string& key) const { return entries_.contains(key); }

  void text(const std::string& key, std::string& out, Need need = Need::optional);
  void choice(const std::string& key, std::string& out, const std::vector<std::string>& choices);
  void number(const std::string& key, double& out, const Range& range, Need need = Need::optional);
  template <std::integral Integer>
  void integer(const std::string& key, Integer& out, const Range& range) {
    double value = static_cast<double>(out);
    whole_number(key, value, range, static_cast<double>(std::numeric_limits<Integer>::max()));
    out = static_cast<Integer>(value);
  }
  void numbers(const std::string& key, std::vector<double>& out, const Range& range, Need need = Need::optional);
  void vector(const std::string& key, geometry::Vector3& out, const Range& range, Need need = Need::optional);
  void scale(const std::string& key, geometry::Vector3& out);  ///< one number or three, none of them 0
  void file(const std::string& key, std::filesystem::path& out, Need need = Need::optional);
  void folders(const std::string& key, std::map<std::string, std::filesystem::path>& out);
  void pose(geometry::PoseVector& out);  ///< this map is one: its keys xyz and rpy
  void pose(const std::string& key, geometry::PoseVector& out, Need need = Need::optional);
  void pose(const std::string& key, geometry::Pose& out, Need need = Need::optional);
  /// One pose or a list of them.
  void poses(const std::string& key, std::vector<geometry::Pose>& out, Need need = Need::optional);

  /// Reads the map below `key`, up to its `finish`.
  void section(const std::string& key, const Read& read, Need need = Need::optional);
  /// Reads the list of maps below `key`.
  void sections(const std::string& key, const Read& read);

  /// Notes a mistake at `key`, or at this map where the key is absent.
  void note(const std::string& key, const std::string& found, const std::string& expected);
  void finish();

 private:
  const Place* find(const std::string& key, const std::string& expected, Need need);
  void whole_number(const std::string& key, double& out, const Range& range, double largest);
  bool read_number(const Place& place, const Range& range, const std::string& noun, double& out);
  bool read_numbers(const Place& place, const Range& range, const std::string& expected, std::vector<double>& out);
  void read_three(const Place& place, const Range& range, geometry::Vector3& out);
  void read_path(const Place& place, bool folder, std::filesystem::path& out);
  void read_map(const Place& place, const Read& read);
  void wrong(const Place& place, const std::string& expected);
  std::string path_of(const std::string& key) const;

  Place map_;
  Findings& findings_;
  std::map<std::string, Place> entries_;  // the first of each key
  std::vector<std::string> known_;        // the keys asked for
};

}  // namespace tactus::scenario
