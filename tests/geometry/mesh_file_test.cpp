// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/mesh_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <thread>

#include "support/error.hpp"

namespace tactus::geometry {
namespace {

namespace fs = std::filesystem;
using support::Error;
using support::Status;

const Vector3 size(0.1, 0.2, 0.3);

template <typename T>
void put(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

std::string binary_stl(const Mesh& mesh, const std::string& title) {
  std::string bytes = title;
  bytes.resize(80, ' ');
  put(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) put(bytes, 0.0f);
    for (const std::int32_t v : triangle)
      for (int i = 0; i < 3; ++i) put(bytes, static_cast<float>(mesh.vertices[v][i]));
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}

std::string ascii_stl(const Mesh& mesh) {
  std::ostringstream text;
  text << "solid box\n";
  for (const Triangle& triangle : mesh.triangles) {
    text << "facet normal 0 0 0\n outer loop\n";
    for (const std::int32_t v : triangle) text << "  vertex " << mesh.vertices[v].transpose() << '\n';
    text << " endloop\nendfacet\n";
  }
  text << "endsolid box\n";
  return text.str();
}

std::string obj(const Mesh& mesh) {
  std::ostringstream text;
  text << "mtllib beside.mtl\no box\nusemtl red\n";
  for (const Vector3& v : mesh.vertices) text << "v " << v.transpose() << '\n';
  for (const Triangle& t : mesh.triangles) text << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  return text.str();
}

std::string ply(const Mesh& mesh) {
  std::ostringstream text;
  text << "ply\nformat ascii 1.0\nelement vertex " << mesh.vertices.size()
       << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << mesh.triangles.size()
       << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vector3& v : mesh.vertices) text << v.transpose() << '\n';
  for (const Triangle& t : mesh.triangles) text << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  return text.str();
}

/// `mesh` is in `unit` metres; its node stands `shift` units along x.
std::string dae(const Mesh& mesh, double unit, const std::string& up_axis, double shift) {
  std::ostringstream text;
  text << R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="stated" meter=")"
       << unit << R"("/><up_axis>)" << up_axis << R"(</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count=")"
       << 3 * mesh.vertices.size() << "\">";
  for (const Vector3& v : mesh.vertices) text << v.transpose() << ' ';
  text << R"(</float_array><technique_common><accessor source="#a" count=")" << mesh.vertices.size()
       << R"(" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
</accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count=")"
       << mesh.triangles.size() << R"("><input semantic="VERTEX" source="#v" offset="0"/><p>)";
  for (const Triangle& t : mesh.triangles) text << t[0] << ' ' << t[1] << ' ' << t[2] << ' ';
  text << R"(</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><translate>)"
       << shift << R"( 0 0</translate><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
  return text.str();
}

Mesh scaled(Mesh mesh, double by) {
  for (Vector3& v : mesh.vertices) v *= by;
  return mesh;
}

class MeshFile : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "tactus_mesh_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }

  static void expect_box(const Mesh& mesh, const Vector3& centre = Vector3::Zero()) {
    EXPECT_EQ(mesh.vertices.size(), 8u);
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_LT((bounds(mesh).size() - size).norm(), 1e-6);
    EXPECT_LT((bounds(mesh).centre() - centre).norm(), 1e-6);
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_NEAR(signed_volume(mesh), size.prod(), 1e-8);
  }

  /// The error must have this status, name the file, and contain `text`.
  static void expect_error(const fs::path& path, Status status, const std::string& text,
                           const Vector3& scale = Vector3::Ones(), const MeshFileLimits& limits = {}) {
    try {
      load_mesh(path, scale, limits);
      ADD_FAILURE() << path << " loads";
    } catch (const Error& error) {
      const std::string what = error.what();
      EXPECT_EQ(error.status(), status) << what;
      EXPECT_NE(what.find(path.string()), std::string::npos) << what;
      EXPECT_NE(what.find(text), std::string::npos) << what;
      EXPECT_NE(what.find("expected"), std::string::npos) << what;
    }
  }

  fs::path folder_;
  const Mesh box_ = box_mesh(size);
};

TEST_F(MeshFile, ReadsBinaryStl) { expect_box(load_mesh(write("box.stl", binary_stl(box_, "a title")))); }

TEST_F(MeshFile, ReadsBinaryStlWhoseTitleBeginsWithSolid) {
  expect_box(load_mesh(write("box.stl", binary_stl(box_, "solid box, by an exporter"))));
}

TEST_F(MeshFile, ReadsAsciiStl) { expect_box(load_mesh(write("box.stl", ascii_stl(box_)))); }

