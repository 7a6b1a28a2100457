// SPDX-License-Identifier: BSD-3-Clause
#include "motion/connect.hpp"

#include <bit>
#include <cmath>

#include "motion/ompl_connect.hpp"
#include "motion/shortcut.hpp"

namespace tactus::motion {

using contact::KnownWorld;

namespace {

// Appends waypoints from the last one to `to`. Equal parts of the joints' way need not be equal parts of the bound,
// hence the recursion.
void append_densified(const KnownWorld& world, const JointVector& to, double step, JointPath& path) {
  const JointVector from = path.back();
  const double bound = world.displacement(from, to);
  if (!(bound > step)) {
    path.push_back(to);
    return;
  }
  const int parts = static_cast<int>(std::ceil(bound / step * (1.0 + 1e-9)));
  for (int i = 1; i < parts; ++i)
    append_densified(world, from + (to - from) * (static_cast<double>(i) / parts), step, path);
  append_densified(world, to, step, path);
}

ConnectOptions in_steps(ConnectOptions options, double coarseness) {
  options.step *= coarseness;
  return options;
}

// Made shorter, and validated at the step asked for.
std::optional<JointPath> smoothed(const KnownWorld& world, const JointPath& corners, const ConnectOptions& options,
                                  const support::Deadline& deadline) {
  support::Rng rng(support::mix(options.seed));
  JointPath path = densified(world, shortcut(world, corners, options.step, rng, deadline), options.step);
  if (!is_free(world, path)) return std::nullopt;
  return path;
}

}  // namespace

JointPath densified(const KnownWorld& world, const JointPath& path, double step) {
  JointPath dense;
  if (path.empty()) return dense;
  dense.push_back(path.front());
  for (std::size_t i = 1; i < path.size(); ++i) append_densified(world, path[i], step, dense);
  return dense;
}

// Coarse to fine: a collision is met early on, and a free path costs the same in any order.
bool is_free(const KnownWorld& world, const JointPath& path) {
  if (path.empty()) return true;
  if (!world.is_free(path.front())) return false;
  for (std::size_t stride = std::bit_floor(path.size()); stride > 0; stride /= 2)
    for (std::size_t i = stride; i < path.size(); i += 2 * stride)
      if (!world.is_free(path[i])) return false;
  return true;
}

std::optional<JointPath> straight_joint_path(const KnownWorld& world, const JointVector& from, const JointVector& to,
                                             double step) {
  JointPath path = densified(world, {from, to}, step);
  if (!is_free(world, path)) return std::nullopt;
  return path;
}

std::optional<JointPath> connect(const KnownWorld& world, const JointVector& from, const JointVector& to,
                                 const ConnectOptions& options, const support::Deadline& deadline) {
  if (!world.is_free(from) || !world.is_free(to)) return std::nullopt;
  if (std::optional<JointPath> straight = straight_joint_path(world, from, to, options.step)) return straight;
  // what no search finds in coarse steps, none finds in fine ones
  for (const double coarseness : {4.0, 1.0}) {
    const std::optional<JointPath> corners = rrt_connect(world, from, to, in_steps(options, coarseness), deadline);
    if (!corners) return std::nullopt;
    if (std::optional<JointPath> path = smoothed(world, *corners, options, deadline)) return path;
  }
  return std::nullopt;
}

}  // namespace tactus::motion
