// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bench/carrier.hpp"
#include "contact/body_path.hpp"

namespace tactus::bench {

using geometry::Mesh;

struct Target {
  std::string name;
  Mesh mesh;
};

/// Motions and poses, every one of which is asked about with every other: ten motions of 20 cm, and as many poses as
/// make up the pairs, random over 30 cm in x, y and z and over 30 degrees in yaw and roll.
struct Setting {
  Target target;
  std::shared_ptr<const contact::RobotBodies> bodies;
  std::vector<std::vector<JointVector>> motions;
  std::vector<Pose> base_from_target;

  std::size_t pairs() const { return motions.size() * base_from_target.size(); }
  std::size_t n() const { return motions.front().size() - 1; }  ///< configurations tested: the start is not
};

/// The plug of the shelf against `target`; the tool turns by `turn` (rad) on its way.
Setting setting(const Carrier& carrier, Target target, double turn, std::size_t n, std::size_t pairs,
                std::uint64_t seed);

Target socket();

/// The plug of the shelf as the only body, wherever it may be.
std::shared_ptr<const contact::RobotBodies> plug_alone();

}  // namespace tactus::bench
