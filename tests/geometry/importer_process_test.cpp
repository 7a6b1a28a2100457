// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/importer_process.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>

#include "support/descriptor.hpp"
#include "support/error.hpp"

namespace tactus::geometry {
namespace {

namespace fs = std::filesystem;
using support::Descriptor;
using support::Error;
using support::Status;
using namespace std::chrono_literals;

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string endless = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\n";

/// A folder with a mesh file, and room for importers that aren't the real one.
class ImporterProcess : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "tactus_importer_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  Descriptor mesh_file(const std::string& content = triangle) const {
    std::ofstream(path_in_folder("mesh.obj")) << content;
    return Descriptor(::open(path_in_folder("mesh.obj").c_str(), O_RDONLY | O_CLOEXEC));
  }
  ImportJob job(const Descriptor& file, const std::string& format = "obj") const {
    return {path_in_folder("mesh.obj"), file.get(), format, {}};
  }
  fs::path path_in_folder(const std::string& name) const { return folder_ / name; }

  /// The module whose importer is this shell script.
  fs::path module_with(const std::string& script, const std::string& place = "tactus") const {
    const fs::path importer = folder_ / place / importer_name;
    fs::create_directories(importer.parent_path());
    std::ofstream(importer) << "#!/bin/sh\n" << script << '\n';
    fs::permissions(importer, fs::perms::owner_all);
    return folder_ / "libtactus.so";
  }
  std::string answer_of(const std::string& script) const {
    const Descriptor file = mesh_file();
    const ImportAnswer answer = run_importer(job(file), module_with(script));
    EXPECT_EQ(answer.kind, Answer::no_mesh);
    return answer.content;
  }
  std::string error_of(const fs::path& module) const {
    const Descriptor file = mesh_file();
    try {
      run_importer(job(file), module);
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), Status::internal);
      return error.what();
    }
    ADD_FAILURE() << "no error";
    return {};
  }
  void expect_triangle() const {
    const Descriptor file = mesh_file();
    const ImportAnswer answer = run_importer(job(file));
    EXPECT_EQ(answer.kind, Answer::triangles) << answer.content;
    EXPECT_EQ(answer.content.size(), bytes_per_triangle);
  }

  fs::path folder_;
};

auto open_descriptors() { return std::distance(fs::directory_iterator("/proc/self/fd"), {}); }

/// Sets how this process takes the end of its children, until this goes.
class OnChildsEnd {
 public:
  explicit OnChildsEnd(void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    ::sigaction(SIGCHLD, &action, &before_);
  }
  ~OnChildsEnd() { ::sigaction(SIGCHLD, &before_, nullptr); }

 private:
  struct sigaction before_ {};
};

TEST_F(ImporterProcess, OwnModuleIsThisProgram) { EXPECT_EQ(own_module(), fs::canonical("/proc/self/exe")); }

TEST_F(ImporterProcess, LeavesNeitherChildNorDescriptorBehind) {
  const auto before = open_descriptors();
  expect_triangle();
  answer_of("exit 1");
  error_of(folder_ / "elsewhere" / "libtactus.so");
  const Descriptor file = mesh_file(endless);
  ImportJob late = job(file, "ply");
  late.limits.seconds = 0.1;
  EXPECT_EQ(run_importer(late).content, "the import took more than 0.1 s");
  EXPECT_EQ(open_descriptors(), before + 1);  // `file`
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
}

TEST_F(ImporterProcess, AnswersToAnyArguments) {
  const std::string importer = (own_module().parent_path().parent_path() / "lib" / "tactus" / importer_name).string();
  const std::string silent = folder_.string() + "/errors";
  for (const char* arguments : {"", "1 obj", "none obj 1 1 1", "1 obj 1 1 99999999999999999999", "1 obj 1 1 1 1"}) {
    EXPECT_EQ(answer_of("exec " + importer + " " + arguments + " 2> " + silent),
              "this program is for libtactus.so to start")
        << arguments;
    EXPECT_EQ(fs::file_size(silent), 0u);
  }
}

TEST_F(ImporterProcess, DoesNotForkItsCaller) {
  static int forks = 0;
  ASSERT_EQ(::pthread_atfork([] { ++forks; }, nullptr, nullptr), 0);
  forks = 0;
  expect_triangle();
  EXPECT_EQ(forks, 0);
}

TEST_F(ImporterProcess, ImportsWhileAnotherThreadHoldsLocksOfTheSystems) {
  std::atomic<bool> locked = false, done = false;
  std::thread holder([&] {
    ::flockfile(stdout);
    locked = true;
    while (!done) std::make_unique<std::array<char, 4096>>()->front() = 1;
    ::funlockfile(stdout);
  });
  while (!locked) std::this_thread::yield();
  expect_triangle();
  done = true;
  holder.join();
}

TEST_F(ImporterProcess, ImportsInAProgramThatReapsOrIgnoresEveryChild) {
  for (void (*handler)(int) : {SIG_IGN, +[](int) {
                                 while (::waitpid(-1, nullptr, WNOHANG) > 0) continue;
                               }}) {
    const OnChildsEnd handled(handler);
    expect_triangle();
    EXPECT_NE(answer_of("exit 1"), "");
  }
}

