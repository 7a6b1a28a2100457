// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "contact/facets.hpp"

namespace tactus::contact {

using geometry::Corners;
using geometry::Mesh;
using geometry::Pose;
using geometry::Vector3;

/// A part of one triangle of a surface, in a ball about its middle.
struct Piece {
  Corners corners;
  Vector3 centre = Vector3::Zero();
  double radius = 0.0;  ///< m
  int shell = 0;        ///< the connected shell it belongs to
  kernel::Facet facet{};
};

/// A surface cut into pieces, and a tree over them, sixteen to a block. Const.
class BallTree {
 public:
  /// Pieces are halved until a ball of `piece_radius` (m) holds each.
  BallTree(const Mesh& mesh, double piece_radius);

  const std::vector<kernel::Block>& blocks() const { return blocks_; }
  std::int32_t root() const { return root_; }  ///< the link to the root's block
  int shells() const { return shells_; }
  const std::vector<Piece>& pieces() const { return pieces_; }

 private:
  std::int32_t grow(std::size_t begin, std::size_t end, const geometry::TriangleTree& surface);
  Vector3 bound(std::size_t first, std::size_t last, kernel::Block& block, std::size_t lane) const;

  std::vector<Piece> pieces_;
  std::vector<kernel::Block> blocks_;
  std::int32_t root_ = 0;
  int shells_ = 0;
};

/// A pose, and a box, as the kernels take them.
kernel::Placement placement(const Pose& pose);
kernel::Extent extent(const geometry::Box& box);

}  // namespace tactus::contact
