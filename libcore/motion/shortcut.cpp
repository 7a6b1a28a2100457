// SPDX-License-Identifier: BSD-3-Clause
#include "motion/shortcut.hpp"

#include <algorithm>

#include "motion/connect.hpp"

namespace tactus::motion {

namespace {

constexpr int attempts = 60;
constexpr double worth_it = 1e-3;  // rad, of path length saved

// A point of the path: on the edge that begins at corner `edge`.
struct Place {
  std::size_t edge = 0;
  JointVector q;
};

double length(const JointPath& path, std::size_t first, std::size_t last) {
  double sum = 0.0;
  for (std::size_t i = first; i < last; ++i) sum += (path[i + 1] - path[i]).norm();
  return sum;
}

Place place_at(const JointPath& path, double distance) {
  std::size_t edge = 0;
  double edge_length = (path[1] - path[0]).norm();
  while (distance > edge_length && edge + 2 < path.size()) {
    distance -= edge_length;
    ++edge;
    edge_length = (path[edge + 1] - path[edge]).norm();
  }
  const double fraction = edge_length > 0.0 ? std::min(1.0, distance / edge_length) : 0.0;
  return {edge, path[edge] + fraction * (path[edge + 1] - path[edge])};
}

// The path with all between the two places left out.
JointPath without_between(const JointPath& path, const Place& from, const Place& to) {
  JointPath shorter(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(from.edge) + 1);
  shorter.push_back(from.q);
  shorter.push_back(to.q);
  shorter.insert(shorter.end(), path.begin() + static_cast<std::ptrdiff_t>(to.edge) + 1, path.end());
  return shorter;
}

// From each corner straight to the farthest later one that can be reached.
JointPath skip_corners(const contact::KnownWorld& world, const JointPath& path, double step) {
  JointPath kept{path.front()};
  for (std::size_t at = 0; at + 1 < path.size();) {
    std::size_t next = path.size() - 1;
    while (next > at + 1 && !straight_joint_path(world, path[at], path[next], step)) --next;
    kept.push_back(path[next]);
    at = next;
  }
  return kept;
}

}  // namespace

JointPath shortcut(const contact::KnownWorld& world, JointPath corners, double step, support::Rng& rng,
                   const support::Deadline& deadline) {
  if (corners.size() < 3) return corners;
  corners = skip_corners(world, corners, step);
  for (int attempt = 0; attempt < attempts && corners.size() > 2 && !deadline.spent(); ++attempt) {
    const double whole = length(corners, 0, corners.size() - 1);
    const auto [first, second] = std::minmax({rng.uniform(0.0, whole), rng.uniform(0.0, whole)});
    const Place from = place_at(corners, first), to = place_at(corners, second);
    if (from.edge == to.edge || second - first - (to.q - from.q).norm() < worth_it) continue;
    if (straight_joint_path(world, from.q, to.q, step)) corners = without_between(corners, from, to);
  }
  return corners;
}

}  // namespace tactus::motion
