// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/setting.hpp"
#include "contact/lattice.hpp"

namespace tactus::bench {

using contact::Lattice;
using contact::LatticeMotion;

/// Target poses and motions of the tool on one lattice. Its z goes into the wall.
struct LatticeSetting {
  Mesh target;
  std::shared_ptr<const contact::RobotBodies> bodies;
  Lattice lattice;
  std::vector<LatticeMotion> motions;
};

/// 40,000 poses: 20 x 20 x 20 at 5 mm, five turns; ten motions of twenty steps.
LatticeSetting small_lattice(std::uint64_t seed);

/// 7.5 million poses: the shelf's prior, 50 cm in either direction at 2 mm, all round in steps of 3 degrees.
LatticeSetting shelf_lattice(std::uint64_t seed);

}  // namespace tactus::bench