TEST_F(MeshFile, ReadsUpperCaseExtension) { expect_box(load_mesh(write("BOX.STL", binary_stl(box_, "")))); }

TEST_F(MeshFile, ReadsObjWithoutItsMaterials) {
  expect_box(load_mesh(write("absent.obj", obj(box_))));
  ASSERT_EQ(::mkfifo((folder_ / "beside.mtl").c_str(), 0600), 0);  // reading it would block
  expect_box(load_mesh(write("present.obj", obj(box_))));
}

TEST_F(MeshFile, ReadsPly) { expect_box(load_mesh(write("box.ply", ply(box_)))); }

TEST_F(MeshFile, AppliesTheUnitOfADaeAndIgnoresItsUpAxis) {
  for (const char* up_axis : {"X_UP", "Y_UP", "Z_UP"}) {
    const fs::path file = write("box.dae", dae(scaled(box_, 100.0), 0.01, up_axis, 50.0));
    expect_box(load_mesh(file), Vector3(0.5, 0.0, 0.0));
  }
}

TEST_F(MeshFile, DropsPointsAndLines) {
  expect_box(load_mesh(write("mixed.obj", obj(box_) + "v 9 9 9\nv 9 9 8\np 9\nl 9 10\n")));
}

TEST_F(MeshFile, SplitsPolygons) {
  const Mesh square = load_mesh(write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"));
  EXPECT_EQ(square.triangles.size(), 2u);
}

TEST_F(MeshFile, ScalesByAxis) {
  const fs::path file = write("box.stl", binary_stl(scaled(box_, 1000.0), ""));
  expect_box(load_mesh(file, Vector3::Constant(0.001)));
  const Mesh stretched = load_mesh(file, Vector3(0.001, 0.002, 0.003));
  EXPECT_LT((bounds(stretched).size() - Vector3(0.1, 0.4, 0.9)).norm(), 1e-6);
}

TEST_F(MeshFile, KeepsTheOutsideUnderAMirroringScale) {
  const Mesh mirrored = load_mesh(write("box.stl", binary_stl(box_, "")), Vector3(-1, 1, 1));
  EXPECT_NEAR(signed_volume(mirrored), size.prod(), 1e-8);
  const Mesh open = load_mesh(write("flat.obj", "v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\n"), Vector3(-1, 1, 1));
  const Triangle& t = open.triangles.at(0);
  const Vector3 normal = (open.vertices[t[1]] - open.vertices[t[0]]).cross(open.vertices[t[2]] - open.vertices[t[0]]);
  EXPECT_GT(normal.z(), 0.0);
}

TEST_F(MeshFile, TurnsInsideOutShells) {
  Mesh inside_out = box_;
  for (Triangle& t : inside_out.triangles) std::swap(t[0], t[1]);
  expect_box(load_mesh(write("box.stl", binary_stl(inside_out, ""))));
}

TEST_F(MeshFile, RefusesWhatIsNoMesh) {
  expect_error(write("empty.stl", ""), Status::bad_mesh, "an empty file");
  expect_error(write("zeros.stl", std::string(80, '\0')), Status::bad_mesh, "80 zero bytes");
  for (const char* name : {"garbage.stl", "garbage.obj", "garbage.ply", "garbage.dae"})
    expect_error(write(name, "the quick brown fox\njumps over\n"), Status::bad_mesh, "expected");
  expect_error(write("cloud.ply",
                     "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                     "property float z\nend_header\n1 2 3\n"),
               Status::bad_mesh, "expected");
}

TEST_F(MeshFile, RefusesTruncatedFiles) {
  for (const char* title : {"a title", "solid title"}) {
    const std::string good = binary_stl(box_, title);
    for (const std::size_t length : {10u, 83u, 84u, 100u, 400u, 683u})
      expect_error(write("cut.stl", good.substr(0, length)), Status::bad_mesh, "expected");
  }
  const std::string scene = dae(box_, 1.0, "Z_UP", 0.0);
  expect_error(write("cut.dae", scene.substr(0, scene.size() / 2)), Status::bad_mesh, "expected");
}

TEST_F(MeshFile, GivesUpOnAFileWhoseImportNeverEnds) {
  const fs::path file = write("cut.ply", ply(box_).substr(0, 150));
  MeshFileLimits limits;
  limits.seconds = 0.2;
  expect_error(file, Status::bad_mesh, "took more than 0.2 s", Vector3::Ones(), limits);
}

TEST_F(MeshFile, SurvivesACrashOfTheImporter) {
  const std::string scene = dae(box_, 1.0, "Z_UP", 0.0);
  const std::size_t from = scene.find("<node"), to = scene.find("</visual_scene>");
  std::string deep = scene.substr(from, to - from);
  std::string opening, closing;
  for (int i = 0; i < 200'000; ++i) opening += "<node>", closing += "</node>";
  deep = scene.substr(0, from) + opening + deep + closing + scene.substr(to);
  expect_error(write("deep.dae", deep), Status::bad_mesh, "the importer crashed (signal 11)");
}

TEST_F(MeshFile, LoadsInAProgramThatIgnoresItsChildren) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  expect_box(load_mesh(write("box.stl", binary_stl(box_, ""))));
  expect_error(write("garbage.stl", "the quick brown fox"), Status::bad_mesh, "can't be imported");
  std::signal(SIGCHLD, before);
}

TEST_F(MeshFile, RefusesVerticesThatAreNotFinite) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Mesh mesh = box_;
    mesh.vertices[3].y() = bad;
    expect_error(write("bad.stl", binary_stl(mesh, "")), Status::bad_mesh, "isn't finite");
  }
}

