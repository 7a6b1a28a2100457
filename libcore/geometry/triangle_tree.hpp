// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "geometry/triangle.hpp"

namespace tactus::geometry {

/// A tree of boxes over a mesh's triangles. Const after construction, shared by any number of threads.
class TriangleTree {
 public:
  /// The mesh has at least one triangle with an area; it is copied, without those that have none.
  explicit TriangleTree(const Mesh& mesh);

  /// The distance from `p` to the surface, if it is below `bound`; else `bound`.
  double distance(const Vector3& p, double bound = 1e300) const;

  /// Whether the surface comes nearer to `p` than `reach` metres: sooner told than how near.
  bool is_nearer(const Vector3& p, double reach) const;

  /// Whether a triangle is no farther than `reach` metres from the surface, crosses or touches it.
  bool within(const Corners& triangle, double reach) const;

  /// The triangles no farther than `reach` metres from `p`, in rising order.
  std::vector<int> faces_near(const Vector3& p, double reach) const;

  /// Whether a triangle is no farther than `reach` metres from one of the surface's, crosses or touches it.
  bool within(const Corners& triangle, int face, double reach) const;

  const Corners& face(int index) const { return faces_[static_cast<std::size_t>(index)].corners; }

  /// Whether `p` lies inside one of the closed shells (nested or overlapping ones are united). Open shells contain
  /// nothing.
  bool contains(const Vector3& p) const;

  const Box& box() const { return nodes_.front().box; }

 private:
  struct Face {
    Corners corners;
    bool solid = false;  ///< of a closed shell
  };
  struct Node {
    Box box;
    int first = 0;  ///< of its triangles if a leaf, else its left child
    int count = 0;  ///< of its triangles; 0: an inner node whose children are `first` and `first + 1`
  };

  void build(int node, int begin, int end);
  int winding(const Vector3& p, const Vector3& direction) const;

  std::vector<Face> faces_;
  std::vector<Node> nodes_;
  bool solid_ = false;  ///< a shell is closed
};

}  // namespace tactus::geometry
