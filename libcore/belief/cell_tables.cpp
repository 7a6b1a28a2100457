// SPDX-License-Identifier: BSD-3-Clause
#include "belief/cell_tables.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::belief {
namespace {

using contact::Lattice;
using contact::LatticeMotion;
using contact::LatticePose;

constexpr std::size_t tool = 0;
constexpr double off_site = 1e-5;  // m that a point of a tool may be off where it would be on its site
constexpr double usual_pitch = 0.004;
constexpr std::size_t most_bytes = std::size_t{256} << 20;
constexpr support::Seal seal{{'T', 'A', 'C', 'T', 'U', 'S', '-', 'T'}, 1};

/// Of a grid's cells in x, y, z (m). Where the prior has no width, there is one cell, as wide as the others.
Vector3 pitch_of(const CellShape& shape) {
  Vector3 pitch = 2.0 * Vector3(shape.half[0], shape.half[1], shape.half[2]);
  const double widest = pitch.maxCoeff() > 0.0 ? pitch.maxCoeff() : usual_pitch;
  for (double& width : pitch)
    if (width <= 0.0) width = widest;
  return pitch;
}

Vector3 first_centre(const CellShape& shape) {
  Vector3 centre;
  for (int d = 0; d < 3; ++d) centre[d] = shape.corner[d] + shape.half[d];
  return centre;
}

int parts_of(const CellShape& shape, double step) {
  return std::max(1, static_cast<int>(std::ceil(pitch_of(shape).maxCoeff() / step - 1e-6)));
}

/// With the base's axes in the order in which the grid counts its cells.
Lattice lattice_of(const Task& task, const CellShape& shape) {
  const std::array<int, 6> order = shape.order();
  Lattice lattice;
  lattice.base_from_lattice.translation() = first_centre(shape);
  const Vector3 pitch = pitch_of(shape);
  for (int k = 0; k < 3; ++k) {
    const int d = order[5 - k];
    lattice.base_from_lattice.linear().col(k) = Vector3::Unit(d);
    lattice.pitch[k] = pitch[d];
    lattice.count[k] = shape.count[d];
  }
  lattice.parts = static_cast<int>(std::lround(pitch.x() / task.options().sites->step.x()));
  const Eigen::Matrix3d lattice_from_base = lattice.base_from_lattice.linear().transpose();
  lattice.target_turns.clear();
  PoseVector turn{};
  const auto centre = [&shape](int d, int i) { return shape.corner[d] + shape.half[d] * (2.0 * i + 1.0); };
  for (int roll = 0; roll < shape.count[3]; ++roll)
    for (int pitching = 0; pitching < shape.count[4]; ++pitching)
      for (int yaw = 0; yaw < shape.count[5]; ++yaw) {
        turn[3] = centre(3, roll), turn[4] = centre(4, pitching), turn[5] = centre(5, yaw);
        lattice.target_turns.push_back(lattice_from_base * geometry::pose_from(turn).linear());
      }
  lattice.tool_turns = {lattice_from_base * task.frame().base_from_tool(Vector3::Zero()).linear()};
  return lattice;
}

/// How far a point of the target may be from where it is at a cell's central pose, and what may be off besides.
double slack_of(const Task& task, const CellShape& shape) {
  return scene::cell_radius(shape.half, task.target_reach()) + task.options().contact_margin +
         task.options().sensing.encoder_error;
}

/// Of the waypoints at which a contact may have been (`Trace::slack`).
double stop_slack(const Task& task) { return task.options().sensing.stopping_distance > 0.0 ? touch_spacing : 0.0; }

bool is_near(const Trace& trace, std::size_t body, std::size_t waypoint) {
  const BodyPath::Range& near = trace.bodies.near_region(body);
  return waypoint >= near.begin && waypoint < near.end;
}

}  // namespace

action::ToolSites CellTables::sites(const CellShape& shape, double step) {
  return {first_centre(shape), pitch_of(shape) / parts_of(shape, step)};
}

CellTables::CellTables(const Task& task, const CellShape& shape)
    : task_(task),
      shape_(shape),
      lattice_(lattice_of(task, shape)),
      lattice_from_base_(lattice_.base_from_lattice.inverse()),
      near_site_(0.5 * task.options().sites->step.maxCoeff() + off_site),
      surely_(task.target_contact(), lattice_, -slack_of(task, shape) - off_site, most_bytes),
      perhaps_(task.target_contact(), lattice_, slack_of(task, shape) + near_site_ + stop_slack(task), most_bytes) {}

