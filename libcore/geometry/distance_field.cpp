// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/distance_field.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::geometry {
namespace {

constexpr double float_slack = 1e-7;  // of a distance stored as a float, relative above 1 m

}  // namespace

DistanceField::DistanceField(const Mesh& mesh, double spacing, double border, std::size_t max_samples)
    : tree_(mesh), spacing_(spacing) {
  const Box box = tree_.box().inflated(border);
  auto samples_at = [&](double h) { return ((box.size() / h).array().ceil() + 1.0).prod(); };
  while (samples_at(spacing_) > static_cast<double>(max_samples)) spacing_ *= 1.1;
  origin_ = box.low;
  for (int d = 0; d < 3; ++d) count_[d] = static_cast<int>(std::ceil(box.size()[d] / spacing_)) + 1;
  inverse_spacing_ = 1.0 / spacing_;
  for (int d = 0; d < 3; ++d) last_[d] = count_[d] - 1;
  samples_.resize(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2]);
  fill();
}

void DistanceField::fill() {
  std::size_t at = 0;
  for (int z = 0; z < count_[2]; ++z)
    for (int y = 0; y < count_[1]; ++y) {
      double last = 0.0;  // no neighbour yet: its sign says nothing
      for (int x = 0; x < count_[0]; ++x) {
        const Vector3 p = origin_ + spacing_ * Vector3(x, y, z);
        const double hint = x == 0 ? 1e300 : std::abs(last) + 1.0001 * spacing_;
        const double distance = tree_.distance(p, hint);
        const bool inside = std::abs(last) > 1.0001 * spacing_ ? last < 0.0 : tree_.contains(p);
        last = inside ? -distance : distance;
        samples_[at++] = static_cast<float>(last);
      }
    }
}

DistanceBounds DistanceField::bounds(const Vector3& p) const {
  int index[3];
  double squared = 0.0;
  bool on_lattice = true;
  for (int d = 0; d < 3; ++d) {
    const double scaled = (p[d] - origin_[d]) * inverse_spacing_;
    index[d] = static_cast<int>(std::clamp(scaled + 0.5, 0.0, last_[d]));
    const double offset = scaled - index[d];
    on_lattice = on_lattice && std::abs(offset) <= 0.5001;
    squared += offset * offset;
  }
  const std::size_t at =
      static_cast<std::size_t>(index[0]) +
      static_cast<std::size_t>(count_[0]) * (static_cast<std::size_t>(index[1]) +
                                             static_cast<std::size_t>(count_[1]) * static_cast<std::size_t>(index[2]));
  const auto sample = static_cast<double>(samples_[at]);
  const double error = std::sqrt(squared) * spacing_ + float_slack * (1.0 + std::abs(sample));
  if (on_lattice) return {sample - error, sample + error};
  return {std::max(sample - error, tree_.box().distance(p)), sample + error};
}

bool DistanceField::Cell::holds_point() const {
  return std::all_of(part.begin(), part.end(), [](double p) { return p >= 0.0 && p <= 1.0; });
}

std::size_t DistanceField::Cell::corner(unsigned bits) const {
  std::size_t at = lowest;
  for (unsigned d = 0; d < 3; ++d)
    if ((bits >> d & 1u) != 0) at += step[d];
  return at;
}

DistanceField::Cell DistanceField::cell(const Vector3& p) const {
  Cell cell;
  std::size_t stride = 1;
  for (int d = 0; d < 3; ++d) {
    const double scaled = (p[d] - origin_[d]) * inverse_spacing_;
    const int low = static_cast<int>(std::clamp(scaled, 0.0, last_[d] - 1.0));
    cell.part[d] = scaled - low;
    cell.lowest += static_cast<std::size_t>(low) * stride;
    cell.step[d] = stride;
    stride *= static_cast<std::size_t>(count_[d]);
  }
  return cell;
}

DistanceBounds DistanceField::narrow_bounds(const Vector3& p) const {
  const Cell about = cell(p);
  if (!about.holds_point()) return bounds(p);
  DistanceBounds narrow{-1e300, 1e300};
  for (unsigned bits = 0; bits < 8; ++bits) {
    double squared = 0.0;
    for (unsigned d = 0; d < 3; ++d) {
      const double off = (bits >> d & 1u) != 0 ? 1.0 - about.part[d] : about.part[d];
      squared += off * off;
    }
    const auto sample = static_cast<double>(samples_[about.corner(bits)]);
    const double error = std::sqrt(squared) * spacing_ + float_slack * (1.0 + std::abs(sample));
    narrow = {std::max(narrow.lower, sample - error), std::min(narrow.upper, sample + error)};
  }
  return narrow;
}

double DistanceField::estimate(const Vector3& p) const {
  const Cell about = cell(p);
  double sum = 0.0;
  for (unsigned bits = 0; bits < 8; ++bits) {
    double share = 1.0;
    for (unsigned d = 0; d < 3; ++d) {
      const double part = std::clamp(about.part[d], 0.0, 1.0);
      share *= (bits >> d & 1u) != 0 ? part : 1.0 - part;
    }
    sum += share * static_cast<double>(samples_[about.corner(bits)]);
  }
  return sum;
}

Vector3 DistanceField::gradient(const Vector3& p) const {
  Vector3 result;
  const double h = 0.5 * spacing_;
  for (int d = 0; d < 3; ++d)
    result[d] = (estimate(p + h * Vector3::Unit(d)) - estimate(p - h * Vector3::Unit(d))) / (2.0 * h);
  return result;
}

double DistanceField::exact(const Vector3& p) const {
  const DistanceBounds known = narrow_bounds(p);
  const double distance = tree_.distance(p, std::max(-known.lower, known.upper));
  const bool is_inside = known.upper < 0.0 || (known.lower <= 0.0 && tree_.contains(p));
  return is_inside ? -distance : distance;
}

}  // namespace tactus::geometry
