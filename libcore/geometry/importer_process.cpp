// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/importer_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <new>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include "support/descriptor.hpp"
#include "support/error.hpp"

namespace tactus::geometry {
namespace {

namespace fs = std::filesystem;
using support::Descriptor;
using support::Error;
using support::Status;
using support::uninterrupted;
using Clock = std::chrono::steady_clock;

[[noreturn]] void fail(const ImportJob& job, const std::string& why) {
  throw Error(Status::internal, job.path.string() + ": " + why);
}

std::string system_message(int error = errno) { return std::generic_category().message(error); }

std::vector<fs::path> places_of_the_importer(const fs::path& module) {
  const fs::path folder = module.parent_path();
  if (folder.filename() == "bin")  // a program that holds the library
    return {folder.parent_path() / "lib" / "tactus" / importer_name};
  return {
      folder / "tactus" / importer_name,  // in an installation
      folder / importer_name,             // in a Python package
  };
}

fs::path importer_of(const ImportJob& job, const fs::path& module) {
  std::string places;
  for (const fs::path& place : places_of_the_importer(module)) {
    std::error_code unknown;
    if (fs::exists(place, unknown)) return place;
    places += (places.empty() ? "" : " or ") + place.string();
  }
  fail(job, "found no mesh importer to read it with, expected " + places +
                "; install tactus again, or put that program back beside libtactus.so");
}

/// What clocks and limits can hold.
double bounded(double seconds) { return std::clamp(seconds, 0.0, 1e6); }

Clock::time_point after(double seconds) {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(bounded(seconds)));
}

std::vector<std::string> arguments_for(const ImportJob& job) {
  const auto seconds = static_cast<std::int64_t>(std::ceil(bounded(job.limits.seconds))) + 1;
  return {importer_name,           std::to_string(::getpid()),       job.format, std::to_string(job.limits.triangles),
          std::to_string(seconds), std::to_string(job.limits.memory)};
}

/// Where the importer's libraries are is all that it needs to know of its surroundings.
std::vector<std::string> environment() {
  const char* libraries = std::getenv("LD_LIBRARY_PATH");
  if (libraries == nullptr) return {};
  return {std::string("LD_LIBRARY_PATH=") + libraries};
}

std::vector<char*> null_terminated(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// For what can fail only where there is no memory.
void check_memory(int error) {
  if (error != 0) throw std::bad_alloc();
}

constexpr int beyond_standard = STDERR_FILENO + 1;

/// The descriptors of the importer: its input and its output, both `beyond_standard`, and nothing of the caller's.
class SpawnFiles {
 public:
  SpawnFiles() { check_memory(::posix_spawn_file_actions_init(&actions_)); }
  SpawnFiles(const SpawnFiles&) = delete;
  SpawnFiles& operator=(const SpawnFiles&) = delete;
  ~SpawnFiles() { ::posix_spawn_file_actions_destroy(&actions_); }

  void set(int input, int output) {
    check_memory(::posix_spawn_file_actions_adddup2(&actions_, input, STDIN_FILENO));
    check_memory(::posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO));
    check_memory(::posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, "/dev/null", O_WRONLY, 0));
    check_memory(::posix_spawn_file_actions_addclosefrom_np(&actions_, beyond_standard));
  }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

/// The signals of the importer: none blocked, none ignored.
class SpawnSignals {
 public:
  SpawnSignals() {
    check_memory(::posix_spawnattr_init(&attributes_));
    sigset_t signals;
    ::sigemptyset(&signals);
    ::posix_spawnattr_setsigmask(&attributes_, &signals);
    ::sigfillset(&signals);
    ::posix_spawnattr_setsigdefault(&attributes_, &signals);
    ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  SpawnSignals(const SpawnSignals&) = delete;
  SpawnSignals& operator=(const SpawnSignals&) = delete;
  ~SpawnSignals() { ::posix_spawnattr_destroy(&attributes_); }

  const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_;
};

/// A caller without standard streams gets descriptors that the importer's would overwrite.
Descriptor moved_beyond_standard(const ImportJob& job, int fd) {
  Descriptor moved(::fcntl(fd, F_DUPFD_CLOEXEC, beyond_standard));
  if (moved.get() < 0) fail(job, "no descriptor to import it with: " + system_message());
  return moved;
}

pid_t spawn(const ImportJob& job, const fs::path& importer, int output) {
  const Descriptor in = moved_beyond_standard(job, job.file), out = moved_beyond_standard(job, output);
  SpawnFiles files;
  files.set(in.get(), out.get());
  const SpawnSignals signals;
  std::vector<std::string> arguments = arguments_for(job), variables = environment();
  pid_t pid = -1;
  const int error = ::posix_spawn(&pid, importer.c_str(), files.get(), signals.get(), null_terminated(arguments).data(),
                                  null_terminated(variables).data());
  if (error != 0) fail(job, "the mesh importer " + importer.string() + " can't be started: " + system_message(error));
  return pid;
}

/// The importer while it runs: killed and reaped at the latest when this goes.
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

enum class Received { all, partial, nonsense, too_late };

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

bool makes_sense(Answer kind, std::uint64_t size, const MeshFileLimits& limits) {
  switch (kind) {
    case Answer::triangles:
      return size % bytes_per_triangle == 0 && size / bytes_per_triangle <= limits.triangles;
    case Answer::no_mesh:
    case Answer::unreadable:
      return size <= longest_text;
  }
  return false;
}

Received receive_answer(int pipe, ImportAnswer& answer, const MeshFileLimits& limits, Clock::time_point until) {
  std::uint64_t size = 0;
  Received header = receive(pipe, &size, sizeof size, until);
  if (header == Received::all) header = receive(pipe, &answer.kind, sizeof answer.kind, until);
  if (header != Received::all) return header;
  if (!makes_sense(answer.kind, size, limits)) return Received::nonsense;
  answer.content.resize(size);
  return receive(pipe, answer.content.data(), size, until);
}

std::string too_long(const MeshFileLimits& limits) {
  std::ostringstream text;
  text << "the import took more than " << limits.seconds << " s";
  return text.str();
}

std::string ending(int status, const MeshFileLimits& limits) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) return too_long(limits);
  if (WIFSIGNALED(status)) return "the importer crashed (signal " + std::to_string(WTERMSIG(status)) + ")";
  return "the importer ended without an answer (exit code " + std::to_string(WEXITSTATUS(status)) + ")";
}

}  // namespace

