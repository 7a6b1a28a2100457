// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/mesh_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>

#include "geometry/importer_process.hpp"
#include "support/descriptor.hpp"
#include "support/error.hpp"

namespace tactus::geometry {
namespace {

using support::Descriptor;
using support::Error;
using support::Status;
using support::uninterrupted;

[[noreturn]] void fail(Status status, const std::filesystem::path& path, const std::string& found,
                       const std::string& expected) {
  throw Error(status, path.string() + ": found " + found + ", expected " + expected);
}

[[noreturn]] void fail_reading(const std::filesystem::path& path, const std::string& why) {
  fail(Status::file_unreadable, path, "an error while reading (" + why + ")", "a mesh file");
}

std::string system_message() { return std::generic_category().message(errno); }

Descriptor open_file(const std::filesystem::path& path) {
  // O_NONBLOCK: opening a FIFO must not wait for a writer
  Descriptor file(uninterrupted([&] { return ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC); }));
  if (file.get() >= 0) return file;
  const bool missing = errno == ENOENT || errno == ENOTDIR;
  const std::string what = missing ? "no such file" : "a file that can't be opened (" + system_message() + ")";
  fail(missing ? Status::file_not_found : Status::file_unreadable, path, what, "a mesh file");
}

std::uintmax_t checked_size(const std::filesystem::path& path, const Descriptor& file, std::uintmax_t most_bytes) {
  struct stat info {};
  if (::fstat(file.get(), &info) != 0) fail(Status::file_unreadable, path, system_message(), "a mesh file");
  if (S_ISDIR(info.st_mode)) fail(Status::file_unreadable, path, "a folder", "a mesh file");
  if (!S_ISREG(info.st_mode)) fail(Status::file_unreadable, path, "something that isn't a regular file", "a mesh file");
  const auto size = static_cast<std::uintmax_t>(info.st_size);
  if (size > most_bytes)
    fail(Status::bad_mesh, path, std::to_string(size) + " bytes", "at most " + std::to_string(most_bytes));
  return size;
}

/// Refuses a file of `size` bytes without content: an empty one, or nothing but zeros. Leaves it at its beginning.
void check_content(const std::filesystem::path& path, const Descriptor& file, std::uintmax_t size) {
  std::array<char, 1 << 16> block;
  std::uintmax_t zeros = 0;
  while (zeros < size) {
    const auto from = static_cast<off_t>(zeros);
    const ssize_t got = uninterrupted([&] { return ::pread(file.get(), block.data(), block.size(), from); });
    if (got < 0) fail_reading(path, system_message());
    if (got == 0) break;
    if (std::any_of(block.begin(), block.begin() + got, [](char c) { return c != '\0'; })) return;
    zeros += static_cast<std::uintmax_t>(got);
  }
  fail(Status::bad_mesh, path, zeros == 0 ? "an empty file" : std::to_string(zeros) + " zero bytes", "a mesh");
}

std::string format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* known : {"stl", "obj", "ply", "dae"})
    if (extension == std::string(".") + known) return known;
  fail(Status::bad_mesh, path, "the extension \"" + extension + "\"", ".stl, .obj, .ply or .dae");
}

Mesh mesh_of(const ImportJob& job, const ImportAnswer& answer) {
  if (answer.kind == Answer::unreadable) fail_reading(job.path, answer.content);
  if (answer.kind == Answer::no_mesh)
    fail(Status::bad_mesh, job.path, "a file that can't be imported: " + answer.content,
         "a mesh in the format ." + job.format);
  const std::size_t count = answer.content.size() / bytes_per_triangle;
  if (count == 0) fail(Status::bad_mesh, job.path, "no triangles", "at least one");
  Mesh mesh;
  mesh.vertices.resize(3 * count);
  std::memcpy(mesh.vertices.front().data(), answer.content.data(), count * bytes_per_triangle);
  for (std::size_t t = 0; t < count; ++t) {
    const auto first = static_cast<std::int32_t>(3 * t);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

void apply_scale(Mesh& mesh, const Vector3& scale) {
  for (Vector3& vertex : mesh.vertices) vertex = vertex.cwiseProduct(scale);
  if (scale.prod() >= 0.0) return;
  for (Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

void check_finite(const std::filesystem::path& path, const Mesh& mesh) {
  for (const Vector3& vertex : mesh.vertices)
    if (!vertex.allFinite()) fail(Status::bad_mesh, path, "a vertex that isn't finite", "finite coordinates");
}

void check_scale(const std::filesystem::path& path, const Vector3& scale) {
  if (scale.allFinite() && (scale.array() != 0.0).all()) return;
  std::ostringstream text;
  text << "the scale " << scale.transpose();
  fail(Status::bad_mesh, path, text.str(), "three finite numbers other than 0");
}

}  // namespace

Mesh load_mesh(const std::filesystem::path& path, const Vector3& scale, const MeshFileLimits& limits) {
  const Descriptor file = open_file(path);
  const std::uintmax_t size = checked_size(path, file, limits.bytes);
  const ImportJob job{path, file.get(), format_of(path), limits};
  check_content(path, file, size);
  check_scale(path, scale);
  Mesh mesh = mesh_of(job, run_importer(job));
  apply_scale(mesh, scale);
  check_finite(path, mesh);
  mesh = merged_vertices(mesh);
  if (!has_area(mesh)) fail(Status::bad_mesh, path, "only triangles without area", "one with area");
  orient_outward(mesh);
  return mesh;
}

}  // namespace tactus::geometry
