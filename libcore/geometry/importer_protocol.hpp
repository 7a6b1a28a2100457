// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace tactus::geometry {

/// The program that imports meshes. The library starts it as
///
///     tactus-import-mesh PARENT FORMAT TRIANGLES SECONDS BYTES
///
/// with the process that it must not outlive, the format (an extension: "stl"), the most triangles, the seconds of
/// computing and the bytes of memory that the import may take. Its standard input is the mesh file. To its standard
/// output it writes the size of what it has to say (8 bytes, in the machine's order), an `Answer`, and what that says;
/// nothing else, and nothing to its standard error. Arguments that are not these it answers with `no_mesh`.
constexpr const char* importer_name = "tactus-import-mesh";
constexpr int importer_arguments = 5;

enum class Answer : char {
  triangles = 'T',   ///< the corners of the triangles, three a triangle, three doubles a corner
  no_mesh = 'E',     ///< why there are none, in words
  unreadable = 'U',  ///< why the file can't be read, in words
};

constexpr std::size_t bytes_per_triangle = 9 * sizeof(double);
constexpr std::size_t longest_text = 4096;  ///< of an answer in words, in bytes

}  // namespace tactus::geometry