TEST_F(ImporterProcess, ImportsInAProgramWithBlockedSignals) {
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  expect_triangle();
  EXPECT_EQ(answer_of("kill -TERM $$"), "the importer crashed (signal 15)");
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

TEST_F(ImporterProcess, ImportsInAProgramWithoutStandardStreams) {
  std::array<int, 3> kept;
  for (int fd = 0; fd < 3; ++fd) kept[fd] = ::fcntl(fd, F_DUPFD_CLOEXEC, 3);
  for (int fd = 0; fd < 3; ++fd) ::close(fd);
  expect_triangle();
  for (int fd = 0; fd < 3; ++fd)
    if (kept[fd] >= 0) ::dup2(kept[fd], fd), ::close(kept[fd]);
}

TEST_F(ImporterProcess, HandsOnNeitherDescriptorsNorTheEnvironment) {
  const Descriptor inherited(::fcntl(STDIN_FILENO, F_DUPFD, 50));
  ::setenv("TACTUS_TEST_SECRET", "secret", 1);
  const std::string number = std::to_string(inherited.get());
  EXPECT_EQ(answer_of("[ -e /proc/$$/fd/" + number + " ] && exit 3\n[ -n \"$TACTUS_TEST_SECRET\" ] && exit 4\nexit 5"),
            "the importer ended without an answer (exit code 5)");
  ::unsetenv("TACTUS_TEST_SECRET");
}

TEST_F(ImporterProcess, HandsOnWhereLibrariesAre) {
  const char* before = std::getenv("LD_LIBRARY_PATH");
  const std::string kept = before == nullptr ? "" : before;
  ::setenv("LD_LIBRARY_PATH", "/tactus/test", 1);
  EXPECT_EQ(answer_of("[ \"$LD_LIBRARY_PATH\" = /tactus/test ] && exit 5"),
            "the importer ended without an answer (exit code 5)");
  before == nullptr ? ::unsetenv("LD_LIBRARY_PATH") : ::setenv("LD_LIBRARY_PATH", kept.c_str(), 1);
}

TEST_F(ImporterProcess, ACrashIsAnAnswer) {
  EXPECT_EQ(answer_of("kill -SEGV $$"), "the importer crashed (signal 11)");
  EXPECT_EQ(answer_of("printf '\\006\\0\\0\\0\\0\\0\\0\\0Ehal'; exit 7"),
            "the importer ended without an answer (exit code 7)");
}

TEST_F(ImporterProcess, NonsenseIsAnAnswer) {
  for (const char* script : {
           "echo the quick brown fox",                     // a length that no answer has
           "printf '\\001\\0\\0\\0\\0\\0\\0\\0Xx'",        // an unknown kind
           "printf '\\007\\0\\0\\0\\0\\0\\0\\0T1234567'",  // a piece of a triangle
           "printf '\\0\\020\\001\\0\\0\\0\\0\\0E'",       // a text of 68 KiB
       })
    EXPECT_EQ(answer_of(std::string(script) + "\nwhile :; do :; done"), "the importer answered nonsense") << script;
}

TEST_F(ImporterProcess, WordsComeThrough) {
  EXPECT_EQ(answer_of("printf '\\005\\0\\0\\0\\0\\0\\0\\0Ehallo'"), "hallo");
  const Descriptor file = mesh_file();
  const ImportAnswer answer = run_importer(job(file), module_with("printf '\\007\\0\\0\\0\\0\\0\\0\\0Ubad disk'"));
  EXPECT_EQ(answer.kind, Answer::unreadable);
  EXPECT_EQ(answer.content, "bad dis");
}

TEST_F(ImporterProcess, IsFoundInThreePlaces) {
  module_with("exit 5", "lib/tactus");
  const Descriptor file = mesh_file();
  const std::string found = "the importer ended without an answer (exit code 5)";
  EXPECT_EQ(run_importer(job(file), folder_ / "lib" / "libtactus.so").content, found);
  EXPECT_EQ(run_importer(job(file), folder_ / "bin" / "program").content, found);
  EXPECT_EQ(run_importer(job(file), folder_ / "lib" / "tactus" / "libtactus.so").content, found);
}

TEST_F(ImporterProcess, AMissingOneIsAnErrorThatSaysWhereItWasLookedFor) {
  const std::string error = error_of(folder_ / "lib" / "libtactus.so");
  for (const char* place : {"lib/tactus/tactus-import-mesh", "lib/tactus-import-mesh", "mesh.obj"})
    EXPECT_NE(error.find((folder_ / place).string()), std::string::npos) << error;
  EXPECT_NE(error.find("install tactus again"), std::string::npos) << error;
}

TEST_F(ImporterProcess, OneThatIsNoProgramIsAnError) {
  const fs::path module = module_with("");
  fs::permissions(folder_ / "tactus" / importer_name, fs::perms::owner_read);
  const std::string error = error_of(module);
  EXPECT_NE(error.find("can't be started: Permission denied"), std::string::npos) << error;
  EXPECT_NE(error.find((folder_ / "tactus" / importer_name).string()), std::string::npos) << error;
}

pid_t first_child_of(pid_t parent) {
  const std::string number = std::to_string(parent);
  pid_t child = 0;
  std::ifstream("/proc/" + number + "/task/" + number + "/children") >> child;
  return child;
}

TEST_F(ImporterProcess, EndsWithItsCaller) {
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  const Descriptor file = mesh_file(endless);
  const pid_t caller = ::fork();
  if (caller == 0) {
    run_importer(job(file, "ply"));
    ::_exit(0);
  }
  pid_t importer = 0;
  for (int i = 0; i < 1000 && (importer = first_child_of(caller)) == 0; ++i) std::this_thread::sleep_for(5ms);
  ::kill(caller, SIGKILL);
  EXPECT_EQ(::waitpid(caller, nullptr, 0), caller);
  ASSERT_GT(importer, 0);
  const auto killed = std::chrono::steady_clock::now();
  EXPECT_EQ(::waitpid(importer, nullptr, 0), importer);
  EXPECT_LT(std::chrono::steady_clock::now() - killed, 5s);
  ::prctl(PR_SET_CHILD_SUBREAPER, 0);
}

}  // namespace
}  // namespace tactus::geometry
