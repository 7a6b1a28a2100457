// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <numbers>

#include "action/probes.hpp"
#include "bench/shelf_lattice.hpp"
#include "bench/timing.hpp"
#include "bench/work.hpp"
#include "contact/contact_tables.hpp"
#include "scenario/scenario.hpp"

namespace tactus::bench {
namespace {

using contact::Bitset;
using contact::FirstContacts;

constexpr double seconds = 0.5;

/// A byte a cell, its first contact, and a loop over the cells: what a set of particles would do.
std::vector<std::size_t> counted(const std::vector<std::uint8_t>& first, const std::vector<std::uint8_t>& possible,
                                 std::size_t waypoints) {
  std::vector<std::size_t> counts(waypoints + 1);
  for (std::size_t i = 0; i < first.size(); ++i) counts[first[i]] += possible[i];
  return counts;
}

/// A belief of millions of cells against one motion: how many would be first touched where, and what would be left.
std::vector<Row> split(const Options& options) {
  const LatticeSetting setting = shelf_lattice(options.seed);
  const contact::TargetContact contact(setting.bodies, setting.target, 0.0);
  const contact::ContactTables tables(contact, setting.lattice);
  const FirstContacts found = tables.first_contacts(setting.motions.front());
  Bitset possible = setting.lattice.all();
  for (std::size_t m = 1; m < 4; ++m) possible = tables.first_contacts(setting.motions[m]).after_none(possible);

  const std::size_t none = found.waypoints();
  std::vector<std::uint8_t> first(setting.lattice.bits(), static_cast<std::uint8_t>(none)), members(first.size());
  for (std::size_t k = 1; k < none; ++k)
    found.after_contact(setting.lattice.all(), k).for_each([&](std::size_t i) {
      first[i] = static_cast<std::uint8_t>(k);
    });
  possible.for_each([&](std::size_t i) { members[i] = 1; });

  Row row;
  row.work = "split";
  row.pairs = setting.lattice.cells();
  row.n = none - 1;
  row.compared = row.pairs;
  std::vector<std::size_t> ours, theirs;
  row.ours_s = thread_seconds("ours", seconds, [&] { ours = found.split(possible); });
  row.baseline_s = thread_seconds("baseline", seconds, [&] { theirs = counted(first, members, none); });
  row.agreeing = ours == theirs ? row.pairs : 0;
  if (ours != theirs) row.disagreements.push_back("the counts differ");
  row.memory_mib = resident_mib();
  row.note = std::to_string(possible.count()) + " cells possible; baseline: a byte a cell";
  Row successor = row;
  successor.work = "successor";
  Bitset left;
  const std::size_t waypoint = none / 2;
  successor.ours_s = thread_seconds("ours", seconds, [&] { left = found.after_contact(possible, waypoint); });
  std::vector<std::uint8_t> kept(first.size());
  successor.baseline_s = thread_seconds("baseline", seconds, [&] {
    for (std::size_t i = 0; i < first.size(); ++i) kept[i] = first[i] == waypoint ? members[i] : 0;
  });
  std::size_t agreeing = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) agreeing += left.test(i) == (kept[i] != 0);
  successor.agreeing = agreeing == kept.size() ? row.pairs : agreeing;
  successor.disagreements.clear();
  if (agreeing != kept.size()) successor.disagreements.push_back("the successors differ");
  return {row, successor};
}

/// One observation of a sweep, taken in by every cell of the shelf's prior at 2 mm and 3 degrees: one by one (a random
/// share of them) and in boxes.
Row observed(const action::Task& task, const belief::Trace& trace, const char* work, const Options& options) {
  double reach = 0.0;
  for (const geometry::Vector3& v : task.scene().target.mesh.vertices) reach = std::max(reach, v.norm());
  const belief::CellGrid all(task.scene().prior, 0.002, std::numbers::pi / 60.0, std::size_t{1} << 25, reach);
  const double radius = scene::cell_radius(all.half_width(), reach);
  Row row;
  row.work = work;
  row.pairs = all.size();
  row.n = trace.path.size() - 1;
  belief::CellGrid left = all;
  row.ours_s = thread_seconds("ours", seconds, [&] {
    left = all;
    left.sift(task, {&trace});
  });
  support::Rng rng(options.seed);
  std::vector<std::size_t> share;
  for (int i = 0; i < 20'000; ++i) share.push_back(rng.below(all.size()));
  std::size_t agreeing = 0;
  const double asked = thread_seconds("baseline", seconds, [&] {
    agreeing = 0;
    for (const std::size_t cell : share)
      agreeing += belief::may_reproduce(task, trace, geometry::pose_from(all.centre(cell)), radius) ==
                  left.members().test(cell);
  });
  row.baseline_s = asked * static_cast<double>(all.size()) / static_cast<double>(share.size());
  row.compared = share.size();
  row.agreeing = agreeing;
  row.memory_mib = resident_mib();
  row.note = std::to_string(left.size()) + " cells are left; baseline: each cell on its own, " +
             std::to_string(share.size()) + " of them, " + std::to_string(agreeing) + " as in boxes";
  return row;
}

std::vector<Row> cells(const Options& options) {
  const auto shelf = scenario::load(TACTUS_SOURCE_DIR "/examples/scenarios/shelf_3d.yaml");
  const action::Task& task = *shelf->task;
  const action::MotionPtr motion = action::probes(task, task.frame().region, task.home(), 9)[5];
  belief::Trace free, touched;
  free.path = motion->path;
  free.touch = free.path.size();
  free.bodies = motion->bodies;
  touched.contact = true;
  touched.path.assign(free.path.begin(), free.path.begin() + static_cast<std::ptrdiff_t>(free.path.size() / 2));
  touched.touch = touched.path.size() - 1;
  touched.bodies = contact::BodyPath(task.bodies(), touched.path);
  return {observed(task, free, "step-free", options), observed(task, touched, "step-contact", options)};
}

}  // namespace

std::vector<Work> belief_works() { return {{"split", split}, {"cells", cells}}; }

}  // namespace tactus::bench
