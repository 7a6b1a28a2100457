// SPDX-License-Identifier: BSD-3-Clause
#include "contact/facets.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace tactus::contact {
namespace {

using geometry::Box;
using geometry::Corners;
using geometry::Vector3;

constexpr double finest_spacing = 0.003;  // m
constexpr double most_cells = 200'000;
constexpr double least_height = 1e-4;  // of a triangle, relative to its longest side, for it to have planes

void set_plane(const Vector3& normal, const Corners& c, float (&plane)[4]) {
  for (int d = 0; d < 3; ++d) plane[d] = static_cast<float>(normal[d]);
  plane[3] = static_cast<float>(std::max({normal.dot(c[0]), normal.dot(c[1]), normal.dot(c[2])}));
}

void copy(const kernel::Facet& facet, kernel::FacetBlock& block, std::size_t lane) {
  for (int k = 0; k < 3; ++k)
    for (int d = 0; d < 3; ++d) block.corner[k][d][lane] = facet.corner[k][d];
  for (int k = 0; k < kernel::Facet::planes; ++k)
    for (int d = 0; d < 4; ++d) block.plane[k][d][lane] = facet.plane[k][d];
}

}  // namespace

kernel::Facet facet(const Corners& c) {
  kernel::Facet result{};
  for (int k = 0; k < 3; ++k)
    for (int d = 0; d < 3; ++d) result.corner[k][d] = static_cast<float>(c[k][d]);
  const Vector3 normal = (c[1] - c[0]).cross(c[2] - c[0]);
  const double longest = std::max({(c[1] - c[0]).norm(), (c[2] - c[1]).norm(), (c[0] - c[2]).norm()});
  if (normal.norm() < least_height * longest * longest) return result;
  set_plane(normal.normalized(), c, result.plane[0]);
  for (int k = 0; k < 3; ++k) set_plane((c[(k + 1) % 3] - c[k]).cross(normal).normalized(), c, result.plane[k + 1]);
  return result;
}

Facets::Facets(const geometry::TriangleTree& surface, double reach) : reach_(reach) {
  const Box box = surface.box().inflated(reach);
  double spacing = finest_spacing;
  while ((box.size() / spacing).array().ceil().prod() > most_cells) spacing *= 1.1;
  inverse_spacing_ = 1.0 / spacing;
  origin_ = box.low;
  for (int d = 0; d < 3; ++d) count_[d] = static_cast<int>(std::ceil(box.size()[d] / spacing));
  const double reach_of_cell = reach + 0.5001 * std::sqrt(3.0) * spacing;
  std::map<std::vector<int>, List> lists;
  for (int z = 0; z < count_[2]; ++z)
    for (int y = 0; y < count_[1]; ++y)
      for (int x = 0; x < count_[0]; ++x) {
        const Vector3 middle = origin_ + spacing * Vector3(x + 0.5, y + 0.5, z + 0.5);
        const auto [at, is_new] = lists.try_emplace(surface.faces_near(middle, reach_of_cell));
        if (is_new) at->second = append(surface, at->first);
        cells_.push_back(at->second);
      }
}

Facets::List Facets::append(const geometry::TriangleTree& surface, const std::vector<int>& faces) {
  const std::size_t first = blocks_.size(), count = (faces.size() + kernel::lanes - 1) / kernel::lanes;
  blocks_.resize(first + count);
  faces_.resize(blocks_.size() * kernel::lanes, -1);
  std::copy(faces.begin(), faces.end(), faces_.begin() + static_cast<std::ptrdiff_t>(first * kernel::lanes));
  for (std::size_t i = 0; i < count * kernel::lanes; ++i) {
    kernel::FacetBlock& block = blocks_[first + i / kernel::lanes];
    if (i < faces.size())
      copy(facet(surface.face(faces[i])), block, i % kernel::lanes);
    else
      block.plane[0][3][i % kernel::lanes] = kernel::beyond_all;
  }
  return {static_cast<int>(first), static_cast<int>(count)};
}

Facets::Near Facets::near(const Vector3& p) const {
  std::size_t cell = 0, stride = 1;
  for (int d = 0; d < 3; ++d) {
    const double at = std::floor((p[d] - origin_[d]) * inverse_spacing_);
    if (at < 0.0 || at >= count_[d]) return {};
    cell += static_cast<std::size_t>(at) * stride;
    stride *= static_cast<std::size_t>(count_[d]);
  }
  const List& list = cells_[cell];
  return {{blocks_.data() + list.first, static_cast<std::size_t>(list.count)},
          faces_.data() + static_cast<std::size_t>(list.first) * kernel::lanes};
}

}  // namespace tactus::contact
