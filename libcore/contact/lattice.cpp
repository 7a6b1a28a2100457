// SPDX-License-Identifier: BSD-3-Clause
#include "contact/lattice.hpp"

namespace tactus::contact {
namespace {

Pose placed(const Vector3& pitch, const std::array<int, 3>& at, const Eigen::Matrix3d& turn) {
  Pose pose = Pose::Identity();
  pose.linear() = turn;
  pose.translation() = pitch.cwiseProduct(Vector3(at[0], at[1], at[2]));
  return pose;
}

}  // namespace

std::size_t Lattice::cells() const { return static_cast<std::size_t>(count[0]) * rows(); }

std::size_t Lattice::index(const LatticePose& target) const {
  const auto row = static_cast<std::size_t>((target.turn * count[2] + target.at[2]) * count[1] + target.at[1]);
  return 64 * row_words() * row + static_cast<std::size_t>(target.at[0]);
}

LatticePose Lattice::cell(std::size_t index) const {
  const std::size_t row = index / (64 * row_words());
  const auto y = static_cast<std::size_t>(count[1]), z = static_cast<std::size_t>(count[2]);
  return {{static_cast<int>(index % (64 * row_words())), static_cast<int>(row % y), static_cast<int>(row / y % z)},
          static_cast<int>(row / y / z)};
}

Bitset Lattice::all() const {
  Bitset set(bits());
  for (std::size_t row = 0; row < rows(); ++row)
    for (int x = 0; x < count[0]; ++x) set.set(64 * row_words() * row + static_cast<std::size_t>(x));
  return set;
}

Pose Lattice::base_from_target(const LatticePose& target) const {
  return base_from_lattice * placed(pitch, target.at, target_turns[target.turn]);
}

Pose Lattice::base_from_tool(const LatticePose& tool) const {
  return base_from_lattice * placed(pitch / parts, tool.at, tool_turns[tool.turn]);
}

Lattice::Stand Lattice::stand(const LatticePose& tool) const {
  Stand stand{{}, tool.turn};
  for (int d = 0; d < 3; ++d) {
    const int part = (tool.at[d] % parts + parts) % parts;
    stand.at[d] = (tool.at[d] - part) / parts;
    stand.way = stand.way * parts + part;
  }
  return stand;
}

Vector3 Lattice::past(int way) const {
  return pitch.cwiseProduct(Vector3(way / (parts * parts) % parts, way / parts % parts, way % parts)) / parts;
}

Pose Lattice::target_from_tool(const std::array<int, 3>& offset, int target_turn, int way) const {
  Pose tool = placed(pitch, {}, tool_turns[turn_of(way)]);
  tool.translation() = past(way);
  return placed(pitch, offset, target_turns[target_turn]).inverse() * tool;
}

}  // namespace tactus::contact
