// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include "robot/urdf_check.hpp"

namespace tactus::robot {

/// Gives a checked URDF to urdfdom. Whatever it complains about, and every collision element that does not arrive, is
/// thrown as `bad_robot`. Only what the model needs of the file is given to it: visuals, inertias, transmissions and
/// the like may be what they want.
urdf::ModelInterfaceSharedPtr parse_urdf(const TiXmlDocument& document, const UrdfOutline& outline, XmlReport& report);

}  // namespace tactus::robot
