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

/// The shelf, and its prior in cells of 2 mm and 3 degrees.
struct FineShelf {
  std::shared_ptr<const scenario::Scenario> shelf =
      scenario::load(TACTUS_SOURCE_DIR "/examples/scenarios/shelf_3d.yaml");
  belief::CellShape shape =
      belief::cell_shape(shelf->task->scene().prior, 0.002, std::numbers::pi / 60.0, std::size_t{1} << 25);
  action::Task task{shelf->task->scene(), with_sites(shelf->task->options(), shape)};

  static action::TaskOptions with_sites(action::TaskOptions options, const belief::CellShape& shape) {
    options.sites = belief::CellTables::sites(shape, 0.001);
    return options;
  }
};

/// One observation of a sweep, taken in by every cell: one by one (a random share of them), in boxes, and by tables.
std::vector<Row> observed(const FineShelf& fine, const belief::Trace& trace, const std::string& work,
                          const Options& options) {
  const action::Task& task = fine.task;
  const belief::CellGrid all(fine.shape, task.target_reach());
  const double radius = scene::cell_radius(all.half_width(), task.target_reach());
  Row row;
  row.pairs = all.size();
  row.n = trace.path.size() - 1;
  support::Rng rng(options.seed);
  std::vector<std::size_t> share;
  for (int i = 0; i < 20'000; ++i) share.push_back(rng.below(all.size()));
  row.compared = share.size();
  std::vector<char> may(share.size());
  row.baseline_s =
      thread_seconds("baseline", seconds,
                     [&] {
                       for (std::size_t i = 0; i < share.size(); ++i)
                         may[i] = belief::may_reproduce(task, trace, geometry::pose_from(all.centre(share[i])), radius);
                     }) *
      static_cast<double>(all.size()) / static_cast<double>(share.size());

  std::vector<Row> rows;
  belief::CellGrid left = all;
  const auto add = [&](const std::string& way, double time, const std::string& note) {
    row.work = work + way;
    row.ours_s = time;
    std::size_t agreeing = 0;
    for (std::size_t i = 0; i < share.size(); ++i) agreeing += left.members().test(share[i]) == (may[i] != 0);
    row.agreeing = agreeing;
    row.memory_mib = resident_mib();
    row.note = note + "; " + std::to_string(left.size()) + " cells are left; baseline: each cell on its own, " +
               std::to_string(share.size()) + " of them, " + std::to_string(agreeing) + " of these as here";
    rows.push_back(row);
  };
  const auto sift = [&](const belief::CellTables* tables) {
    left = all;
    left.sift(task, {&trace}, {}, tables);
  };
  add("", thread_seconds("boxes", seconds, [&] { sift(nullptr); }), "boxes of cells");
  const double cold = thread_seconds("cold", seconds, [&] {
    const belief::CellTables fresh(task, fine.shape);
    sift(&fresh);
  });
  add("-cold", cold, "tables made on the way");
  const belief::CellTables tables(task, fine.shape);
  sift(&tables);
  const double warm = thread_seconds("warm", seconds, [&] { sift(&tables); });
  add("-warm", warm, "tables there, " + std::to_string(tables.bytes() >> 20) + " MiB");
  return rows;
}

std::vector<Row> cells(const Options& options) {
  const FineShelf fine;
  const action::Task& task = fine.task;
  const action::MotionPtr motion = action::probes(task, task.frame().region, task.home(), 9)[5];
  belief::Trace free, touched;
  free.path = motion->path;
  free.touch = free.path.size();
  free.bodies = motion->bodies;
  touched.contact = true;
  touched.path.assign(free.path.begin(), free.path.begin() + static_cast<std::ptrdiff_t>(free.path.size() / 2));
  touched.touch = touched.path.size() - 1;
  touched.bodies = contact::BodyPath(task.bodies(), touched.path);
  std::vector<Row> rows = observed(fine, free, "step-free", options);
  for (Row& row : observed(fine, touched, "step-contact", options)) rows.push_back(std::move(row));
  return rows;
}

}  // namespace

std::vector<Work> belief_works() { return {{"split", split}, {"cells", cells}}; }

}  // namespace tactus::bench