TEST_F(MeshFile, RefusesTrianglesWithoutArea) {
  expect_error(write("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), Status::bad_mesh, "without area");
}

TEST_F(MeshFile, RefusesIndicesOutOfRange) {
  expect_error(write("wild.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"), Status::bad_mesh, "expected");
  expect_error(write("wild.ply",
                     "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                     "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                     "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 900\n"),
               Status::bad_mesh, "expected");
}

TEST_F(MeshFile, RefusesWhatIsNoRegularFile) {
  expect_error(folder_ / "missing.stl", Status::file_not_found, "no such file");
  expect_error(write("box.step", "x"), Status::bad_mesh, "\".step\"");
  fs::create_directory(folder_ / "folder.stl");
  expect_error(folder_ / "folder.stl", Status::file_unreadable, "a folder");
  ASSERT_EQ(::mkfifo((folder_ / "pipe.stl").c_str(), 0600), 0);
  expect_error(folder_ / "pipe.stl", Status::file_unreadable, "regular file");
}

TEST_F(MeshFile, RefusesAScaleOfZeroOrNan) {
  const fs::path file = write("box.stl", binary_stl(box_, ""));
  expect_error(file, Status::bad_mesh, "the scale", Vector3(1, 0, 1));
  expect_error(file, Status::bad_mesh, "the scale", Vector3(1, 1, std::numeric_limits<double>::quiet_NaN()));
}

TEST_F(MeshFile, HoldsItsLimits) {
  const fs::path file = write("box.stl", binary_stl(box_, ""));
  MeshFileLimits few_bytes;
  few_bytes.bytes = 100;
  expect_error(file, Status::bad_mesh, "684 bytes", Vector3::Ones(), few_bytes);
  MeshFileLimits few_triangles;
  few_triangles.triangles = 11;
  expect_error(file, Status::bad_mesh, "more than 11 triangles", Vector3::Ones(), few_triangles);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  std::string many = "solid many\n";
  for (int i = 0; i < 100'000; ++i) many += "facet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\n";
  MeshFileLimits little_memory;
  little_memory.memory = 1u << 20;
  expect_error(write("many.stl", many), Status::bad_mesh, "memory", Vector3::Ones(), little_memory);
#endif
}

TEST_F(MeshFile, LoadsFromManyThreadsAtOnce) {
  const fs::path file = write("box.stl", binary_stl(box_, ""));
  std::atomic<int> good = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([&] {
      for (int k = 0; k < 10; ++k) good += load_mesh(file).triangles.size() == 12u ? 1 : 0;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(good, 80);
}

TEST(MeshFolder, EveryRealMeshLoadsExceptTheKnownBadOne) {
  const char* named = std::getenv("TACTUS_TEST_MODELS");
  const fs::path folder = named != nullptr ? fs::path(named) : fs::path(TACTUS_SOURCE_DIR) / "../shared/models";
  if (!fs::is_directory(folder)) GTEST_SKIP() << "no models at " << folder;
  int loaded = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".stl" && extension != ".STL" && extension != ".dae" && extension != ".obj") continue;
    if (entry.path().filename() == "EndEffector_Link.STL") {
      EXPECT_THROW(load_mesh(entry.path()), Error);
      continue;
    }
    SCOPED_TRACE(entry.path());
    Mesh mesh;
    ASSERT_NO_THROW(mesh = load_mesh(entry.path()));
    EXPECT_FALSE(mesh.triangles.empty());
    ++loaded;
  }
  EXPECT_GT(loaded, 0);
}

}  // namespace
}  // namespace tactus::geometry
