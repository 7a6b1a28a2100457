// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/mesh_file.hpp"

#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>

#include "support/error.hpp"

namespace tactus::geometry {
namespace {

using support::Error;
using support::Status;
using Clock = std::chrono::steady_clock;

constexpr std::size_t bytes_per_triangle = 9 * sizeof(double);
constexpr std::size_t longest_error_text = 4096;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool address_space_can_be_limited = false;  // their shadow memory is terabytes
#else
constexpr bool address_space_can_be_limited = true;
#endif

/// What the child answers: either the corners of the triangles, three a triangle, or why there are none.
enum class Answer : char { triangles = 'T', error = 'E' };

[[noreturn]] void fail(Status status, const std::filesystem::path& path, const std::string& found,
                       const std::string& expected) {
  throw Error(status, path.string() + ": found " + found + ", expected " + expected);
}

std::string system_message() { return std::generic_category().message(errno); }

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }
  int get() const { return fd_; }
  void close() {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  }

 private:
  int fd_;
};

template <typename Call>
auto uninterrupted(Call&& call) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

std::string read_file(const std::filesystem::path& path, std::uintmax_t most_bytes) {
  // O_NONBLOCK: opening a FIFO must not wait for a writer
  const Descriptor file(uninterrupted([&] { return ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC); }));
  if (file.get() < 0) {
    const bool missing = errno == ENOENT || errno == ENOTDIR;
    const std::string what = missing ? "no such file" : "a file that can't be opened (" + system_message() + ")";
    fail(missing ? Status::file_not_found : Status::file_unreadable, path, what, "a mesh file");
  }
  struct stat info {};
  if (::fstat(file.get(), &info) != 0) fail(Status::file_unreadable, path, system_message(), "a mesh file");
  if (S_ISDIR(info.st_mode)) fail(Status::file_unreadable, path, "a folder", "a mesh file");
  if (!S_ISREG(info.st_mode)) fail(Status::file_unreadable, path, "something that isn't a regular file", "a mesh file");
  const auto size = static_cast<std::uintmax_t>(info.st_size);
  if (size > most_bytes)
    fail(Status::bad_mesh, path, std::to_string(size) + " bytes", "at most " + std::to_string(most_bytes));

  std::string bytes(size, '\0');
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t got = uninterrupted([&] { return ::read(file.get(), &bytes[filled], bytes.size() - filled); });
    if (got < 0)
      fail(Status::file_unreadable, path, "an error while reading (" + system_message() + ")", "a mesh file");
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
  }
  bytes.resize(filled);
  return bytes;
}

std::string format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* known : {"stl", "obj", "ply", "dae"})
    if (extension == std::string(".") + known) return known;
  fail(Status::bad_mesh, path, "the extension \"" + extension + "\"", ".stl, .obj, .ply or .dae");
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

using Corners = std::vector<Vector3>;  // three a triangle

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
      corners.push_back(file_from_mesh * Vector3(v.x, v.y, v.z));
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

/// What clocks and limits can hold.
double bounded(double seconds) { return std::clamp(seconds, 0.0, 1e6); }

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

void set_limits(const MeshFileLimits& limits) {
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_CPU, static_cast<rlim_t>(std::ceil(bounded(limits.seconds))) + 1);
  if (address_space_can_be_limited) set_limit(RLIMIT_AS, address_space_in_use() + limits.memory);
}

constexpr int pipe_in_child = 3;

/// Cuts the child off from all it inherits: signal handlers, the parent's files and terminal, a life longer than the
/// parent's.
void isolate(int pipe) {
  for (int signal = 1; signal < NSIG; ++signal) ::signal(signal, SIG_DFL);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::dup2(pipe, pipe_in_child);
  const int null = ::open("/dev/null", O_RDWR);
  for (int standard = 0; standard < pipe_in_child; ++standard) ::dup2(null, standard);
  ::close_range(pipe_in_child + 1, ~0u, 0);
}

bool write_all(int fd, const void* data, std::size_t size) {
  const char* next = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = uninterrupted([&] { return ::write(fd, next, size); });
    if (sent < 0) return false;
    next += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool send(Answer kind, const void* data, std::size_t size) {
  const std::uint64_t total = size + 1;
  return write_all(pipe_in_child, &total, sizeof total) && write_all(pipe_in_child, &kind, 1) &&
         write_all(pipe_in_child, data, size);
}

bool send_error(std::string text) {
  text.resize(std::min(text.size(), longest_error_text));
  return send(Answer::error, text.data(), text.size());
}

/// The child's whole life. `_exit`: the parent's exit handlers and buffers aren't the child's to run and flush.
[[noreturn]] void import_and_exit(int pipe, const std::string& bytes, const std::string& format,
                                  const MeshFileLimits& limits) {
  isolate(pipe);
  bool sent = false;
  try {
    set_limits(limits);
    const Corners corners = import(bytes, format, limits.triangles);
    sent = send(Answer::triangles, corners.data(), corners.size() * sizeof(Vector3));
  } catch (const std::bad_alloc&) {
    sent = send_error("it takes more than " + std::to_string(limits.memory >> 20) + " MiB of memory");
  } catch (const std::exception& error) {
    sent = send_error(error.what());
  } catch (...) {
    sent = send_error("an unknown exception");
  }
  ::_exit(sent ? 0 : 1);
}

/// The parent's view of the child: killed and reaped at the latest when this goes.
class Child {
 public:
  explicit Child(pid_t pid) : pid_(pid) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (pid_ < 0) return;
    ::kill(pid_, SIGKILL);
    wait();
  }
  /// How it ended, as `waitpid` says it; 0 where somebody else has reaped it.
  int wait() {
    int status = 0;
    if (uninterrupted([&] { return ::waitpid(pid_, &status, 0); }) < 0) status = 0;
    pid_ = -1;
    return status;
  }

 private:
  pid_t pid_;
};

