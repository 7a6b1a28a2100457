// SPDX-License-Identifier: BSD-3-Clause
#include "contact/body.hpp"

#include <algorithm>

namespace tactus::contact {
namespace {

constexpr std::size_t field_samples = 60'000;

double field_spacing(const Mesh& mesh) {
  const Vector3 size = geometry::bounds(mesh).size();
  return std::max(0.002, std::cbrt(size.prod() / static_cast<double>(field_samples)));
}

}  // namespace

Body::Body(const Mesh& mesh, double piece_radius)
    : mesh_(mesh),
      tree_(mesh),
      balls_(mesh, piece_radius),
      extent_(contact::extent(tree_.box())),
      field_(std::make_shared<geometry::DistanceField>(mesh, field_spacing(mesh), 0.01, 2 * field_samples)) {}

}  // namespace tactus::contact
