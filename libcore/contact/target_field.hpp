// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "contact/kernel/descent.hpp"
#include "geometry/distance_field.hpp"

namespace tactus::contact {

/// A distance field as the kernels read it: two bytes a sample, and every second and every fourth sample apart. Const.
class TargetField {
 public:
  explicit TargetField(const geometry::DistanceField& field);
  TargetField(const TargetField&) = delete;  // the view points into the samples
  TargetField& operator=(const TargetField&) = delete;

  const kernel::Field& view() const { return view_; }

  /// The coarsest level whose samples are close enough together for parts of such a radius (m).
  static int level_for(double radius);

 private:
  void add_level(const geometry::DistanceField& field, int level);

  std::array<std::vector<std::int16_t>, kernel::Field::levels> samples_;
  kernel::Field view_{};
};

}  // namespace tactus::contact
