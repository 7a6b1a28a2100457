// SPDX-License-Identifier: BSD-3-Clause
#include "robot/package_path.hpp"

#include <algorithm>
#include <sstream>
#include <string_view>

namespace tactus::robot {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view package_scheme = "package://";
constexpr std::string_view file_scheme = "file://";

MeshPath refuse(const std::string& found, const std::string& expected) { return {{}, found, expected}; }

bool lies_in(const fs::path& path, const fs::path& root) {
  return std::mismatch(root.begin(), root.end(), path.begin(), path.end()).first == root.end();
}

/// The folder of a package, canonical; empty if there is none.
fs::path package_root(const std::string& package, const ModelSource& source) {
  std::error_code error;
  if (const auto named = source.package_roots.find(package); named != source.package_roots.end())
    return fs::canonical(named->second, error);
  const auto any = source.package_roots.find("");
  if (any == source.package_roots.end()) return {};
  std::istringstream folders(any->second.string());
  for (std::string folder; std::getline(folders, folder, ':');)
    if (fs::path root = fs::canonical(fs::path(folder) / package, error); !error && fs::is_directory(root, error))
      return root;
  return {};
}

MeshPath regular_file(const std::string& uri, const fs::path& path) {
  std::error_code error;
  const fs::path real = fs::canonical(path, error);
  if (error) return refuse("mesh " + uri + ", but no file " + path.lexically_normal().string(), "a mesh file");
  if (!fs::is_regular_file(real, error)) return refuse("mesh " + uri + ", which is not a regular file", "a mesh file");
  return {real, {}, {}};
}

MeshPath in_package(const std::string& uri, const ModelSource& source) {
  const std::string rest = uri.substr(package_scheme.size());
  const std::size_t slash = std::min(rest.find('/'), rest.size());
  const std::string package = rest.substr(0, slash);
  if (package.empty() || package == "." || package == "..") return refuse("mesh " + uri, "package://name/path");
  const fs::path root = package_root(package, source);
  if (root.empty()) return refuse("mesh " + uri + " of an unknown package", "a package root for " + package);
  const fs::path path = fs::path(root.string() + rest.substr(slash));
  const MeshPath mesh = regular_file(uri, path);
  std::error_code error;
  if (lies_in(fs::weakly_canonical(path, error), root) && !error) return mesh;
  return refuse("mesh " + uri + ", which leaves its package", "a file inside " + root.string());
}

}  // namespace

MeshPath resolve_mesh(const std::string& uri, const ModelSource& source) {
  if (uri.starts_with(package_scheme)) return in_package(uri, source);
  const std::string path = uri.starts_with(file_scheme) ? uri.substr(file_scheme.size()) : uri;
  if (path.find("://") != std::string::npos) return refuse("mesh " + uri, "a path, file:// or package://");
  return regular_file(uri, source.urdf.parent_path() / path);
}

}  // namespace tactus::robot
