// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>

#include "capi/shelf.hpp"

namespace {

using shelf::expect_ok;
using shelf::expect_refused;

TEST(Scenario, RefusesNullAndNamesIt) {
  tactus_scenario* made = reinterpret_cast<tactus_scenario*>(8);
  expect_refused(tactus_scenario_load(nullptr, &made), TACTUS_INVALID_ARGUMENT, "path");
  EXPECT_EQ(made, nullptr);
  expect_refused(tactus_scenario_load("x", nullptr), TACTUS_INVALID_ARGUMENT, "scenario");
  expect_refused(tactus_scenario_parse("x", nullptr, &made), TACTUS_INVALID_ARGUMENT, "base_dir");
  std::size_t dof = 7;
  expect_refused(tactus_scenario_dof(nullptr, &dof), TACTUS_INVALID_ARGUMENT, "scenario");
  EXPECT_EQ(dof, 7u);
}

TEST(Scenario, AMissingFileIsNamed) {
  tactus_scenario* made = reinterpret_cast<tactus_scenario*>(8);
  expect_refused(tactus_scenario_load("/nowhere/at_all.yaml", &made), TACTUS_FILE_NOT_FOUND, "/nowhere/at_all.yaml");
  EXPECT_EQ(made, nullptr);
}

TEST(Scenario, MistakesInATextAreReportedAtOnce) {
  tactus_scenario* made = nullptr;
  expect_refused(tactus_scenario_parse("robot: {speed: 3}\nprior: 4\n", shelf::folder.c_str(), &made),
                 TACTUS_BAD_SCENARIO, "robot.speed");
  expect_refused(tactus_scenario_parse("robot: {speed: 3}\nprior: 4\n", shelf::folder.c_str(), &made),
                 TACTUS_BAD_SCENARIO, "prior");
  EXPECT_EQ(made, nullptr);
}

TEST(Scenario, CheckGivesTheMistakesAsText) {
  std::size_t count = 0;
  char text[4096];
  expect_ok(tactus_scenario_check("/nowhere/at_all.yaml", text, sizeof text, &count));
  EXPECT_NE(std::string(text).find("/nowhere/at_all.yaml"), std::string::npos) << text;
  EXPECT_EQ(count, std::string(text).size() + 1);
  char small[2] = {'?', '?'};
  expect_refused(tactus_scenario_check("/nowhere/at_all.yaml", small, 2, &count), TACTUS_BUFFER_TOO_SMALL, "text");
  EXPECT_EQ(small[0], '?');
}

TEST(Scenario, SaysWhatTheRobotIs) {
  const tactus_scenario* scenario = shelf::scenario();
  std::size_t dof = 0;
  const char* name = nullptr;
  expect_ok(tactus_scenario_dof(scenario, &dof));
  EXPECT_EQ(dof, 6u);
  expect_ok(tactus_scenario_name(scenario, &name));
  EXPECT_STREQ(name, "small_shelf");
  expect_ok(tactus_scenario_joint_name(scenario, 0, &name));
  EXPECT_STREQ(name, "shoulder_pan_joint");
  double lower = 0, upper = 0, velocity = 0;
  expect_ok(tactus_scenario_joint_limits(scenario, 0, &lower, &upper, &velocity));
  EXPECT_LT(lower, upper);
  EXPECT_GT(velocity, 0.0);
  expect_refused(tactus_scenario_joint_name(scenario, 6, &name), TACTUS_INVALID_ARGUMENT, "joint");
}

TEST(Scenario, AnArrayThatIsTooSmallIsLeftAlone) {
  double q[6] = {9, 9, 9, 9, 9, 9};
  std::size_t count = 0;
  expect_refused(tactus_scenario_start(shelf::scenario(), q, 5, &count), TACTUS_BUFFER_TOO_SMALL, "q");
  EXPECT_EQ(count, 6u);
  EXPECT_EQ(q[0], 9.0);
  expect_refused(tactus_scenario_start(shelf::scenario(), nullptr, 6, &count), TACTUS_INVALID_ARGUMENT, "q");
  expect_refused(tactus_scenario_start(shelf::scenario(), q, 6, nullptr), TACTUS_INVALID_ARGUMENT, "count");
  expect_ok(tactus_scenario_start(shelf::scenario(), nullptr, 0, &count));
  EXPECT_EQ(count, 6u);
}

TEST(Scenario, CostsAndLimitsAreTheFiles) {
  tactus_costs costs;
  tactus_limits limits;
  expect_ok(tactus_costs_init(&costs, sizeof costs));
  expect_ok(tactus_limits_init(&limits, sizeof limits));
  expect_ok(tactus_scenario_costs(shelf::scenario(), &costs));
  expect_ok(tactus_scenario_limits(shelf::scenario(), &limits));
  EXPECT_EQ(costs.metre, 1.0);
  EXPECT_EQ(costs.radian, 0.05);
  EXPECT_EQ(costs.action, 0.005);
  EXPECT_EQ(limits.actions, 3);
  EXPECT_EQ(limits.travel, 60.0);
  EXPECT_EQ(limits.seconds, 600.0);
  costs.struct_size = 16;  // an older caller: only `metre` is there
  costs.metre = costs.radian = -1.0;
  expect_ok(tactus_scenario_costs(shelf::scenario(), &costs));
  EXPECT_EQ(costs.metre, 1.0);
  EXPECT_EQ(costs.radian, -1.0);
}

TEST(Scenario, DrawsTheSamePoseForTheSameSeed) {
  EXPECT_EQ(shelf::pose(3), shelf::pose(3));
  EXPECT_NE(shelf::pose(3), shelf::pose(4));
  const std::vector<double> p = shelf::pose(3);
  EXPECT_NEAR(p[3] * p[3] + p[4] * p[4] + p[5] * p[5] + p[6] * p[6], 1.0, 1e-12);
}

TEST(Scenario, RollPitchYawTurnAboutFixedAxes) {
  const double xyzrpy[6] = {1, 2, 3, 0, 0, M_PI / 2};
  double pose[7];
  expect_ok(tactus_pose_from_rpy(xyzrpy, pose));
  const double expected[7] = {1, 2, 3, 0, 0, std::sqrt(0.5), std::sqrt(0.5)};
  for (int i = 0; i < 7; ++i) EXPECT_NEAR(pose[i], expected[i], 1e-12);
  const double broken[6] = {0, 0, 0, 0, shelf::nan, 0};
  expect_refused(tactus_pose_from_rpy(broken, pose), TACTUS_INVALID_ARGUMENT, "xyzrpy[4]");
}

TEST(Scenario, BodiesCanBeDrawn) {
  const tactus_scenario* scenario = shelf::scenario();
  std::size_t bodies = 0, vertices = 0, triangles = 0, count = 0;
  expect_ok(tactus_scenario_body_count(scenario, &bodies));
  std::vector<int> of_kind(5, 0);
  for (std::size_t b = 0; b < bodies; ++b) {
    tactus_body_kind kind = 0;
    expect_ok(tactus_scenario_body_kind(scenario, b, &kind));
    ++of_kind.at(static_cast<std::size_t>(kind));
    expect_ok(tactus_scenario_body_vertices(scenario, b, nullptr, 0, &vertices));
    expect_ok(tactus_scenario_body_triangles(scenario, b, nullptr, 0, &triangles));
    std::vector<std::int32_t> corners(3 * triangles);
    expect_ok(tactus_scenario_body_triangles(scenario, b, corners.data(), triangles, &count));
    for (const std::int32_t corner : corners) EXPECT_LT(static_cast<std::size_t>(corner), vertices);
  }
  EXPECT_GE(of_kind[TACTUS_BODY_ROBOT], 6);
  EXPECT_EQ(of_kind[TACTUS_BODY_TOOL], 1);
  EXPECT_EQ(of_kind[TACTUS_BODY_WORLD], 1);
  EXPECT_EQ(of_kind[TACTUS_BODY_TARGET], 1);
  std::vector<double> poses(7 * bodies);
  const std::vector<double> target = shelf::pose(1);
  expect_ok(tactus_scenario_body_poses(scenario, shelf::start().data(), target.data(), poses.data(), bodies, &count));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(poses[7 * (bodies - 1) + i], target[i], 1e-12);
  double turned_to_nothing[7] = {0, 0, 0, 0, 0, 0, 0};
  expect_refused(tactus_scenario_body_poses(scenario, shelf::start().data(), turned_to_nothing, nullptr, 0, &count),
                 TACTUS_INVALID_ARGUMENT, "target_pose");
}

TEST(Scenario, TablesAreKeptAndTakenInAgain) {
  const std::string wide = TACTUS_SOURCE_DIR "/examples/scenarios/shelf_3d.yaml";  // more cells than a list takes
  const shelf::Scenario first = shelf::load(wide), second = shelf::load(wide);
  const auto saved = [](const tactus_scenario* scenario) {
    std::size_t count = 0;
    expect_ok(tactus_scenario_save_tables(scenario, nullptr, 0, &count));
    std::vector<std::uint8_t> bytes(count);
    expect_ok(tactus_scenario_save_tables(scenario, bytes.data(), bytes.size(), &count));
    return bytes;
  };
  const std::vector<std::uint8_t> none = saved(first.get());
  const shelf::Belief belief = shelf::belief(first.get(), TACTUS_BELIEF_PARTICLES);
  const shelf::Action probe = shelf::query(shelf::planner(first.get(), 1, TACTUS_SOLVER_RATE), belief);
  std::vector<double> end = shelf::waypoints(probe.get());
  end.erase(end.begin(), end.end() - 6);
  const tactus_observation seen = shelf::observation(end);
  expect_ok(tactus_belief_step(belief.get(), probe.get(), &seen));
  std::vector<std::uint8_t> some = saved(first.get());
  EXPECT_GT(some.size(), none.size()) << "a probe has been worked out";
  expect_ok(tactus_scenario_restore_tables(second.get(), some.data(), some.size()));
  EXPECT_EQ(saved(second.get()), some);
  some[some.size() / 2] ^= 1;
  expect_refused(tactus_scenario_restore_tables(second.get(), some.data(), some.size()), TACTUS_BAD_SAVED_STATE,
                 "tables");
  expect_refused(tactus_scenario_restore_tables(second.get(), nullptr, 0), TACTUS_INVALID_ARGUMENT, "bytes");
  some[some.size() / 2] ^= 1;
  EXPECT_EQ(saved(second.get()), some) << "nothing has changed";
}

TEST(Scenario, AnEmptyPathIsNoFile) {
  tactus_scenario* made = reinterpret_cast<tactus_scenario*>(8);
  expect_refused(tactus_scenario_load("", &made), TACTUS_FILE_NOT_FOUND, "path: found an empty one");
  EXPECT_EQ(made, nullptr);
  std::size_t count = 0;
  char text[256];
  expect_ok(tactus_scenario_check("", text, sizeof text, &count));
  EXPECT_NE(std::string(text).find("path: found an empty one"), std::string::npos) << text;
}

TEST(Scenario, PathsInATextWithoutAFolderAreRelativeToTheProcess) {
  const std::string text = "robot: {urdf: nowhere.urdf}\n", here = std::filesystem::current_path() / "nowhere.urdf";
  tactus_scenario* made = nullptr;
  for (const char* folder : {"", "."})
    expect_refused(tactus_scenario_parse(text.c_str(), folder, &made), TACTUS_BAD_SCENARIO, here);
  EXPECT_EQ(made, nullptr);
}

TEST(Scenario, ALongWordIsCutBetweenCharacters) {
  std::string word = "x", cut = word;
  for (int i = 0; i < 60; ++i) word += "\xC3\xA4";
  for (int i = 0; i < 29; ++i) cut += "\xC3\xA4";  // to byte 59: the next character has bytes 60 and 61
  tactus_scenario* made = nullptr;
  expect_refused(tactus_scenario_parse(("planner: {solver: " + word + "}\n").c_str(), ".", &made), TACTUS_BAD_SCENARIO,
                 '"' + cut + "...\"");
  const std::string ascii(61, 'y');
  expect_refused(tactus_scenario_parse(("planner: {solver: " + ascii + "}\n").c_str(), ".", &made), TACTUS_BAD_SCENARIO,
                 '"' + ascii.substr(0, 60) + "...\"");
}

TEST(Scenario, BodiesOfARobotThatIsNowhereAreRefused) {
  std::size_t count = 0;
  std::vector<double> q = shelf::start();
  for (const double nowhere : {shelf::nan, shelf::infinity}) {
    q[2] = nowhere;
    expect_refused(tactus_scenario_body_poses(shelf::scenario(), q.data(), shelf::pose(1).data(), nullptr, 0, &count),
                   TACTUS_INVALID_ARGUMENT, "q[2] (elbow_joint)");
  }
}

}  // namespace
