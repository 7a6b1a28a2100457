// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/pose.hpp"

namespace tactus::action {

using geometry::Pose;
using geometry::Vector3;

/// Positions of the tool frame (base frame), whole steps apart along the base's axes, at which it stands on the way of
/// straight motions along these axes, as far as that can be had. Motions that meet at the same sites share what is
/// known of them: tables of contact. A value.
struct ToolSites {
  Vector3 origin = Vector3::Zero();          ///< one of them
  Vector3 step = Vector3::Constant(0.001);   ///< m
  static constexpr double tolerance = 2e-6;  ///< m that a tool may be off its site

  Vector3 nearest(const Vector3& position) const;
  bool hold(const Vector3& position) const;

  /// The site nearest to `to`, if `from` is one and the way to `to` follows an axis; else `to` itself.
  Vector3 end(const Vector3& from, const Vector3& to) const;

  /// The step along the axis that two sites differ by; 0 if they are none, or differ otherwise.
  double stride(const Vector3& from, const Vector3& to) const;
};

}  // namespace tactus::action
