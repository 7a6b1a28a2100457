// SPDX-License-Identifier: BSD-3-Clause
#include "bench/arguments.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

namespace tactus::bench {
namespace {

constexpr std::size_t fewest_pairs = 10, most_pairs = 100'000'000;

template <typename Number>
Number number(const std::string& option, const std::string& text, Number low, Number high, const char* expected) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !(value >= low && value <= high))
    throw UsageError(option + ": found '" + text + "', expected " + expected);
  return value;
}

std::vector<Work> works_of(const std::string& suite) {
  if (suite == "contact") return contact_works();
  if (suite == "voxels") return voxel_works();
  if (suite == "belief") return belief_works();
  if (suite == "poses") return pose_works();
  if (suite == "walks") return walk_works();
  if (suite == "cancel") return cancel_works();
  throw UsageError("found '" + suite + "', expected contact, voxels, belief, poses, walks or cancel");
}

std::vector<Work> chosen(const std::vector<Work>& works, const std::string& names) {
  std::vector<Work> result;
  std::string known;
  for (const Work& work : works) known += (known.empty() ? "" : ", ") + work.name;
  std::istringstream list(names);
  for (std::string name; std::getline(list, name, ',');) {
    const auto work = std::find_if(works.begin(), works.end(), [&](const Work& w) { return w.name == name; });
    if (work == works.end()) throw UsageError("--works: found '" + name + "', expected some of " + known);
    result.push_back(*work);
  }
  if (result.empty()) throw UsageError("--works: found nothing, expected some of " + known);
  return result;
}

}  // namespace

const char* const usage =
    "usage: tactus-bench contact|voxels|belief|poses|walks|cancel [options]\n"
    "\n"
    "Times tactus against its baseline (brute-force FCL for contact) in one run, on the same pairs, one thread each, "
    "and\n"
    "counts the answers that agree. The table goes to stdout, progress to stderr.\n"
    "\n"
    "  --works A,B,...      only these; all without it\n"
    "  --pairs N            (motion, pose) pairs of a work, in tens (400000)\n"
    "  --seed S             of everything random (1)\n"
    "  --baseline-share F   measure the baseline on a random share of the pairs, and scale it (1)\n"
    "  --json FILE|-        write the rows as JSON; with -, to stdout, and the table to stderr\n"
    "  --help\n";

Arguments parse_arguments(const std::vector<std::string>& words) {
  Arguments arguments;
  std::string names;
  bool some = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    const auto value = [&]() -> const std::string& {
      if (++i == words.size()) throw UsageError(word + ": expected a value behind it");
      return words[i];
    };
    if (word == "--help" || word == "-h") {
      arguments.help = true;
      return arguments;
    }
    if (word == "--works")
      names = value(), some = true;
    else if (word == "--json")
      arguments.json = value();
    else if (word == "--pairs")
      arguments.options.pairs = number(word, value(), fewest_pairs, most_pairs, "a whole number from 10 to 100000000");
    else if (word == "--seed")
      arguments.options.seed = number(word, value(), std::uint64_t{0}, ~std::uint64_t{0}, "a whole number from 0");
    else if (word == "--baseline-share")
      arguments.options.baseline_share = number(word, value(), 1e-6, 1.0, "a number from 1e-6 to 1");
    else if (word.starts_with("-") || !arguments.suite.empty())
      throw UsageError("found '" + word + "', expected an option; --help lists them");
    else
      arguments.suite = word;
  }
  if (arguments.suite.empty())
    throw UsageError("expected contact, voxels, belief, poses, walks or cancel; --help tells more");
  arguments.works = works_of(arguments.suite);
  if (arguments.works.empty()) throw UsageError(arguments.suite + ": not there yet");
  if (some) arguments.works = chosen(arguments.works, names);
  return arguments;
}

}  // namespace tactus::bench
