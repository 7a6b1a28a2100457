// SPDX-License-Identifier: BSD-3-Clause
#include "action/archive.hpp"

#include <bit>
#include <cmath>

#include "action/fingerprint.hpp"
#include "belief/belief.hpp"
#include "support/error.hpp"

namespace tactus::belief {
namespace {

using support::ByteReader;
using support::ByteWriter;

constexpr support::Seal seal{{'T', 'A', 'C', 'T', 'U', 'S', '-', 'B'}, 7};

/// Of the scene, the prior, and the options that shape the belief.
std::uint64_t fingerprint(const Model& model) {
  const Options& options = model.options;
  action::Fingerprint print;
  print.add(model.task->scene());
  print.add(model.task->scene().prior);
  print.add(model.task->options().contact_margin);
  print.add(model.task->options().stop_tolerance);
  const action::Sensing& sensing = model.task->options().sensing;
  for (const double allowed :
       {sensing.stopping_distance, sensing.encoder_error, sensing.missed_contacts, sensing.false_contacts})
    print.add(allowed);
  print.add(static_cast<std::uint64_t>(options.kind));
  print.add(options.voxel_size);
  print.add(options.delta);
  print.add(options.cells.position);
  print.add(options.cells.angle);
  print.add(options.cells.most);
  print.add(options.cells.most_at_first);
  print.add(options.cells.finest_radius);
  return print.sum();
}

void write_set(ByteWriter& to, const Bitset& set) {
  for (const std::uint64_t word : set.words()) to.u64(word);
}

Bitset read_set(ByteReader& from, std::size_t size, const char* field) {
  Bitset set(size);
  for (std::size_t w = 0; w < set.words().size(); ++w)
    for (std::uint64_t rest = from.u64(field); rest != 0; rest &= rest - 1) {
      const std::size_t member = 64 * w + static_cast<std::size_t>(std::countr_zero(rest));
      if (member >= size) from.fail(field, std::to_string(member), "less than " + std::to_string(size));
      set.set(member);
    }
  return set;
}

void write_voxels(ByteWriter& to, const VoxelBelief& voxels) {
  write_set(to, voxels.possibly_occupied());
  to.u64(voxels.contacts().size());
  for (const ContactRecord& record : voxels.contacts()) write_set(to, record.candidates);
}

VoxelBelief read_voxels(ByteReader& from, const std::shared_ptr<const VoxelModel>& model) {
  const std::size_t size = model->grid.size();
  Bitset possibly_occupied = read_set(from, size, "possibly occupied voxels");
  if (possibly_occupied.none()) from.fail("possibly occupied voxels", "none", "at least one");
  std::vector<Bitset> candidates(from.count(8 * possibly_occupied.words().size(), "contacts"));
  for (Bitset& set : candidates) set = read_set(from, size, "contact candidates");
  return VoxelBelief::restored(model, std::move(possibly_occupied), std::move(candidates));
}

void write_cell(ByteWriter& to, const Cell& cell) {
  for (const double value : cell.centre) to.f64(value);
  for (const std::uint8_t splits : cell.splits) to.u8(splits);
}

void write_cells(ByteWriter& to, const CellBelief& cells) {
  to.u8(cells.grid() ? 1 : 0);
  if (cells.grid()) return write_set(to, cells.grid()->members());
  to.u64(cells.size());
  cells.for_each([&](const Cell& cell) { write_cell(to, cell); });
}

void write_weighed(ByteWriter& to, const WeighedCells& cells) {
  action::write_sensing(to, cells.sensing());
  to.u64(cells.all().size());
  for (const WeighedCells::Weighed& weighed : cells.all()) {
    write_cell(to, weighed.cell);
    to.f64(weighed.floor);
    to.u32(weighed.floor_of);
    to.u64(weighed.doubts.size());
    for (const Doubt& doubt : weighed.doubts) {
      to.u32(doubt.trace);
      to.u8(static_cast<std::uint8_t>(doubt.fault));
      to.u8(doubt.is_certain ? 1 : 0);
    }
  }
}

Cell read_cell(ByteReader& from, const scene::Prior& prior) {
  Cell cell;
  for (int d = 0; d < 6; ++d) {
    cell.centre[d] = from.f64("cell centre");
    if (!(std::abs(cell.centre[d] - prior.centre[d]) <= 0.5 * prior.width[d] + 1e-9))
      from.fail("cell centre", std::to_string(cell.centre[d]), "a number inside the prior");
  }
  for (std::uint8_t& splits : cell.splits) splits = from.u8("cell splits");
  if (cell.all_splits() > most_splits)
    from.fail("cell splits", std::to_string(cell.all_splits()), "at most " + std::to_string(most_splits));
  return cell;
}

CellBelief read_cells(ByteReader& from, const Model& model) {
  const Task& task = *model.task;
  const CellOptions& options = model.options.cells;
  if (from.flag("grid of cells")) {
    const CellBelief whole(task, options);
    if (!whole.grid()) from.fail("grid of cells", "one", "a list, the prior having few cells");
    Bitset members = read_set(from, whole.grid()->members().size(), "cells");
    if (2 * members.count() <= options.most)
      from.fail("grid of cells", std::to_string(members.count()) + " cells", "a list of so few");
    return CellBelief::restored(task, options, std::move(members));
  }
  std::vector<Cell> cells(from.count(6 * (8 + 1), "cells"));
  if (cells.empty()) from.fail("cells", "none", "at least one");
  for (Cell& cell : cells) cell = read_cell(from, task.scene().prior);
  return CellBelief::restored(task, options, std::move(cells));
}

std::uint16_t read_trace_index(ByteReader& from, std::size_t end) {
  const std::uint32_t trace = from.u32("doubted observation");
  if (trace >= end) from.fail("doubted observation", std::to_string(trace), "less than " + std::to_string(end));
  return static_cast<std::uint16_t>(trace);
}

Doubt read_doubt(ByteReader& from, std::size_t traces) {
  const std::uint16_t trace = read_trace_index(from, traces);
  const std::uint8_t fault = from.u8("fault of an observation");
  if (fault > static_cast<std::uint8_t>(Fault::inside))
    from.fail("fault of an observation", std::to_string(fault), "0, 1 or 2");
  return {trace, static_cast<Fault>(fault), from.flag("certainty of a fault")};
}

WeighedCells read_weighed(ByteReader& from, const Model& model, const std::vector<Trace>& history) {
  const action::Sensing sensing = action::read_sensing(from, "errors of observations");
  std::vector<WeighedCells::Weighed> cells(from.count(6 * (8 + 1) + 8 + 4 + 8, "weighed cells"));
  if (cells.empty()) from.fail("weighed cells", "none", "at least one");
  for (WeighedCells::Weighed& weighed : cells) {
    weighed.cell = read_cell(from, model.task->scene().prior);
    weighed.floor = from.f64("floor of a cell");
    if (!(weighed.floor >= 0.0)) from.fail("floor of a cell", std::to_string(weighed.floor), "at least 0 bits");
    weighed.floor_of = read_trace_index(from, history.size() + 1);
    weighed.doubts.resize(from.count(4 + 1 + 1, "doubts"));
    for (Doubt& doubt : weighed.doubts) doubt = read_doubt(from, history.size());
  }
  WeighedCells all(*model.task, sensing, model.options.cells);
  if (!all.restore(std::move(cells), history)) from.fail("weighed cells", "none that is possible", "at least one");
  return all;
}

void write_trace(ByteWriter& to, const Trace& trace) {
  to.u64(trace.action_id);
  to.u32(static_cast<std::uint32_t>(trace.kind));
  to.u8(trace.contact ? 1 : 0);
  to.u8(trace.doubted ? 1 : 0);
  to.u64(trace.outcome);
  to.u64(trace.touch);
  for (const double value : {trace.slack, trace.travel, trace.error}) to.f64(value);
  action::write_path(to, trace.path);
}

Trace read_trace(ByteReader& from, const Task& task) {
  Trace trace;
  trace.action_id = from.u64("action of an observation");
  trace.kind = action::read_kind(from, "kind of an observation's action");
  trace.contact = from.flag("contact of an observation");
  trace.doubted = from.flag("doubt of an observation");
  trace.outcome = static_cast<std::size_t>(from.u64("outcome of an observation"));
  trace.touch = static_cast<std::size_t>(from.u64("touch of an observation"));
  for (double* value : {&trace.slack, &trace.travel, &trace.error}) {
    *value = from.finite("slack of an observation");
    if (*value < 0.0) from.fail("slack of an observation", std::to_string(*value), "not less than 0");
  }
  trace.path = action::read_path(from, task.scene().robot->dof(), trace.contact ? 2 : 1, "path of an observation");
  if (trace.contact ? trace.touch == 0 || trace.touch >= trace.path.size() : trace.touch != trace.path.size())
    from.fail("touch of an observation", std::to_string(trace.touch),
              (trace.contact ? "at least 1 and less than " : "") + std::to_string(trace.path.size()));
  trace.bodies = BodyPath(task.bodies(), trace.path);
  return trace;
}

}  // namespace

std::vector<std::uint8_t> Belief::save() const {
  ByteWriter to(seal);
  to.u64(fingerprint(*model_));
  action::write_joints(to, q_);
  to.u8(static_cast<std::uint8_t>(health_));
  to.u8(is_goal_ ? 1 : 0);
  to.u32(standstill_);
  to.u64(history_.size());
  for (const Trace& trace : history_) write_trace(to, trace);
  to.u8(cells_ ? 1 : 0);
  to.u8(weighed_ ? 1 : 0);
  if (weighed_)
    write_weighed(to, *weighed_);
  else if (cells_)
    write_cells(to, *cells_);
  else
    write_voxels(to, *voxels_);
  return to.sealed();
}

Belief Belief::restore(std::shared_ptr<const Model> model, const std::uint8_t* bytes, std::size_t size) {
  ByteReader from(seal, "saved belief", bytes, size);
  if (from.u64("fingerprint") != fingerprint(*model))
    throw support::Error(support::Status::wrong_scenario,
                         "saved belief: found one of another scenario, expected the same target, seats, tolerances, "
                         "tool, world, prior, joints and belief options");
  Belief belief(std::move(model));
  const Task& task = belief.task();
  belief.q_ = action::read_joints(from, task.scene().robot->dof(), "configuration");
  belief.health_ = from.flag("health") ? Health::contradicted : Health::good;
  belief.is_goal_ = from.flag("goal");
  belief.standstill_ = from.u32("observations that told nothing");
  const std::size_t observations = from.count(8 + 4 + 2 + 8 + 8 + 3 * 8 + 8, "observations");
  for (std::size_t i = 0; i < observations; ++i) belief.history_.push_back(read_trace(from, task));
  const bool in_pose_phase = from.flag("phase");
  if (!in_pose_phase && belief.model_->options.kind == Kind::particles)
    from.fail("phase", "voxels", "poses, the belief being of particles");
  const bool weighs = from.flag("weighed cells");
  if (weighs && !in_pose_phase) from.fail("weighed cells", "some", "none, the phase being that of voxels");
  if (weighs) {
    belief.weighed_.emplace(read_weighed(from, belief.model(), belief.history_));
    belief.cells_ = CellBelief::weighed(task, belief.model_->options.cells, belief.weighed_->cells());
  } else if (in_pose_phase)
    belief.cells_.emplace(read_cells(from, belief.model()));
  else
    belief.voxels_.emplace(read_voxels(from, belief.model_->voxels));
  from.finish();
  return belief;
}

}  // namespace tactus::belief
