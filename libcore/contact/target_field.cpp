// SPDX-License-Identifier: BSD-3-Clause
#include "contact/target_field.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::contact {
namespace {

constexpr float largest = 32767.0f;
constexpr float rounding = 1e-6f;  // m: what single precision may be off by within some metres of the origin
constexpr double radii[] = {0.0, 0.003, 0.007};  // m, from which on a level is fine enough

}  // namespace

TargetField::TargetField(const geometry::DistanceField& field) {
  float farthest = 1e-6f;
  for (const float sample : field.samples()) farthest = std::max(farthest, std::abs(sample));
  view_.quantum = farthest / largest;
  view_.slack = 0.51f * view_.quantum + rounding;
  for (int d = 0; d < 3; ++d) {
    view_.box_centre[d] = static_cast<float>(field.tree().box().centre()[d]);
    view_.box_half[d] = static_cast<float>(0.5 * field.tree().box().size()[d]);
  }
  for (int level = 0; level < kernel::Field::levels; ++level) add_level(field, level);
}

void TargetField::add_level(const geometry::DistanceField& field, int level) {
  const int step = 1 << level;
  kernel::Lattice& lattice = view_.lattices[level];
  lattice.spacing = static_cast<float>(step * field.spacing());
  lattice.inverse_spacing = static_cast<float>(1.0 / (step * field.spacing()));
  std::array<int, 3> count;
  std::int32_t stride = 1;
  for (int d = 0; d < 3; ++d) {
    count[d] = (field.count()[d] - 1) / step + 1;
    lattice.origin[d] = static_cast<float>(field.origin()[d]);
    lattice.last[d] = static_cast<float>(count[d] - 1);
    lattice.stride[d] = stride;
    stride *= count[d];
  }
  std::vector<std::int16_t>& samples = samples_[level];
  samples.reserve(static_cast<std::size_t>(stride) + 1);
  for (int z = 0; z < count[2]; ++z)
    for (int y = 0; y < count[1]; ++y)
      for (int x = 0; x < count[0]; ++x)
        samples.push_back(
            static_cast<std::int16_t>(std::lround(field.sample({step * x, step * y, step * z}) / view_.quantum)));
  samples.push_back(0);
  lattice.samples = samples.data();
}

int TargetField::level_for(double radius) {
  int level = kernel::Field::levels - 1;
  while (radius < radii[level]) --level;
  return level;
}

}  // namespace tactus::contact
