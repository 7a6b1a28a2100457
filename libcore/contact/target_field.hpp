// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "contact/kernel/descent.hpp"
#include "geometry/distance_field.hpp"

namespace tactus::contact {

/// A distance field as the kernels read it: two bytes a sample, so that more of it stays near the processor. Const.
class TargetField {
 public:
  explicit TargetField(const geometry::DistanceField& field);
  TargetField(const TargetField&) = delete;  // the view points into the samples
  TargetField& operator=(const TargetField&) = delete;

  const kernel::Field& view() const { return view_; }
  std::size_t bytes() const { return samples_.size() * sizeof(std::int16_t); }

 private:
  std::vector<std::int16_t> samples_;
  kernel::Field view_{};
};

}  // namespace tactus::contact
