// SPDX-License-Identifier: BSD-3-Clause
#include "contact/body.hpp"

#include <algorithm>

namespace tactus::contact {
namespace {

using geometry::Sphere;

constexpr std::size_t field_samples = 60'000;

struct Piece {
  Vector3 centre;
  double radius;
  int triangle;
  int shell;
};

Sphere ball_of(const Corners& c) {
  const Vector3 centre = (c[0] + c[1] + c[2]) / 3.0;
  return {centre, std::max({(c[0] - centre).norm(), (c[1] - centre).norm(), (c[2] - centre).norm()})};
}

/// Halves the longest edge until each piece fits a ball.
void cut(const Corners& c, int triangle, int shell, double leaf_radius, std::vector<Piece>& pieces) {
  const Sphere ball = ball_of(c);
  if (ball.radius <= leaf_radius) {
    pieces.push_back({ball.centre, ball.radius, triangle, shell});
    return;
  }
  int longest = 0;
  for (int i = 1; i < 3; ++i)
    if ((c[(i + 1) % 3] - c[i]).norm() > (c[(longest + 1) % 3] - c[longest]).norm()) longest = i;
  const Vector3 a = c[longest], b = c[(longest + 1) % 3], apex = c[(longest + 2) % 3], middle = 0.5 * (a + b);
  cut({a, middle, apex}, triangle, shell, leaf_radius, pieces);
  cut({middle, b, apex}, triangle, shell, leaf_radius, pieces);
}

/// Appends the subtree over pieces [begin, end) in depth-first order.
void grow(std::vector<Piece>& pieces, std::size_t begin, std::size_t end, std::vector<SurfaceBall>& balls) {
  if (end - begin == 1) {
    const Piece& piece = pieces[begin];
    balls.push_back({piece.centre, piece.radius, static_cast<int>(balls.size()) + 1, piece.triangle, piece.shell});
    return;
  }
  geometry::Box centres;
  for (std::size_t i = begin; i < end; ++i) centres.add(pieces[i].centre);
  SurfaceBall ball;
  ball.centre = centres.centre();
  for (std::size_t i = begin; i < end; ++i)
    ball.radius = std::max(ball.radius, (pieces[i].centre - ball.centre).norm() + pieces[i].radius);
  const std::size_t self = balls.size();
  balls.push_back(ball);

  int axis = 0;
  centres.size().maxCoeff(&axis);
  const std::size_t middle = (begin + end) / 2;
  const auto at = [&](std::size_t i) { return pieces.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end),
                   [axis](const Piece& a, const Piece& b) { return a.centre[axis] < b.centre[axis]; });
  grow(pieces, begin, middle, balls);
  grow(pieces, middle, end, balls);
  balls[self].next = static_cast<int>(balls.size());
}

double field_spacing(const Mesh& mesh) {
  const Vector3 size = geometry::bounds(mesh).size();
  return std::max(0.002, std::cbrt(size.prod() / static_cast<double>(field_samples)));
}

}  // namespace

Body::Body(const Mesh& mesh, double leaf_radius)
    : mesh_(mesh),
      tree_(mesh),
      sphere_(geometry::bounding_sphere(mesh)),
      field_(std::make_shared<geometry::DistanceField>(mesh, field_spacing(mesh), 0.01, 2 * field_samples)) {
  std::vector<Piece> pieces;
  const std::vector<Mesh> shells = geometry::shells(geometry::merged_vertices(mesh));
  for (std::size_t shell = 0; shell < shells.size(); ++shell)
    for (const geometry::Triangle& t : shells[shell].triangles) {
      triangles_.push_back(geometry::corners(shells[shell], t));
      cut(triangles_.back(), static_cast<int>(triangles_.size()) - 1, static_cast<int>(shell), leaf_radius, pieces);
    }
  balls_.reserve(2 * pieces.size());
  grow(pieces, 0, pieces.size(), balls_);
  for (std::size_t i = 0; i < balls_.size(); ++i)
    if (balls_[i].triangle >= 0) leaves_.push_back(static_cast<int>(i));
}

}  // namespace tactus::contact
