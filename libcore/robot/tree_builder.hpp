// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <urdf_model/model.h>

#include "robot/urdf_check.hpp"

namespace tactus::robot {

Pose pose_from(const urdf::Pose& pose);

/// The model's links and joints, without shapes: depth first, siblings in the order of the file. Logs what it has to
/// assume.
RobotModel build_tree(const urdf::ModelInterface& parsed, const UrdfOutline& outline);

}  // namespace tactus::robot
