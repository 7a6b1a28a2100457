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
constexpr std::size_t most_bytes = std::size_t{512} << 20;

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

/// What the tool must be deflated by for every pose of a cell to be touched where the central one is.
double depth_of(const Task& task, const CellShape& shape) {
  return scene::cell_radius(shape.half, task.target_reach()) + task.options().contact_margin +
         task.options().sensing.encoder_error + off_site;
}

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
      touched_(task.target_contact(), lattice_of(task, shape), -depth_of(task, shape), most_bytes),
      lattice_from_base_(touched_.lattice().base_from_lattice.inverse()) {}

/// Where the tool stands at a waypoint, if that is a site.
std::optional<LatticePose> CellTables::site(const Trace& trace, std::size_t waypoint) const {
  const Lattice& lattice = touched_.lattice();
  const Pose& base_from_tool = trace.bodies.base_from_body(waypoint, tool);
  const Vector3 steps =
      lattice.parts * (lattice_from_base_ * base_from_tool.translation()).cwiseQuotient(lattice.pitch);
  LatticePose pose;
  for (int d = 0; d < 3; ++d) pose.at[static_cast<std::size_t>(d)] = static_cast<int>(std::lround(steps[d]));
  const geometry::Box& box = task_.bodies().body(tool).tree().box();
  const double off = geometry::largest_displacement(box, lattice.base_from_tool(pose), base_from_tool);
  return off <= off_site ? std::optional(pose) : std::nullopt;
}

/// Whether the tables tell all there is to know of a waypoint.
bool CellTables::answers(const Trace& trace, std::size_t waypoint) const {
  for (std::size_t body = 0; body < task_.bodies().size(); ++body)
    if (body != tool && is_near(trace, body, waypoint)) return false;
  return !is_near(trace, tool, waypoint) || site(trace, waypoint);
}

void CellTables::sift(const Trace& trace, Bitset& members) const {
  LatticeMotion sites;
  for (std::size_t i = 0; i < trace.touch; ++i)
    if (is_near(trace, tool, i))
      if (const auto pose = site(trace, i)) sites.push_back(*pose);
  if (sites.empty()) return;
  sites.insert(sites.begin(), sites.front());
  const Lattice& lattice = touched_.lattice();
  const auto row_length = static_cast<std::size_t>(lattice.count[0]);
  touched_.first_contacts(sites).for_each_touched([&](std::size_t word, std::uint64_t cells) {
    const std::size_t row = word / lattice.row_words(), column = 64 * (word % lattice.row_words());
    members.reset_bits(row * row_length + column, cells);
  });
}

Trace CellTables::rest(const Trace& trace) const {
  Trace rest = trace;
  rest.path.clear();
  for (std::size_t i = 0; i < trace.touch; ++i)
    if (!answers(trace, i)) rest.path.push_back(trace.path[i]);
  rest.touch = rest.path.size();
  rest.path.insert(rest.path.end(), trace.path.begin() + static_cast<std::ptrdiff_t>(trace.touch), trace.path.end());
  rest.bodies = BodyPath(task_.bodies(), rest.path);
  return rest;
}

}  // namespace tactus::belief
