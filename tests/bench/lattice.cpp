// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "bench/fcl_baseline.hpp"
#include "bench/shelf_lattice.hpp"
#include "bench/timing.hpp"
#include "bench/work.hpp"
#include "contact/contact_tables.hpp"

namespace tactus::bench {
namespace {

using contact::ContactTables;
using contact::FirstContacts;
using contact::LatticeMotion;
using contact::LatticePose;
using support::Bitset;
using support::Rng;

constexpr double enough_seconds = 0.5;
constexpr std::size_t tried = 4000;  // pairs of the shelf's millions that the baseline is measured on

std::size_t ask(const ContactTables& tables, const LatticeSetting& setting, const Bitset& possible) {
  std::size_t touched = 0;
  for (const LatticeMotion& motion : setting.motions)
    touched += possible.count() - tables.first_contacts(motion).split(possible).back();
  return touched;
}

struct Pair {
  std::size_t motion = 0;
  LatticePose target;
};

std::vector<Pair> all_pairs(const LatticeSetting& setting) {
  std::vector<Pair> pairs;
  const Bitset all = setting.lattice.all();
  for (std::size_t m = 0; m < setting.motions.size(); ++m)
    all.for_each([&](std::size_t cell) { pairs.push_back({m, setting.lattice.cell(cell)}); });
  return pairs;
}

std::vector<Pair> random_pairs(const LatticeSetting& setting, std::size_t count, Rng& rng) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    Pair pair;
    pair.motion = rng.below(setting.motions.size());
    for (std::size_t d = 0; d < 3; ++d)
      pair.target.at[d] = static_cast<int>(rng.below(static_cast<std::uint64_t>(setting.lattice.count[d])));
    pair.target.turn = static_cast<int>(rng.below(setting.lattice.target_turns.size()));
    pairs.push_back(pair);
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.motion < b.motion; });
  return pairs;
}

std::vector<Pose> tool_poses(const LatticeSetting& setting, std::size_t motion) {
  std::vector<Pose> poses;
  for (const LatticePose& pose : setting.motions[motion]) poses.push_back(setting.lattice.base_from_tool(pose));
  return poses;
}

std::vector<int> ask(const FclBaseline& baseline, const LatticeSetting& setting, const std::vector<Pair>& pairs) {
  std::vector<int> answers;
  std::vector<Pose> poses;
  std::size_t motion = setting.motions.size();
  for (const Pair& pair : pairs) {
    if (pair.motion != motion) poses = tool_poses(setting, motion = pair.motion);
    answers.push_back(baseline.first_contact(poses, setting.lattice.base_from_target(pair.target)));
  }
  return answers;
}

/// What the tables say of each pair, as the baseline says it.
std::vector<int> answers_of(const ContactTables& tables, const LatticeSetting& setting,
                            const std::vector<Pair>& pairs) {
  const Bitset all = setting.lattice.all();
  std::vector<int> answers;
  std::vector<int> first;
  std::size_t motion = setting.motions.size();
  for (const Pair& pair : pairs) {
    if (pair.motion != motion) {
      motion = pair.motion;
      const FirstContacts found = tables.first_contacts(setting.motions[motion]);
      first.assign(setting.lattice.bits(), -1);
      for (std::size_t k = 1; k < found.waypoints(); ++k)
        found.after_contact(all, k).for_each([&](std::size_t cell) { first[cell] = static_cast<int>(k); });
    }
    answers.push_back(first[setting.lattice.index(pair.target)]);
  }
  return answers;
}

bool flips(const FclBaseline& baseline, const LatticeSetting& setting, const Pair& pair, int ours) {
  for (int i = 0; i < 6; ++i) {
    Pose pose = setting.lattice.base_from_target(pair.target);
    pose.translation()[i / 2] += i % 2 == 0 ? 1e-9 : -1e-9;
    if (baseline.first_contact(tool_poses(setting, pair.motion), pose) == ours) return true;
  }
  return false;
}

/// What FCL says of some pairs, and how long it takes for all.
struct Baseline {
  std::vector<Pair> pairs;
  std::vector<int> answers;
  double seconds = 0.0;
  std::string note;
};

Baseline baseline_of(const FclBaseline& fcl, const LatticeSetting& setting, std::vector<Pair> pairs) {
  Baseline made;
  made.pairs = std::move(pairs);
  const std::size_t all = setting.motions.size() * setting.lattice.cells();
  made.seconds = thread_seconds("FCL", 0.0, [&] { made.answers = ask(fcl, setting, made.pairs); }) *
                 static_cast<double>(all) / static_cast<double>(made.pairs.size());
  const auto hits = std::count_if(made.answers.begin(), made.answers.end(), [](int first) { return first >= 0; });
  std::ostringstream note;
  note << "tool " << setting.bodies->body(0).mesh().triangles.size() << " triangles, no links, socket "
       << setting.target.triangles.size() << std::fixed << std::setprecision(1) << "; "
       << 100.0 * static_cast<double>(hits) / static_cast<double>(made.pairs.size()) << " % of the pairs hit";
  if (made.pairs.size() < all) note << "; FCL with OBB measured on " << made.pairs.size() << " random pairs and scaled";
  made.note = note.str();
  return made;
}

