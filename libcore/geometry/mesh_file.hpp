// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "geometry/mesh.hpp"

namespace tactus::geometry {

struct MeshFileLimits {
  std::uintmax_t bytes = 64u << 20;
  std::size_t triangles = 2'000'000;
  double seconds = 30.0;             ///< for the import, by the importer's own process
  std::uintmax_t memory = 2u << 30;  ///< of the importer's process, in bytes
};

/// Reads an STL, OBJ, PLY or DAE file as one mesh in metres: every part of it, with the transformations inside the file
/// and the unit that a DAE file states applied, its up-axis ignored (as ROS does); then `scale` by axis (a negative one
/// flips the triangles). Equal vertices are merged, triangles that have one twice dropped, closed shells oriented
/// outward.
///
/// The importer is a program of its own with memory and time limits (`importer_process.hpp`): a bad file is an error
/// and not a crash. Throws `file_not_found`, `file_unreadable` or `bad_mesh` naming the file, what was found and what
/// was expected; `internal` if the importer is missing or can't be started.
Mesh load_mesh(const std::filesystem::path& path, const Vector3& scale = Vector3::Ones(),
               const MeshFileLimits& limits = {});

}  // namespace tactus::geometry
