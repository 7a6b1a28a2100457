// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "geometry/importer_protocol.hpp"
#include "geometry/mesh_file.hpp"

namespace tactus::geometry {

/// A mesh file to import.
struct ImportJob {
  std::filesystem::path path;  ///< named in errors
  int file;                    ///< the open file, at its beginning; stays the caller's
  std::string format;          ///< "stl", "obj", "ply" or "dae"
  MeshFileLimits limits;
};

struct ImportAnswer {
  Answer kind;
  std::string content;
};

/// The file that this code was loaded from, libtactus.so or a program that holds the library, without symbolic links.
/// Throws `internal` if the system doesn't tell.
std::filesystem::path own_module();

/// Has the importer that belongs to `module` (the path of a file; the importer is looked for beside it) import a mesh,
/// and says what it answers. An import that crashes, takes too long or answers nonsense is a `no_mesh` that says so.
/// The importer has ended when this returns. It gets the mesh file and `LD_LIBRARY_PATH` of this process, nothing else.
///
/// Throws `internal` if there is no importer or it can't be started.
ImportAnswer run_importer(const ImportJob& job, const std::filesystem::path& module = own_module());

}  // namespace tactus::geometry
