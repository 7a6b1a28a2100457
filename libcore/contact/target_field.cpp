// SPDX-License-Identifier: BSD-3-Clause
#include "contact/target_field.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::contact {
namespace {

constexpr float largest = 32767.0f;
constexpr float rounding = 1e-6f;  // m: what single precision may be off by within some metres of the origin

}  // namespace

TargetField::TargetField(const geometry::DistanceField& field) {
  const std::vector<float>& samples = field.samples();
  float farthest = 1e-6f;
  for (const float sample : samples) farthest = std::max(farthest, std::abs(sample));
  view_.quantum = farthest / largest;
  samples_.reserve(samples.size() + 1);
  for (const float sample : samples) samples_.push_back(static_cast<std::int16_t>(std::lround(sample / view_.quantum)));
  samples_.push_back(0);
  view_.samples = samples_.data();
  view_.spacing = static_cast<float>(field.spacing());
  view_.inverse_spacing = static_cast<float>(1.0 / field.spacing());
  view_.slack = 0.51f * view_.quantum + rounding;
  std::int32_t stride = 1;
  for (int d = 0; d < 3; ++d) {
    view_.origin[d] = static_cast<float>(field.origin()[d]);
    view_.last[d] = static_cast<float>(field.count()[d] - 1);
    view_.stride[d] = stride;
    stride *= field.count()[d];
    view_.box_centre[d] = static_cast<float>(field.tree().box().centre()[d]);
    view_.box_half[d] = static_cast<float>(0.5 * field.tree().box().size()[d]);
  }
}

}  // namespace tactus::contact
