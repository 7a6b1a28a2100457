// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "robot/model.hpp"

namespace tactus::robot {

/// Where a mesh named in a URDF lies, or why it can't be had.
struct MeshPath {
  std::filesystem::path path;   ///< a regular file, canonical; empty if `found` says what is wrong
  std::string found, expected;  ///< empty if nothing is
};

/// Resolves `uri` as it stands in a URDF:
/// `package://name/path` under the root of `name` in `source.package_roots`, or in a folder `name` of the folders under
/// "" (a list divided by
/// ':'), and never outside of it, whatever `..` and symbolic links say; `file://` and absolute paths as they are; other
/// paths from the folder of the URDF. Other URL schemes are refused.
MeshPath resolve_mesh(const std::string& uri, const ModelSource& source);

}  // namespace tactus::robot
