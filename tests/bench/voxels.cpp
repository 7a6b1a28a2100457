// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "action/probes.hpp"
#include "bench/timing.hpp"
#include "bench/voxels_baseline.hpp"
#include "bench/work.hpp"
#include "scenario/scenario.hpp"
#include "solver/voxel_problem.hpp"

namespace tactus::bench {
namespace {

using contact::Bitset;
using contact::SweptVoxels;

constexpr double pitches[] = {0.01, 0.005};  // m
constexpr std::size_t motion_count = 10;
constexpr int lines_per_side = 9;       // as the planner lays them out
constexpr double seconds = 0.5;         // that ours is timed for, and the baseline
constexpr double contact_slack = 1e-3;  // m

/// Sweeps and pokes of the shelf, what each sweeps, and a belief that some of them have gone through.
struct Shelf {
  explicit Shelf(double pitch);

  const action::Task& task() const { return *scenario->task; }

  std::shared_ptr<const scenario::Scenario> scenario;
  std::shared_ptr<const belief::VoxelModel> model;
  std::vector<action::MotionPtr> motions;
  std::vector<SweptVoxels> swept;
  belief::VoxelBelief belief;
};

Shelf::Shelf(double pitch)
    : scenario(scenario::load(TACTUS_SOURCE_DIR "/examples/scenarios/shelf_3d.yaml")),
      model(std::make_shared<const belief::VoxelModel>(*scenario->task, pitch)),
      belief(model) {
  const std::vector<action::MotionPtr> all =
      action::probes(task(), task().frame().region, task().home(), lines_per_side);
  for (std::size_t i = 0; i < motion_count; ++i) motions.push_back(all[i * all.size() / motion_count]);
  for (const action::MotionPtr& motion : motions)
    swept.push_back(contact::swept_voxels(task().bodies(), motion->bodies, model->grid));
  for (std::size_t i = 0; i < motion_count; i += 3) belief.remove_free(swept[i].voxels, swept[i].voxels.size());
}

/// The paper's probabilities of first contact, from |S(q_i, a) n PO| by waypoint.
std::vector<double> probabilities(const Shelf& shelf, std::size_t possibly_occupied,
                                  const std::vector<std::uint32_t>& entered) {
  std::vector<double> likelihood;
  for (const std::uint32_t count : entered)
    likelihood.push_back(solver::contact_likelihood(count, static_cast<double>(possibly_occupied),
                                                    shelf.model->target_voxels, shelf.model->diameter, {}));
  return solver::first_contact_probabilities(likelihood);
}

/// Ours and the baseline over all motions; `ours(i)` and `baseline(i)` give comparable answers.
template <typename Ours, typename Baseline>
Row timed(const std::string& work, const Shelf& shelf, Ours&& ours, Baseline&& baseline) {
  std::ostringstream note;
  std::size_t waypoints = 0, agreeing = 0;
  for (const action::MotionPtr& motion : shelf.motions) waypoints += motion->path.size();
  const auto [nx, ny, nz] = shelf.model->grid.shape();
  note << "voxels of " << 1e3 * shelf.model->grid.pitch() << " mm, " << nx << " x " << ny << " x " << nz << ", "
       << waypoints / motion_count << " configurations a motion, " << contact::kernel::fastest_voxel_kernel().name
       << "; baseline: voxel by voxel";
  std::cerr << work << ": " << note.str() << '\n';
  const auto over_all = [&shelf](auto&& run) {
    return [&shelf, &run] {
      for (std::size_t i = 0; i < shelf.motions.size(); ++i) run(i);
    };
  };
  Row row;
  row.work = work;
  row.pairs = shelf.motions.size();
  row.ours_s = thread_seconds("ours", seconds, over_all(ours));
  row.memory_mib = resident_mib();
  row.baseline_s = thread_seconds("baseline", seconds, over_all(baseline));
  for (std::size_t i = 0; i < shelf.motions.size(); ++i) agreeing += ours(i) == baseline(i);
  row.compared = row.pairs;
  row.agreeing = agreeing;
  if (agreeing < row.pairs) row.disagreements.push_back(std::to_string(row.pairs - agreeing) + " motions differ");
  row.note = note.str();
  return row;
}

/// Sweep and likelihood of an action that was not asked about before.
Row cold(const Shelf& shelf) {
  const Bitset& occupied = shelf.belief.possibly_occupied();
  const std::size_t count = occupied.count();
  return timed(
      "cold", shelf,
      [&](std::size_t i) {
        const SweptVoxels swept =
            contact::swept_voxels(shelf.task().bodies(), shelf.motions[i]->bodies, shelf.model->grid);
        return probabilities(shelf, count, contact::entered_of(swept, occupied));
      },
      [&](std::size_t i) {
        const SweptVoxels swept =
            plain::swept_voxels(shelf.task().bodies(), shelf.motions[i]->bodies, shelf.model->grid);
        return probabilities(shelf, count, plain::entered_of(swept, occupied));
      });
}

/// The likelihood once it is known what the action sweeps.
Row cached(const Shelf& shelf) {
  const Bitset& occupied = shelf.belief.possibly_occupied();
  const std::size_t count = occupied.count();
  return timed(
      "cached", shelf,
      [&](std::size_t i) { return probabilities(shelf, count, contact::entered_of(shelf.swept[i], occupied)); },
      [&](std::size_t i) { return probabilities(shelf, count, plain::entered_of(shelf.swept[i], occupied)); });
}

/// |S(q_i, a) n PO| alone.
Row overlap(const Shelf& shelf) {
  const Bitset& occupied = shelf.belief.possibly_occupied();
  return timed(
      "overlap", shelf, [&](std::size_t i) { return contact::entered_of(shelf.swept[i], occupied); },
      [&](std::size_t i) { return plain::entered_of(shelf.swept[i], occupied); });
}

std::size_t middle(const Shelf& shelf, std::size_t motion) { return shelf.motions[motion]->path.size() / 2; }

Bitset candidates(const Shelf& shelf, std::size_t i) {
  return contact::contact_candidates(shelf.task().bodies(), shelf.motions[i]->bodies, middle(shelf, i),
                                     shelf.model->grid, contact_slack);
}

/// The distance of every voxel to where a contact may have been, from which U follows.
Row dilation(const Shelf& shelf) {
  std::vector<Bitset> from;
  for (std::size_t i = 0; i < shelf.motions.size(); ++i) from.push_back(candidates(shelf, i));
  return timed(
      "dilation", shelf, [&](std::size_t i) { return contact::distance_to(from[i], shelf.model->grid); },
      [&](std::size_t i) { return plain::distance_to(from[i], shelf.model->grid); });
}

/// The belief after a contact halfway.
Row successor(const Shelf& shelf) {
  const auto free = [&](std::size_t i) {
    belief::VoxelBelief next = shelf.belief;
    next.remove_free(shelf.swept[i].voxels, shelf.swept[i].entered_by(middle(shelf, i) - 1));
    return next;
  };
  return timed(
      "successor", shelf,
      [&](std::size_t i) {
        belief::VoxelBelief next = free(i);
        next.add_contact(candidates(shelf, i));
        return next.possibly_occupied();
      },
      [&](std::size_t i) {
        return plain::after_contact(*shelf.model, free(i).possibly_occupied(), candidates(shelf, i));
      });
}

Work work(const std::string& name, Row (*row)(const Shelf&)) {
  return {name, [row](const Options&) {
            std::vector<Row> rows;
            for (const double pitch : pitches) rows.push_back(row(Shelf(pitch)));
            return rows;
          }};
}

}  // namespace

std::vector<Work> voxel_works() {
  return {work("cold", cold), work("cached", cached), work("overlap", overlap), work("dilation", dilation),
          work("successor", successor)};
}

}  // namespace tactus::bench