enum class Received { all, partial, too_late };

/// Fills `data` from the pipe until it is full, the other end closes, or it is too late.
Received receive(int pipe, void* data, std::size_t size, Clock::time_point until) {
  char* next = static_cast<char*>(data);
  while (size > 0) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
    if (left <= 0) return Received::too_late;
    pollfd ready{pipe, POLLIN, 0};
    const int count = ::poll(&ready, 1, static_cast<int>(std::min<std::int64_t>(left, 60'000)));
    if (count == 0 || (count < 0 && errno == EINTR)) continue;
    const ssize_t got = count < 0 ? -1 : uninterrupted([&] { return ::read(pipe, next, size); });
    if (got <= 0) return Received::partial;
    next += got;
    size -= static_cast<std::size_t>(got);
  }
  return Received::all;
}

Received receive_answer(int pipe, std::string& answer, std::size_t longest, Clock::time_point until) {
  std::uint64_t total = 0;
  const Received header = receive(pipe, &total, sizeof total, until);
  if (header != Received::all) return header;
  if (total == 0 || total > longest) return Received::partial;
  answer.resize(total);
  return receive(pipe, answer.data(), answer.size(), until);
}

std::string seconds_text(double seconds) {
  std::ostringstream text;
  text << seconds << " s";
  return text.str();
}

std::string ending(int status, const MeshFileLimits& limits) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    return "the import took more than " + seconds_text(limits.seconds);
  if (WIFSIGNALED(status)) return "the importer crashed (signal " + std::to_string(WTERMSIG(status)) + ")";
  return "the importer ended without an answer (exit code " + std::to_string(WEXITSTATUS(status)) + ")";
}

Clock::time_point after(double seconds) {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(bounded(seconds)));
}

/// Imports in a child process. The answer's first letter is an `Answer`; throws `bad_mesh` if there is none.
std::string import_in_child(const std::filesystem::path& path, const std::string& bytes, const std::string& format,
                            const MeshFileLimits& limits) {
  const Clock::time_point until = after(limits.seconds);
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw Error(Status::internal, path.string() + ": no pipe: " + system_message());
  Descriptor read_end(ends[0]);
  Descriptor write_end(ends[1]);
  const pid_t pid = ::fork();
  if (pid < 0) throw Error(Status::internal, path.string() + ": no process to import it in: " + system_message());
  if (pid == 0) import_and_exit(write_end.get(), bytes, format, limits);
  Child child(pid);
  write_end.close();

  std::string answer;
  const std::size_t longest = 1 + std::max(longest_error_text, limits.triangles * bytes_per_triangle);
  const Received received = receive_answer(read_end.get(), answer, longest, until);
  if (received == Received::all) return answer;
  read_end.close();  // a child that still writes must end before it is waited for
  const std::string why = received == Received::too_late ? "the import took more than " + seconds_text(limits.seconds)
                                                         : ending(child.wait(), limits);
  fail(Status::bad_mesh, path, "a file that can't be imported: " + why, "a mesh in the format ." + format);
}

Mesh mesh_from_answer(const std::filesystem::path& path, const std::string& answer, const std::string& format) {
  const std::string_view payload = std::string_view(answer).substr(1);
  if (static_cast<Answer>(answer[0]) != Answer::triangles)
    fail(Status::bad_mesh, path, "a file that can't be imported: " + std::string(payload),
         "a mesh in the format ." + format);
  const std::size_t count = payload.size() / bytes_per_triangle;
  if (count == 0) fail(Status::bad_mesh, path, "no triangles", "at least one");
  Mesh mesh;
  mesh.vertices.resize(3 * count);
  std::memcpy(mesh.vertices.front().data(), payload.data(), count * bytes_per_triangle);
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

void check_bytes(const std::filesystem::path& path, const std::string& bytes) {
  if (bytes.empty()) fail(Status::bad_mesh, path, "an empty file", "a mesh");
  if (bytes.find_first_not_of('\0') == std::string::npos)
    fail(Status::bad_mesh, path, std::to_string(bytes.size()) + " zero bytes", "a mesh");
}

void check_scale(const std::filesystem::path& path, const Vector3& scale) {
  if (scale.allFinite() && (scale.array() != 0.0).all()) return;
  std::ostringstream text;
  text << "the scale " << scale.transpose();
  fail(Status::bad_mesh, path, text.str(), "three finite numbers other than 0");
}

}  // namespace

Mesh load_mesh(const std::filesystem::path& path, const Vector3& scale, const MeshFileLimits& limits) {
  const std::string bytes = read_file(path, limits.bytes);
  const std::string format = format_of(path);
  check_bytes(path, bytes);
  check_scale(path, scale);
  Mesh mesh = mesh_from_answer(path, import_in_child(path, bytes, format, limits), format);
  apply_scale(mesh, scale);
  check_finite(path, mesh);
  mesh = merged_vertices(mesh);
  if (mesh.triangles.empty()) fail(Status::bad_mesh, path, "only triangles without area", "one with area");
  orient_outward(mesh);
  return mesh;
}

}  // namespace tactus::geometry
