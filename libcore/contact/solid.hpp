// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/triangle_tree.hpp"

namespace tactus::contact {

/// A mesh made ready for collision queries: a tree of boxes over its triangles [FCL], and its shells for the question
/// whether one body lies inside another. Closed shells count as solid, overlapping ones as their union; open ones are
/// surfaces. Immutable; copies share the tree.
class Solid {
 public:
  /// Throws `bad_mesh` for a mesh without a proper triangle, an index out of range, or a vertex that is not finite;
  /// `name` goes into the text.
  Solid(const geometry::Mesh& mesh, const std::string& name);

  const geometry::Box& box() const { return box_; }  ///< of the vertices, in the mesh's frame
  double reach() const { return reach_; }  ///< the greatest distance of a vertex from the origin of the mesh's frame, m

  /// Whether two solids touch or one holds a part of the other. Poses in any common frame, finite and orthonormal. For
  /// the same pair always pass the two in the same order: rounding can make the answer depend on it. Any thread.
  friend bool touching(const Solid& a, const geometry::Pose& root_from_a, const Solid& b,
                       const geometry::Pose& root_from_b);

 private:
  struct Tree;
  struct Shell {
    geometry::TriangleTree tree;
    geometry::Vector3 vertex;  ///< one of its own
  };
  bool holds_part_of(const Solid& other, const geometry::Pose& this_from_other) const;

  std::shared_ptr<const Tree> tree_;
  std::vector<Shell> shells_;
  geometry::Box box_;
  double reach_ = 0.0;
};

/// The axis-aligned box that holds `box` after it was moved by `pose`.
geometry::Box moved_box(const geometry::Box& box, const geometry::Pose& pose);

}  // namespace tactus::contact
