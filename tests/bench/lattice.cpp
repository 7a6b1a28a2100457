// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iomanip>
#include <iostream>
#include <numbers>
#include <sstream>

#include "bench/fcl_baseline.hpp"
#include "bench/setting.hpp"
#include "bench/timing.hpp"
#include "bench/work.hpp"
#include "contact/contact_tables.hpp"

namespace tactus::bench {
namespace {

using contact::ContactTables;
using contact::FirstContacts;
using contact::Lattice;
using contact::LatticeMotion;
using contact::LatticePose;
using geometry::Vector3;
using support::Bitset;
using support::Rng;

constexpr std::size_t motion_count = 10;
constexpr int n = 20;
constexpr double enough_seconds = 0.5;
constexpr double tip = 0.16;         // m from the tool link to the plug's pins
constexpr std::size_t tried = 4000;  // pairs of the shelf's millions that the baseline is measured on
constexpr double degree = std::numbers::pi / 180.0;

/// Target poses and motions of the tool on one lattice. Its z goes into the wall.
struct LatticeSetting {
  Mesh target;
  std::shared_ptr<const contact::RobotBodies> bodies;
  Lattice lattice;
  std::vector<LatticeMotion> motions;
};

Eigen::Matrix3d about(const Vector3& axis, double angle) { return Eigen::AngleAxisd(angle, axis).toRotationMatrix(); }

/// Faces the wall, a little askew, so that no two faces of tool and target are parallel.
Eigen::Matrix3d tool_turn(double askew) { return about(Vector3(0.3, 0.5, 0.8).normalized(), askew); }

/// The target with its x axis into the wall, turned about it in even steps.
std::vector<Eigen::Matrix3d> target_turns(int count, double step) {
  std::vector<Eigen::Matrix3d> turns;
  for (int i = 0; i < count; ++i)
    turns.push_back(about(Vector3::UnitZ(), i * step) * about(Vector3::UnitY(), -0.5 * std::numbers::pi));
  return turns;
}

LatticeMotion along(LatticePose from, const std::array<int, 3>& step) {
  LatticeMotion motion;
  for (int k = 0; k <= n; ++k) {
    motion.push_back(from);
    for (std::size_t d = 0; d < 3; ++d) from.at[d] += step[d];
  }
  return motion;
}

/// Across the lattice in x and in y by turns, and every fifth straight in, in steps of 10 mm and 2 mm.
std::vector<LatticeMotion> motions_over(const Lattice& lattice, double depth, Rng& rng) {
  const int stride = static_cast<int>(std::lround(0.01 / lattice.pitch));
  const int inwards = std::max(1, static_cast<int>(std::lround(0.002 / lattice.pitch)));
  std::vector<LatticeMotion> motions;
  for (std::size_t i = 0; i < motion_count; ++i) {
    LatticePose from;
    for (std::size_t d = 0; d < 2; ++d)
      from.at[d] = static_cast<int>(rng.below(static_cast<std::uint64_t>(lattice.count[d])));
    from.at[2] = lattice.count[2] / 2 + static_cast<int>(std::lround((depth - tip) / lattice.pitch));
    from.turn = static_cast<int>(rng.below(lattice.tool_turns.size()));
    std::array<int, 3> step{};
    if (i % 5 == 4) {
      step[2] = inwards;
      from.at[2] -= n * inwards;
    } else {
      step[i % 2] = rng.below(2) == 0 ? stride : -stride;
      from.at[i % 2] = lattice.count[i % 2] / 2 - n / 2 * step[i % 2] + static_cast<int>(rng.below(9)) - 4;
    }
    motions.push_back(along(from, step));
  }
  return motions;
}

LatticeSetting setting_on(Lattice lattice, double depth, std::uint64_t seed) {
  Rng rng(seed);
  LatticeSetting made;
  made.target = socket().mesh;
  made.bodies = plug_alone();
  made.motions = motions_over(lattice, depth, rng);
  made.lattice = std::move(lattice);
  return made;
}

/// 40,000 poses: 20 x 20 x 20 at 5 mm, five turns.
LatticeSetting small_lattice(std::uint64_t seed) {
  Lattice lattice;
  lattice.pitch = 0.005;
  lattice.count = {20, 20, 20};
  lattice.target_turns = target_turns(5, 7.0 * degree);
  lattice.tool_turns = {tool_turn(0.017), tool_turn(-0.031)};
  return setting_on(std::move(lattice), 0.0, seed);
}

/// 7.5 million poses: the shelf's prior, 50 cm in either direction at 2 mm, all round in steps of 3 degrees.
LatticeSetting shelf_lattice(std::uint64_t seed) {
  Lattice lattice;
  lattice.pitch = 0.002;
  lattice.count = {250, 250, 1};
  lattice.target_turns = target_turns(120, 3.0 * degree);
  lattice.tool_turns = {tool_turn(0.017)};
  return setting_on(std::move(lattice), -0.005, seed);
}

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
  row.n = n;
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
