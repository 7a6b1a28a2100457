// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "belief/belief.hpp"

namespace tactus::belief {

/// Whether the target may be at exactly this pose, as far as the belief knows: it lies in the prior, and no voxel
/// inside it is known to be free (phase 1), or a cell covers it (phase 2).
bool contains(const Belief& belief, const Pose& base_from_target);

/// Whether some x y z roll pitch yaw within `half` of `centre` describe the pose, to 1e-6 m and rad: the turned-over
/// description of the same rotation and the many at a pitch of a quarter turn count too.
bool covers(const PoseVector& centre, const PoseVector& half, const Pose& base_from_target);

}  // namespace tactus::belief