Row row_of(const std::string& work, const LatticeSetting& setting, const FclBaseline& fcl, const Baseline& baseline,
           const ContactTables& tables, double seconds, const std::string& what) {
  Row row;
  row.work = work;
  row.pairs = setting.motions.size() * setting.lattice.cells();
  row.n = setting.motions.front().size() - 1;
  row.ours_s = seconds;
  row.baseline_s = baseline.seconds;
  row.compared = baseline.pairs.size();
  row.agreeing = row.flips_within_1e_9 = 0;
  row.memory_mib = resident_mib();
  row.note = what + "; " + std::to_string(tables.bytes() >> 20) + " MiB of tables; " + baseline.note;
  const std::vector<int> ours = answers_of(tables, setting, baseline.pairs);
  for (std::size_t i = 0; i < ours.size(); ++i) {
    if (ours[i] == baseline.answers[i])
      ++*row.agreeing;
    else if (flips(fcl, setting, baseline.pairs[i], ours[i]))
      ++*row.flips_within_1e_9;
    else if (row.disagreements.size() < 20)
      row.disagreements.push_back("motion " + std::to_string(baseline.pairs[i].motion) + ": FCL " +
                                  std::to_string(baseline.answers[i]) + ", ours " + std::to_string(ours[i]));
  }
  return row;
}

/// The tables' making and what asking costs once they are there.
struct Times {
  double cold = 0.0, warm = 0.0, again = 0.0;
};

Times times_of(const contact::TargetContact& contact, const LatticeSetting& setting, const ContactTables& tables) {
  const Bitset all = setting.lattice.all();
  Times times;
  times.cold =
      thread_seconds("cold", enough_seconds, [&] { ask(ContactTables(contact, setting.lattice), setting, all); });
  ask(tables, setting, all);
  times.warm = thread_seconds("warm", enough_seconds, [&] { ask(tables, setting, all); });
  std::vector<FirstContacts> kept;
  for (const LatticeMotion& motion : setting.motions) kept.push_back(tables.first_contacts(motion));
  times.again = thread_seconds("again", enough_seconds, [&] {
    for (const FirstContacts& found : kept) found.split(all);
  });
  return times;
}

constexpr const char* cold_note = "tables made on the way";
constexpr const char* warm_note = "tables there, motions new: first contacts of all cells, and counts";
constexpr const char* again_note = "first contacts of the motions there: counts of a belief";

std::vector<Row> small(const std::string& work, const Options& options) {
  const LatticeSetting setting = small_lattice(options.seed);
  const contact::TargetContact contact(setting.bodies, setting.target, 0.0);
  const ContactTables tables(contact, setting.lattice);
  const FclBaseline fcl(*setting.bodies, setting.target, FclTree::obb);
  std::cerr << work << ": " << setting.lattice.cells() << " cells\n";
  const Times times = times_of(contact, setting, tables);
  const Baseline baseline = baseline_of(fcl, setting, all_pairs(setting));
  if (work == "lattice-cold") return {row_of(work, setting, fcl, baseline, tables, times.cold, cold_note)};
  return {row_of(work, setting, fcl, baseline, tables, times.warm, warm_note),
          row_of(work, setting, fcl, baseline, tables, times.again, again_note)};
}

std::vector<Row> shelf(const Options& options) {
  const LatticeSetting setting = shelf_lattice(options.seed);
  const contact::TargetContact contact(setting.bodies, setting.target, 0.0);
  const ContactTables tables(contact, setting.lattice);
  const FclBaseline fcl(*setting.bodies, setting.target, FclTree::obb);
  std::cerr << "lattice-7.5m: " << setting.lattice.cells() << " cells\n";
  Rng rng(options.seed);
  const Times times = times_of(contact, setting, tables);
  const Baseline baseline = baseline_of(fcl, setting, random_pairs(setting, tried, rng));
  return {row_of("lattice-7.5m", setting, fcl, baseline, tables, times.cold, cold_note),
          row_of("lattice-7.5m", setting, fcl, baseline, tables, times.warm, warm_note),
          row_of("lattice-7.5m", setting, fcl, baseline, tables, times.again, again_note)};
}

}  // namespace

std::vector<Work> lattice_works() {
  return {{"lattice-cold", [](const Options& options) { return small("lattice-cold", options); }},
          {"lattice-warm", [](const Options& options) { return small("lattice-warm", options); }},
          {"lattice-7.5m", shelf}};
}

}  // namespace tactus::bench
