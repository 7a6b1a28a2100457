// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/mesh.hpp"

/// Thin, concave things bent of a strip of sheet: closed meshes, each centred on the middle of its box.
namespace tactus::bench {

constexpr double sheet_thickness = 0.002;  ///< m

geometry::Mesh hook();     ///< a straight shank of 80 mm and a bend of 25 mm radius through 200 degrees
geometry::Mesh ring();     ///< 45 mm radius
geometry::Mesh bracket();  ///< three sides of a box, 60 mm each, with round edges

}  // namespace tactus::bench
