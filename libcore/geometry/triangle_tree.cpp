// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/triangle_tree.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::geometry {
namespace {

constexpr int leaf_size = 4;
constexpr int stack_size = 128;

/// Whether the ray meets the box (slabs; a direction without zero components).
bool meets(const Box& box, const Vector3& origin, const Vector3& inverse_direction) {
  const Vector3 a = (box.low - origin).cwiseProduct(inverse_direction);
  const Vector3 b = (box.high - origin).cwiseProduct(inverse_direction);
  return std::max(0.0, a.cwiseMin(b).maxCoeff()) <= a.cwiseMax(b).minCoeff();
}

/// Whether all of `b` is farther than `reach` from the plane of `a`, on one side of it.
bool a_plane_parts(const Corners& a, const Corners& b, double reach) {
  const Vector3 normal = (a[1] - a[0]).cross(a[2] - a[0]);
  const double least = 1.0000001 * reach * normal.norm();
  double low = 1e300, high = -1e300;
  for (const Vector3& corner : b) {
    const double side = normal.dot(corner - a[0]);
    low = std::min(low, side);
    high = std::max(high, side);
  }
  return low > least || high < -least;
}

}  // namespace

TriangleTree::TriangleTree(const Mesh& mesh) {
  for (const Mesh& shell : shells(merged_vertices(mesh))) {
    const bool solid = is_closed(shell);
    solid_ = solid_ || solid;
    for (const Triangle& t : shell.triangles)
      if (has_area(shell, t)) faces_.push_back({corners(shell, t), solid});
  }
  nodes_.reserve(2 * faces_.size());
  nodes_.emplace_back();
  build(0, 0, static_cast<int>(faces_.size()));
}

void TriangleTree::build(int node, int begin, int end) {
  Box box, centres;
  for (int i = begin; i < end; ++i) {
    const Box of_face = bounds(faces_[i].corners);
    box.add(of_face);
    centres.add(of_face.centre());
  }
  nodes_[node].box = box;
  if (end - begin <= leaf_size) {
    nodes_[node].first = begin;
    nodes_[node].count = end - begin;
    return;
  }
  int axis = 0;
  centres.size().maxCoeff(&axis);
  const int middle = (begin + end) / 2;
  std::nth_element(faces_.begin() + begin, faces_.begin() + middle, faces_.begin() + end,
                   [axis](const Face& a, const Face& b) {
                     return bounds(a.corners).centre()[axis] < bounds(b.corners).centre()[axis];
                   });
  const int left = static_cast<int>(nodes_.size());
  nodes_[node].first = left;
  nodes_.emplace_back();
  nodes_.emplace_back();
  build(left, begin, middle);
  build(left + 1, middle, end);
}

double TriangleTree::distance(const Vector3& p, double bound) const {
  std::array<std::pair<double, int>, stack_size> stack;
  int top = 0;
  stack[top++] = {nodes_[0].box.distance(p), 0};
  while (top > 0) {
    const auto [lower, index] = stack[--top];
    if (lower >= bound) continue;
    const Node& node = nodes_[index];
    if (node.count > 0) {
      for (int i = node.first; i < node.first + node.count; ++i)
        bound = std::min(bound, (closest_point(faces_[i].corners, p) - p).norm());
      continue;
    }
    std::pair<double, int> near{nodes_[node.first].box.distance(p), node.first};
    std::pair<double, int> far{nodes_[node.first + 1].box.distance(p), node.first + 1};
    if (far.first < near.first) std::swap(near, far);
    stack[top++] = far;
    stack[top++] = near;
  }
  return bound;
}

bool TriangleTree::is_nearer(const Vector3& p, double reach) const {
  std::array<int, stack_size> stack;
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const Node& node = nodes_[stack[--top]];
    if (node.box.distance(p) >= reach) continue;
    if (node.count == 0) {
      stack[top++] = node.first;
      stack[top++] = node.first + 1;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i)
      if ((closest_point(faces_[i].corners, p) - p).norm() < reach) return true;
  }
  return false;
}

bool TriangleTree::within(const Corners& triangle, double reach) const {
  const Box near = bounds(triangle).inflated(reach);
  std::array<int, stack_size> stack;
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const Node& node = nodes_[stack[--top]];
    if (!node.box.overlaps(near)) continue;
    if (node.count == 0) {
      stack[top++] = node.first;
      stack[top++] = node.first + 1;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i)
      if (bounds(faces_[i].corners).overlaps(near) && within(triangle, i, reach)) return true;
  }
  return false;
}

bool TriangleTree::within(const Corners& triangle, int face, double reach) const {
  const Corners& other = faces_[face].corners;
  return !a_plane_parts(other, triangle, reach) && !a_plane_parts(triangle, other, reach) &&
         geometry::distance(other, triangle) <= reach;
}

std::vector<int> TriangleTree::faces_near(const Vector3& p, double reach) const {
  std::vector<int> found, stack{0};
  while (!stack.empty()) {
    const Node& node = nodes_[stack.back()];
    stack.pop_back();
    if (node.box.distance(p) > reach) continue;
    if (node.count == 0) stack.insert(stack.end(), {node.first + 1, node.first});
    for (int i = node.first; i < node.first + node.count; ++i)
      if ((closest_point(faces_[i].corners, p) - p).norm() <= reach) found.push_back(i);
  }
  std::sort(found.begin(), found.end());
  return found;
}

int TriangleTree::winding(const Vector3& p, const Vector3& direction) const {
  const Vector3 inverse = direction.cwiseInverse();
  std::array<int, stack_size> stack;
  int top = 0, sum = 0;
  stack[top++] = 0;
  while (top > 0) {
    const Node& node = nodes_[stack[--top]];
    if (!meets(node.box, p, inverse)) continue;
    if (node.count == 0) {
      stack[top++] = node.first;
      stack[top++] = node.first + 1;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i)
      if (faces_[i].solid) sum += crossing(faces_[i].corners, p, direction);
  }
  return sum;
}

bool TriangleTree::contains(const Vector3& p) const {
  if (!solid_ || !box().contains(p)) return false;
  const int votes = (winding(p, {0.5773, 0.6241, 0.5265}) > 0) + (winding(p, {-0.7071, 0.3011, 0.6398}) > 0);
  if (votes != 1) return votes == 2;
  return winding(p, {0.2718, -0.8165, -0.5095}) > 0;
}

}  // namespace tactus::geometry
