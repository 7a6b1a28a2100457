// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "action/motion.hpp"

namespace tactus::action {

/// Macro probes aimed at where the target may still be: sweeps through `region` from its four sides, in lines
/// `probe_spacing` apart (fewer and evenly spaced where the region is narrow), in up to three layers where it is deep,
/// and pokes to its far side on a grid twice as wide. `region` is a box in the search frame; `most` bounds the number
/// of lines per side. Each sets out from the retreat plane. What the known world or the limits block is left out.
/// `near`: the configuration whose posture is kept.
std::vector<MotionPtr> probes(const Task& task, const geometry::Box& region, const JointVector& near, int most = 7);

/// Depths of sweeps through a region that goes on for `depth` m: the first, and others evenly spaced behind it.
std::vector<double> layers(double first, double depth);

/// A free straight motion from the retreat plane along the given tool positions (search frame), at the given turn about
/// the approach axis; null if blocked.
MotionPtr anchored_motion(const Task& task, Kind kind, const std::vector<Vector3>& positions, double turn,
                          const JointVector& near);

}  // namespace tactus::action
