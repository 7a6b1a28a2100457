// SPDX-License-Identifier: BSD-3-Clause
// The program that imports meshes: `importer_protocol.hpp` says how it is spoken to.
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "geometry/importer_protocol.hpp"

namespace tactus::geometry {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool address_space_can_be_limited = false;  // their shadow memory is terabytes
#else
constexpr bool address_space_can_be_limited = true;
#endif

/// What stands on the command line.
struct Order {
  pid_t parent;
  std::string format;
  std::size_t triangles;
  rlim_t seconds;
  rlim_t bytes;
};

/// None if that is no order.
std::optional<Order> order_of(int count, char** arguments) try {
  if (count != 1 + importer_arguments) return std::nullopt;
  return Order{static_cast<pid_t>(std::stol(arguments[1])), arguments[2], std::stoull(arguments[3]),
               std::stoull(arguments[4]), std::stoull(arguments[5])};
} catch (const std::logic_error&) {  // of a number that is none, or too large
  return std::nullopt;
}

/// From here on this process ends with its parent. False if that has ended already.
bool bind_to(pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  return ::getppid() == parent;
}

/// Sanitizers come with handlers of their own, which make another ending of a crash.
void crash_by_signal() {
  for (const int crash : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(crash, SIG_DFL);
}

void set_limit(decltype(RLIMIT_AS) resource, rlim_t value) {
  rlimit limit{};
  if (::getrlimit(resource, &limit) != 0) return;
  limit.rlim_cur = std::min(value, limit.rlim_max);
  ::setrlimit(resource, &limit);
}

rlim_t address_space_in_use() {
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

void set_limits(const Order& order) {
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_CPU, order.seconds);
  if (address_space_can_be_limited) set_limit(RLIMIT_AS, address_space_in_use() + order.bytes);
}

[[noreturn]] void throw_system_error() { throw std::system_error(errno, std::generic_category()); }

std::string read_input() {
  struct stat info {};
  if (::fstat(STDIN_FILENO, &info) != 0) throw_system_error();
  std::string bytes(static_cast<std::size_t>(info.st_size), '\0');
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t got = ::read(STDIN_FILENO, &bytes[filled], bytes.size() - filled);
    if (got < 0) throw_system_error();
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
  }
  bytes.resize(filled);
  return bytes;
}

/// Refuses every file: what a mesh refers to (materials, textures) has no say in its shape.
class NoOtherFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};

Eigen::Affine3d affine(const aiMatrix4x4& matrix) {
  using RowMajor = Eigen::Matrix<ai_real, 4, 4, Eigen::RowMajor>;
  Eigen::Affine3d result;
  result.matrix() = Eigen::Map<const RowMajor>(&matrix.a1).cast<double>();
  return result;
}

using Corners = std::vector<Eigen::Vector3d>;  // three a triangle
static_assert(3 * sizeof(Corners::value_type) == bytes_per_triangle);

void collect(const aiMesh& mesh, const Eigen::Affine3d& file_from_mesh, Corners& corners, std::size_t most_triangles) {
  const bool mirrored = file_from_mesh.linear().determinant() < 0.0;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;  // points and lines
    if (corners.size() >= 3 * most_triangles)
      throw std::runtime_error("more than " + std::to_string(most_triangles) + " triangles");
    for (const unsigned k : {0u, mirrored ? 2u : 1u, mirrored ? 1u : 2u}) {
      if (face.mIndices[k] >= mesh.mNumVertices) throw std::runtime_error("a triangle of a vertex that doesn't exist");
      const aiVector3D& v = mesh.mVertices[face.mIndices[k]];
      corners.push_back(file_from_mesh * Eigen::Vector3d(v.x, v.y, v.z));
    }
  }
}

void collect(const aiScene& scene, const aiNode& node, const Eigen::Affine3d& file_from_parent, Corners& corners,
             std::size_t most_triangles) {
  const Eigen::Affine3d file_from_node = file_from_parent * affine(node.mTransformation);
  for (unsigned m = 0; m < node.mNumMeshes; ++m)
    collect(*scene.mMeshes[node.mMeshes[m]], file_from_node, corners, most_triangles);
  for (unsigned c = 0; c < node.mNumChildren; ++c)
    collect(scene, *node.mChildren[c], file_from_node, corners, most_triangles);
}

/// The importer catches what its parts throw, and knows the file by a name of its own making.
[[noreturn]] void throw_error_of(const Assimp::Importer& importer) {
  std::string text = importer.GetErrorString();
  if (text == "std::bad_alloc") throw std::bad_alloc();
  while (!text.empty() && text.back() == '.') text.pop_back();
  const std::size_t name = text.find(AI_MEMORYIO_MAGIC_FILENAME);
  if (name != std::string::npos) text.replace(name, std::string::npos, "the file");
  throw std::runtime_error(text);
}

Corners import(const std::string& bytes, const std::string& format, std::size_t most_triangles) {
  Assimp::Importer importer;
  importer.SetIOHandler(new NoOtherFiles);  // the importer deletes it
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), aiProcess_Triangulate, format.c_str());
  if (scene == nullptr || scene->mRootNode == nullptr) throw_error_of(importer);
  Corners corners;
  collect(*scene, *scene->mRootNode, Eigen::Affine3d::Identity(), corners, most_triangles);
  return corners;
}

bool write_all(const void* data, std::size_t size) {
  const char* next = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = ::write(STDOUT_FILENO, next, size);
    if (sent < 0) return false;
    next += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool send(Answer answer, const void* data, std::uint64_t size) {
  return write_all(&size, sizeof size) && write_all(&answer, sizeof answer) && write_all(data, size);
}

bool send(Answer answer, const std::string& text) {
  return send(answer, text.data(), std::min(text.size(), longest_text));
}

/// Whether the answer, be it good or bad, was sent.
bool carry_out(const Order& order) {
  try {
    const Corners corners = import(read_input(), order.format, order.triangles);
    return send(Answer::triangles, corners.data(), corners.size() * sizeof(Corners::value_type));
  } catch (const std::bad_alloc&) {
    return send(Answer::no_mesh, "it takes more than " + std::to_string(order.bytes >> 20) + " MiB of memory");
  } catch (const std::system_error& error) {
    return send(Answer::unreadable, error.code().message());
  } catch (const std::exception& error) {
    return send(Answer::no_mesh, error.what());
  } catch (...) {
    return send(Answer::no_mesh, "an unknown exception");
  }
}

int run(const std::optional<Order>& order) {
  if (!order) return send(Answer::no_mesh, "this program is for libtactus.so to start") ? 2 : 1;
  if (!bind_to(order->parent)) return 1;
  crash_by_signal();
  set_limits(*order);
  return carry_out(*order) ? 0 : 1;
}

}  // namespace
}  // namespace tactus::geometry

int main(int count, char** arguments) { return tactus::geometry::run(tactus::geometry::order_of(count, arguments)); }
