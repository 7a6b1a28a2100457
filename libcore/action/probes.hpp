// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "action/motion.hpp"
#include "support/cancellation.hpp"

namespace tactus::action {

/// Macro probes aimed at where the target may still be: sweeps through `region` from its four sides, in lines
/// `probe_spacing` apart (fewer and evenly spaced where the region is narrow), in up to three `layers` where it is
/// deep, and pokes to its far side on a grid twice as wide. `region` is a box in the search frame; `most` bounds the
/// number of lines per side. Each sets out from the region's retreat plane. What the known world or the limits block is
/// left out. `near`: the configuration whose posture is kept.
/// Throws `Cancelled`.
std::vector<MotionPtr> probes(const Task& task, const geometry::Box& region, const JointVector& near, int most = 7,
                              const support::Cancellation& cancellation = {});

/// Height of the tool frame's origin in the search frame on the retreat plane of a part of the search region: as far
/// before it as the retreat plane is before the whole. A target in that part is not touched there, so that a robot that
/// knows as much need go no farther back.
double retreat_plane(const Task& task, const geometry::Box& region);

/// Whether no joint is turned so far from where it is at the other that motions which keep the one's posture (`near`)
/// would not serve the other too.
bool in_same_posture(const JointVector& a, const JointVector& b);

/// Depths of sweeps through a region, m behind its near side, ascending: `first`, which reaches the nearest targets
/// that may be in it, as far behind where the farthest one begins, and where these are far apart one between them. What
/// may be anywhere in the region is met by some sweep.
std::vector<double> layers(const Task& task, const geometry::Box& region, double first);

/// A free straight motion from the retreat plane along the given tool positions (search frame), at the given turn about
/// the approach axis; null if blocked. Throws `Cancelled`.
MotionPtr anchored_motion(const Task& task, Kind kind, const std::vector<Vector3>& positions, double turn,
                          const JointVector& near, const support::Cancellation& cancellation = {});

}  // namespace tactus::action
