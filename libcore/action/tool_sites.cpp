// SPDX-License-Identifier: BSD-3-Clause
#include "action/tool_sites.hpp"

#include <cmath>
#include <optional>

namespace tactus::action {
namespace {

/// The axis along which the way from one position to another leads, if it does along one.
std::optional<int> axis_of(const Vector3& from, const Vector3& to) {
  const Vector3 way = (to - from).cwiseAbs();
  int axis = 0;
  const double along = way.maxCoeff(&axis);
  const bool is_straight = way.sum() - along <= 2.0 * ToolSites::tolerance && along > ToolSites::tolerance;
  return is_straight ? std::optional(axis) : std::nullopt;
}

}  // namespace

Vector3 ToolSites::nearest(const Vector3& position) const {
  const Vector3 steps = (position - origin).cwiseQuotient(step);
  return origin + step.cwiseProduct(Vector3(std::round(steps.x()), std::round(steps.y()), std::round(steps.z())));
}

bool ToolSites::hold(const Vector3& position) const { return (nearest(position) - position).norm() <= tolerance; }

Vector3 ToolSites::end(const Vector3& from, const Vector3& to) const {
  return hold(from) && axis_of(from, to) ? nearest(to) : to;
}

double ToolSites::stride(const Vector3& from, const Vector3& to) const {
  const std::optional<int> axis = axis_of(from, to);
  return axis && hold(from) && hold(to) ? step[*axis] : 0.0;
}

}  // namespace tactus::action
