// SPDX-License-Identifier: BSD-3-Clause
#include <sys/stat.h>

#include "robot/package_path.hpp"
#include "robots.hpp"

namespace tactus::robot {
namespace {

using testing::TempFolder;
namespace fs = std::filesystem;

/// pkgs/arm/m.stl is the mesh; secret.stl lies outside of the package; robots/robot.urdf names them.
class MeshPathTest : public ::testing::Test {
 protected:
  MeshPathTest() {
    folder.write("pkgs/arm/m.stl", tetrahedron);
    folder.write("pkgs/army/m.stl", tetrahedron);
    folder.write("secret.stl", tetrahedron);
    folder.write("robots/near.stl", tetrahedron);
    source.urdf = folder.path() / "robots/robot.urdf";
    source.package_roots["arm"] = folder.path() / "pkgs/arm";
  }

  void expect_resolved(const std::string& uri, const fs::path& file) {
    const MeshPath mesh = resolve_mesh(uri, source);
    EXPECT_EQ(mesh.found, "") << uri;
    EXPECT_EQ(mesh.path, folder.path() / file) << uri;
  }

  void expect_refused(const std::string& uri, const std::string& because) {
    const MeshPath mesh = resolve_mesh(uri, source);
    EXPECT_TRUE(mesh.path.empty()) << uri;
    EXPECT_NE(mesh.found.find(because), std::string::npos) << uri << ": " << mesh.found;
    EXPECT_NE(mesh.expected, "") << uri;
  }

  static constexpr const char* tetrahedron =
      "solid t\n"
      "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n"
      "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
      "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 0 1 0\nendloop\nendfacet\n"
      "facet normal 0 0 0\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\n"
      "endsolid t\n";
  TempFolder folder;
  ModelSource source;
};

TEST_F(MeshPathTest, NamedPackage) {
  expect_resolved("package://arm/m.stl", "pkgs/arm/m.stl");
  expect_resolved("package://arm/../arm/m.stl", "pkgs/arm/m.stl");
}

TEST_F(MeshPathTest, PackageInOneOfTheSearchedFolders) {
  source.package_roots = {{"", folder.path().string() + "/robots:" + folder.path().string() + "/pkgs"}};
  expect_resolved("package://army/m.stl", "pkgs/army/m.stl");
  expect_refused("package://robots/near.stl", "unknown package");
  expect_refused("package://../secret.stl", "..");
}

TEST_F(MeshPathTest, PathsFromTheUrdfsFolder) {
  expect_resolved("near.stl", "robots/near.stl");
  expect_resolved("../secret.stl", "secret.stl");
}

TEST_F(MeshPathTest, AbsolutePaths) {
  expect_resolved((folder.path() / "secret.stl").string(), "secret.stl");
  expect_resolved("file://" + (folder.path() / "secret.stl").string(), "secret.stl");
}

TEST_F(MeshPathTest, NothingLeavesAPackage) {
  expect_refused("package://arm/../../secret.stl", "leaves its package");
  expect_refused("package://arm/../army/m.stl", "leaves its package");
  fs::create_symlink(folder.path() / "secret.stl", folder.path() / "pkgs/arm/link.stl");
  expect_refused("package://arm/link.stl", "leaves its package");
}

TEST_F(MeshPathTest, OtherSchemesAndPackages) {
  expect_refused("http://example.com/m.stl", "http://");
  expect_refused("model://arm/m.stl", "model://");
  expect_refused("package://leg/m.stl", "unknown package");
  expect_refused("package:///m.stl", "package:///");
}

TEST_F(MeshPathTest, WhatIsNoFile) {
  ASSERT_EQ(mkfifo((folder.path() / "pkgs/arm/fifo.stl").c_str(), 0600), 0);
  expect_refused("package://arm/fifo.stl", "not a regular file");
  expect_refused("package://arm", "not a regular file");
  expect_refused("package://arm/none.stl", "no file");
}

geometry::Box loaded_bounds(const TempFolder& folder, ModelSource source, const std::string& mesh) {
  source.urdf = folder.write("robots/robot.urdf", "<robot name='r'><link name='a'><collision><geometry>" + mesh +
                                                      "</geometry></collision></link></robot>");
  const RobotModel model = load_model(source);
  EXPECT_GT(geometry::signed_volume(model.links[0].shapes.at(0)), 0.0);
  return geometry::bounds(model.links[0].shapes.at(0));
}

TEST_F(MeshPathTest, MeshesAreScaledAndMirrored) {
  const geometry::Box box = loaded_bounds(folder, source, "<mesh filename='package://arm/m.stl' scale='0.5 -1 2'/>");
  EXPECT_TRUE(box.low.isApprox(geometry::Vector3(0.0, -1.0, 0.0)));
  EXPECT_TRUE(box.high.isApprox(geometry::Vector3(0.5, 0.0, 2.0)));
}

TEST_F(MeshPathTest, ABrokenMeshIsNamedWithItsLink) {
  folder.write("robots/broken.stl", std::string(80, '\0'));
  try {
    loaded_bounds(folder, source, "<mesh filename='broken.stl'/>");
    FAIL() << "was accepted";
  } catch (const support::Error& error) {
    EXPECT_EQ(error.status(), support::Status::bad_robot);
    EXPECT_NE(std::string(error.what()).find("link a"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("broken.stl"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tactus::robot
