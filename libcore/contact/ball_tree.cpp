// SPDX-License-Identifier: BSD-3-Clause
#include "contact/ball_tree.hpp"

#include <algorithm>
#include <array>

#include "contact/target_field.hpp"

namespace tactus::contact {
namespace {

constexpr float rounding = 2e-7f;  // of a length stored as a float: relative, and in metres

float rounded_up(double length) { return static_cast<float>(length) * (1.0f + rounding) + rounding; }
float rounded_down(double length) { return static_cast<float>(length) * (1.0f - rounding) - rounding; }

/// The signed depth of a point in the solid (m), no more than it is.
float core(const geometry::TriangleTree& surface, const Vector3& p) {
  const double distance = surface.distance(p);
  return surface.contains(p) ? rounded_down(distance) : -rounded_up(distance);
}

void cut(const Corners& c, int shell, double piece_radius, std::vector<Piece>& pieces) {
  const Vector3 centre = (c[0] + c[1] + c[2]) / 3.0;
  const double radius = std::max({(c[0] - centre).norm(), (c[1] - centre).norm(), (c[2] - centre).norm()});
  if (radius <= piece_radius) {
    pieces.push_back({c, centre, radius, shell, facet(c)});
    return;
  }
  int longest = 0;
  for (int i = 1; i < 3; ++i)
    if ((c[(i + 1) % 3] - c[i]).norm() > (c[(longest + 1) % 3] - c[longest]).norm()) longest = i;
  const Vector3 a = c[longest], b = c[(longest + 1) % 3], apex = c[(longest + 2) % 3], middle = 0.5 * (a + b);
  cut({a, middle, apex}, shell, piece_radius, pieces);
  cut({middle, b, apex}, shell, piece_radius, pieces);
}

using Range = std::pair<std::size_t, std::size_t>;

/// Halves the range of most pieces across its longest side until there are sixteen, or none of more than a block holds;
/// what one block holds is taken apart to single pieces. Halves are multiples of sixteen, which fill their blocks.
std::vector<Range> sixteenths(std::vector<Piece>& pieces, Range whole) {
  const std::size_t unit = whole.second - whole.first > kernel::lanes ? kernel::lanes : 1;
  std::vector<Range> parts{whole};
  while (parts.size() < kernel::lanes) {
    const auto largest = std::max_element(parts.begin(), parts.end(), [](const Range& a, const Range& b) {
      return a.second - a.first < b.second - b.first;
    });
    const auto [begin, end] = *largest;
    if (end - begin <= unit) break;
    geometry::Box centres;
    for (std::size_t i = begin; i < end; ++i) centres.add(pieces[i].centre);
    int axis = 0;
    centres.size().maxCoeff(&axis);
    const std::size_t middle = begin + ((end - begin) / 2 + unit / 2) / unit * unit;
    const auto at = [&](std::size_t i) { return pieces.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end),
                     [axis](const Piece& a, const Piece& b) { return a.centre[axis] < b.centre[axis]; });
    *largest = {begin, middle};
    parts.emplace_back(middle, end);
  }
  return parts;
}

}  // namespace

BallTree::BallTree(const Mesh& mesh, double piece_radius) {
  const std::vector<Mesh> shells = geometry::shells(geometry::merged_vertices(mesh));
  shells_ = static_cast<int>(shells.size());
  for (std::size_t shell = 0; shell < shells.size(); ++shell)
    for (const geometry::Triangle& t : shells[shell].triangles)
      if (geometry::has_area(shells[shell], t))
        cut(geometry::corners(shells[shell], t), static_cast<int>(shell), piece_radius, pieces_);
  root_ = grow(0, pieces_.size(), geometry::TriangleTree(mesh));
}

/// Makes the block over pieces [begin, end), and those below it; returns the link to it.
std::int32_t BallTree::grow(std::size_t begin, std::size_t end, const geometry::TriangleTree& surface) {
  const auto self = static_cast<std::int32_t>(blocks_.size());
  kernel::Block block{};
  for (float(&half)[kernel::lanes] : block.half) std::fill_n(half, kernel::lanes, kernel::no_part);
  std::fill_n(block.core, kernel::lanes, kernel::no_part);
  blocks_.push_back(block);
  const std::vector<Range> parts = sixteenths(pieces_, {begin, end});
  for (std::size_t lane = 0; lane < parts.size(); ++lane) {
    const auto [first, last] = parts[lane];
    const Vector3 centre = bound(first, last, block, lane);
    const bool single = last - first == 1;
    block.core[lane] = single ? 0.0f : core(surface, centre);
    block.next[lane] = single ? ~static_cast<std::int32_t>(first) : grow(first, last, surface);
  }
  blocks_[static_cast<std::size_t>(self)] = block;
  const float smallest = *std::min_element(block.radius, block.radius + parts.size());
  return kernel::link(self, TargetField::level_for(static_cast<double>(smallest)));
}

/// A ball and a box about the pieces [first, last); returns their centre.
Vector3 BallTree::bound(std::size_t first, std::size_t last, kernel::Block& block, std::size_t lane) const {
  geometry::Box box;
  for (std::size_t i = first; i < last; ++i) box.add(geometry::bounds(pieces_[i].corners));
  Vector3 centre = last - first == 1 ? pieces_[first].centre : box.centre();
  for (int d = 0; d < 3; ++d) {
    block.centre[d][lane] = static_cast<float>(centre[d]);
    centre[d] = static_cast<double>(block.centre[d][lane]);
    block.half[d][lane] = rounded_up(std::max(box.high[d] - centre[d], centre[d] - box.low[d]));
  }
  double radius = 0.0;
  for (std::size_t i = first; i < last; ++i)
    radius = std::max(radius, (pieces_[i].centre - centre).norm() + pieces_[i].radius);
  block.radius[lane] = rounded_up(radius);
  return centre;
}

kernel::Extent extent(const geometry::Box& box) {
  kernel::Extent result;
  for (int d = 0; d < 3; ++d) {
    result.centre[d] = static_cast<float>(box.centre()[d]);
    result.half[d] = static_cast<float>(0.5 * box.size()[d]);
  }
  return result;
}

kernel::Placement placement(const Pose& pose) {
  kernel::Placement result;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      result.rotation[3 * row + column] = static_cast<float>(pose.linear()(row, column));
    result.translation[row] = static_cast<float>(pose.translation()[row]);
  }
  return result;
}

}  // namespace tactus::contact