/// Where the tool stands at a waypoint, if no point of it is farther than `within` from where it is at that site.
std::optional<LatticePose> CellTables::site(const Trace& trace, std::size_t waypoint, double within) const {
  const Pose& base_from_tool = trace.bodies.base_from_body(waypoint, tool);
  const Vector3 steps =
      lattice_.parts * (lattice_from_base_ * base_from_tool.translation()).cwiseQuotient(lattice_.pitch);
  LatticePose pose;
  for (int d = 0; d < 3; ++d) pose.at[static_cast<std::size_t>(d)] = static_cast<int>(std::lround(steps[d]));
  const geometry::Box& box = task_.bodies().body(tool).tree().box();
  const double off = geometry::largest_displacement(box, lattice_.base_from_tool(pose), base_from_tool);
  return off <= within ? std::optional(pose) : std::nullopt;
}

bool CellTables::links_near(const Trace& trace, std::size_t waypoint) const {
  for (std::size_t body = 0; body < task_.bodies().size(); ++body)
    if (body != tool && is_near(trace, body, waypoint)) return true;
  return false;
}

std::vector<LatticePose> CellTables::free_sites(const Trace& trace) const {
  std::vector<LatticePose> sites;
  for (std::size_t i = 0; i < trace.touch; ++i)
    if (is_near(trace, tool, i))
      if (const auto pose = site(trace, i, off_site)) sites.push_back(*pose);
  return sites;
}

/// Empty if one of the waypoints at which the contact may have been is far from any, or a link is near there.
std::vector<LatticePose> CellTables::touch_sites(const Trace& trace) const {
  std::vector<LatticePose> sites;
  for (std::size_t i = trace.touch; i < trace.path.size(); ++i) {
    const auto pose = site(trace, i, near_site_);
    if (!pose || links_near(trace, i)) return {};
    sites.push_back(*pose);
  }
  return sites;
}

/// Calls `visit(first, mask)` for the cells `first + i` of every bit i of the mask: those that the tables say are
/// touched at one of some sites.
template <typename Visit>
void CellTables::for_each_touched(const contact::ContactTables& tables, std::vector<LatticePose> sites,
                                  Visit&& visit) const {
  if (sites.empty()) return;
  sites.insert(sites.begin(), sites.front());
  const auto row_length = static_cast<std::size_t>(lattice_.count[0]);
  tables.first_contacts(sites).for_each_touched([&](std::size_t word, std::uint64_t cells) {
    const std::size_t row = word / lattice_.row_words(), column = 64 * (word % lattice_.row_words());
    visit(row * row_length + column, cells);
  });
}

void CellTables::sift(const Trace& trace, Bitset& members) const {
  for_each_touched(surely_, free_sites(trace),
                   [&](std::size_t first, std::uint64_t mask) { members.reset_bits(first, mask); });
  const std::vector<LatticePose> touch = touch_sites(trace);
  if (touch.empty()) return;
  Bitset touched(members.size());
  for_each_touched(perhaps_, touch, [&](std::size_t first, std::uint64_t mask) { touched.set_bits(first, mask); });
  members &= touched;
}

Trace CellTables::rest(const Trace& trace) const {
  Trace rest = trace;
  rest.path.clear();
  for (std::size_t i = 0; i < trace.touch; ++i)
    if (links_near(trace, i) || (is_near(trace, tool, i) && !site(trace, i, off_site)))
      rest.path.push_back(trace.path[i]);
  rest.touch = rest.path.size();
  rest.contact = trace.contact && touch_sites(trace).empty();
  if (rest.contact)
    rest.path.insert(rest.path.end(), trace.path.begin() + static_cast<std::ptrdiff_t>(trace.touch), trace.path.end());
  rest.bodies = BodyPath(task_.bodies(), rest.path);
  return rest;
}

std::vector<std::uint8_t> CellTables::save() const {
  support::ByteWriter out(seal);
  for (const auto* tables : {&surely_, &perhaps_}) {
    const std::vector<std::uint8_t> bytes = tables->save();
    out.u64(bytes.size());
    for (const std::uint8_t byte : bytes) out.u8(byte);
  }
  return out.sealed();
}

void CellTables::restore(const std::uint8_t* bytes, std::size_t size) const {
  support::ByteReader in(seal, "saved tables", bytes, size);
  std::array<std::vector<std::uint8_t>, 2> saved;
  for (std::vector<std::uint8_t>& part : saved) {
    part.resize(in.count(1, "tables"));
    for (std::uint8_t& byte : part) byte = in.u8("tables");
  }
  in.finish();
  const std::vector<std::uint8_t> before = surely_.save();
  surely_.restore(saved[0].data(), saved[0].size());
  try {
    perhaps_.restore(saved[1].data(), saved[1].size());
  } catch (...) {
    surely_.restore(before.data(), before.size());
    throw;
  }
}

}  // namespace tactus::belief