fs::path own_module() {
  // not by `dladdr`: the path it gives may be relative to a folder that the process has left
  const auto here = reinterpret_cast<std::uintptr_t>(&own_module);
  std::ifstream mappings("/proc/self/maps");
  for (std::string mapping; std::getline(mappings, mapping);) {
    std::istringstream range(mapping);
    std::uintptr_t from = 0, to = 0;
    char dash = 0;
    range >> std::hex >> from >> dash >> to;
    const std::size_t path = mapping.find('/');
    if (from <= here && here < to && path != std::string::npos) return mapping.substr(path);
  }
  throw Error(Status::internal, "/proc/self/maps doesn't tell which file tactus was loaded from");
}

ImportAnswer run_importer(const ImportJob& job, const fs::path& module) {
  const fs::path importer = importer_of(job, module);
  const Clock::time_point until = after(job.limits.seconds);
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail(job, "no pipe: " + system_message());
  const Descriptor read_end(ends[0]);
  Descriptor write_end(ends[1]);
  Child child(spawn(job, importer, write_end.get()));
  write_end.close();

  ImportAnswer answer{};
  switch (receive_answer(read_end.get(), answer, job.limits, until)) {
    case Received::all:
      return answer;
    case Received::partial:
      return {Answer::no_mesh, ending(child.wait(), job.limits)};
    case Received::nonsense:
      return {Answer::no_mesh, "the importer answered nonsense"};
    case Received::too_late:
      break;
  }
  return {Answer::no_mesh, too_long(job.limits)};
}

}  // namespace tactus::geometry
