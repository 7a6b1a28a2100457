// SPDX-License-Identifier: BSD-3-Clause
#include "bench/shelf_lattice.hpp"

#include <cmath>
#include <numbers>

namespace tactus::bench {
namespace {

using contact::LatticePose;
using geometry::Vector3;
using support::Rng;

constexpr std::size_t motion_count = 10;
constexpr int n = 20;
constexpr double tip = 0.16;  // m from the tool link to the plug's pins
constexpr double degree = std::numbers::pi / 180.0;

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
  const int stride = static_cast<int>(std::lround(0.01 / lattice.pitch.x()));
  const int inwards = std::max(1, static_cast<int>(std::lround(0.002 / lattice.pitch.z())));
  std::vector<LatticeMotion> motions;
  for (std::size_t i = 0; i < motion_count; ++i) {
    LatticePose from;
    for (std::size_t d = 0; d < 2; ++d)
      from.at[d] = static_cast<int>(rng.below(static_cast<std::uint64_t>(lattice.count[d])));
    from.at[2] = lattice.count[2] / 2 + static_cast<int>(std::lround((depth - tip) / lattice.pitch.z()));
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

}  // namespace

LatticeSetting small_lattice(std::uint64_t seed) {
  Lattice lattice;
  lattice.pitch.setConstant(0.005);
  lattice.count = {20, 20, 20};
  lattice.target_turns = target_turns(5, 7.0 * degree);
  lattice.tool_turns = {tool_turn(0.017), tool_turn(-0.031)};
  return setting_on(std::move(lattice), 0.0, seed);
}

LatticeSetting shelf_lattice(std::uint64_t seed) {
  Lattice lattice;
  lattice.pitch.setConstant(0.002);
  lattice.count = {250, 250, 1};
  lattice.target_turns = target_turns(120, 3.0 * degree);
  lattice.tool_turns = {tool_turn(0.017)};
  return setting_on(std::move(lattice), -0.005, seed);
}

}  // namespace tactus::bench
