// SPDX-License-Identifier: BSD-3-Clause
#include "scenario/description.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include "support/error.hpp"

namespace tactus::scenario {
namespace {

namespace fs = std::filesystem;
using geometry::Vector3;
using support::Error;
using support::Status;

constexpr double pi = std::numbers::pi;

// 13 lines: what a test adds begins on line 14
const std::string smallest = R"(robot:
  urdf: robot.urdf
  tool_link: flange
  start: [0, -pi/2, pi]
tool:
  mesh: plug.stl
target:
  mesh: socket.stl
  seated: {xyz: [0, 0, 0.01]}
  approach_axis: [0, 0, -2]
  approach_depth: 0.02
prior:
  centre: {xyz: [0.7, 0, 0.4], rpy: [0, 0, pi/2]}
)";

const std::string every_section = R"(name: shelf
robot:
  urdf: robot.urdf
  srdf: robot.srdf
  packages: {parts: meshes}
  base: {xyz: [0, 0, 1], rpy: [0, 0, pi]}
  tool_link: flange
  start: [0, 2pi, 1.5pi]
tool:
  mesh: plug.stl
  scale: [0.001, 0.001, -0.001]
  pose: {rpy: [pi/2, 0, 0]}
world:
  - name: table
    box: [1, 2, 0.1]
    pose: {xyz: [0, 0, -0.05]}
  - name: shelf
    mesh: meshes/shelf.stl
    scale: 0.001
target:
  mesh: socket.stl
  scale: 2
  seated: {}
  approach_axis: [1, 0, 0]
  approach_depth: 0.02
  tolerance: {position: 0.001, angle: 0.1}
prior:
  centre: {}
  width: {x: 0.1, y: 0.2, z: 0.3, roll: 0.1, pitch: 0.2, yaw: 2pi}
belief:
  kind: particles
  delta: 1000
  cell: {position: 0.03, angle: 0.3}
contact:
  step: 0.002
sensing:
  stopping_distance: 0.002
  encoder_error: 0.0001
  missed_contacts: 0.02
  false_contacts: 0.5
motion:
  speed: 0.5
actions:
  primitive_lengths: [0.1]
  primitive_angles: []
cost:
  action: 0
planner:
  solver: frontier
  budget_expansions: 1e6
limits:
  actions: 10
)";

class ScenarioDescription : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "tactus_scenario_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
    fs::create_directory(folder_ / "meshes");
    for (const char* file : {"robot.urdf", "robot.srdf", "plug.stl", "socket.stl", "meshes/shelf.stl"})
      std::ofstream(folder_ / file) << "x";
  }
  void TearDown() override { fs::remove_all(folder_); }

  Description parse(const std::string& yaml) const { return parse_description(yaml, folder_, "shelf.yaml"); }

  std::string mistakes_in(const std::string& yaml) const {
    try {
      parse(yaml);
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), Status::bad_scenario);
      return error.what();
    }
    return "none";
  }

  /// `line` is the one mistake in `yaml`.
  void expect_mistake(const std::string& yaml, const std::string& line) const {
    EXPECT_EQ(mistakes_in(yaml), "shelf.yaml: 1 problem\nshelf.yaml:" + line);
  }

  fs::path folder_;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST_F(ScenarioDescription, HasDefaultsForAllButTheTask) {
  const Description d = parse(smallest);
  EXPECT_EQ(d.name, "shelf");
  EXPECT_EQ(d.robot.urdf, folder_ / "robot.urdf");
  EXPECT_TRUE(d.robot.srdf.empty());
  EXPECT_TRUE(d.robot.packages.empty());
  EXPECT_TRUE(d.robot.world_from_base.isApprox(geometry::Pose::Identity()));
  EXPECT_EQ(d.robot.start, (std::vector<double>{0.0, -pi / 2, pi}));
  EXPECT_EQ(d.tool.mesh.scale, Vector3::Ones());
  EXPECT_TRUE(d.world.empty());
  ASSERT_EQ(d.target.target_from_seated_tool.size(), 1u);
  EXPECT_EQ(d.target.target_from_seated_tool[0].translation(), Vector3(0, 0, 0.01));
  EXPECT_EQ(d.target.approach_axis, Vector3(0, 0, -1));
  EXPECT_EQ(d.target.tolerance.position, 0.003);
  EXPECT_EQ(d.target.tolerance.angle, 0.15);
  EXPECT_EQ(d.prior.centre, (geometry::PoseVector{0.7, 0, 0.4, 0, 0, pi / 2}));
  EXPECT_EQ(d.prior.width, geometry::PoseVector{});
  EXPECT_EQ(d.belief.kind, "hierarchical");
  EXPECT_EQ(d.belief.delta, 3000);
  EXPECT_EQ(d.contact.margin, 1e-5);
  EXPECT_EQ(d.sensing.stopping_distance, 0.0);
  EXPECT_EQ(d.sensing.encoder_error, 0.0);
  EXPECT_EQ(d.sensing.missed_contacts, 0.0);
  EXPECT_EQ(d.sensing.false_contacts, 0.0);
  EXPECT_EQ(d.actions.primitive_lengths, (std::vector<double>{0.02, 0.06, 0.18}));
  EXPECT_EQ(d.planner.solver, "brtdp-bel");
  EXPECT_EQ(d.planner.budget_expansions, 0u);
  EXPECT_EQ(d.limits.seconds, 600.0);
}

TEST_F(ScenarioDescription, TakesWhatIsStated) {
  const Description d = parse(every_section);
  EXPECT_EQ(d.robot.srdf, folder_ / "robot.srdf");
  EXPECT_EQ(d.robot.packages.at("parts"), folder_ / "meshes");
  EXPECT_TRUE(d.robot.world_from_base.isApprox(geometry::pose_from({0, 0, 1, 0, 0, pi})));
  EXPECT_EQ(d.robot.start, (std::vector<double>{0.0, 2 * pi, 1.5 * pi}));
  EXPECT_EQ(d.tool.mesh.scale, Vector3(0.001, 0.001, -0.001));
  ASSERT_EQ(d.world.size(), 2u);
  EXPECT_EQ(d.world[0].box.value(), Vector3(1, 2, 0.1));
  EXPECT_FALSE(d.world[0].mesh.has_value());
  EXPECT_EQ(d.world[1].mesh.value().file, folder_ / "meshes/shelf.stl");
  EXPECT_EQ(d.world[1].mesh.value().scale, Vector3::Constant(0.001));
  EXPECT_EQ(d.target.mesh.scale, Vector3::Constant(2));
  EXPECT_EQ(d.prior.width, (geometry::PoseVector{0.1, 0.2, 0.3, 0.1, 0.2, 2 * pi}));
  EXPECT_EQ(d.belief.kind, "particles");
  EXPECT_EQ(d.belief.cell.angle, 0.3);
  EXPECT_EQ(d.sensing.stopping_distance, 0.002);
  EXPECT_EQ(d.sensing.encoder_error, 0.0001);
  EXPECT_EQ(d.sensing.missed_contacts, 0.02);
  EXPECT_EQ(d.sensing.false_contacts, 0.5);
  EXPECT_TRUE(d.actions.primitive_angles.empty());
  EXPECT_EQ(d.cost.action, 0.0);
  EXPECT_EQ(d.cost.metre, 1.0);
  EXPECT_EQ(d.planner.budget_expansions, 1'000'000u);
  EXPECT_EQ(d.limits.actions, 10);
}

TEST_F(ScenarioDescription, ReportsEveryMistakeAtOnceInOrderOfLines) {
  const std::string text = mistakes_in(R"(name: [shelf]
robot:
  urfd: robot.urdf
  tool_link: flange
  start: [0, .nan, zero]
tool:
  mesh: missing.stl
  scale: 0
target:
  mesh: socket.stl
  seated: {xyz: [0, 0], yaw: 1}
  approach_axis: [0, 0, 0]
  approach_depth: -0.02
  approach_depth: 0.02
world:
  - {name: a, box: [1, 1, 0]}
  - {name: a}
belief:
  kind: particle
  delta: 2.5
planner: fast
)");
  EXPECT_EQ(text, "shelf.yaml: 19 problems\n" + std::string(R"(shelf.yaml:1: name: found a list of 1, expected text
shelf.yaml:1: prior: found nothing, expected a map
shelf.yaml:2: robot.urdf: found nothing, expected the path of a file
shelf.yaml:3: robot.urfd: found a key that isn't known, expected urdf, srdf, packages, base, tool_link or start (did you mean urdf?)
shelf.yaml:5: robot.start[1]: found ".nan", expected a number
shelf.yaml:5: robot.start[2]: found "zero", expected a number
)") + "shelf.yaml:7: tool.mesh: found " +
                      (folder_ / "missing.stl").string() +
                      R"(, which isn't there, expected the path of a file
shelf.yaml:8: tool.scale: found 0, expected numbers other than 0
shelf.yaml:11: target.seated.xyz: found a list of 2, expected a list of 3 numbers
shelf.yaml:11: target.seated.yaw: found a key that isn't known, expected xyz or rpy
shelf.yaml:12: target.approach_axis: found a direction of no length, expected one that isn't zero
shelf.yaml:13: target.approach_depth: found -0.02, expected a number greater than 0
shelf.yaml:14: target.approach_depth: found the key a second time, expected it once (it is on line 13)
shelf.yaml:16: world[0].box[2]: found 0, expected a number greater than 0
shelf.yaml:17: world[1]: found neither box nor mesh, expected one of them
shelf.yaml:17: world[1].name: found "a" a second time, expected a name of its own
shelf.yaml:19: belief.kind: found "particle", expected hierarchical or particles (did you mean particles?)
shelf.yaml:20: belief.delta: found 2.5, expected a whole number of at least 1
shelf.yaml:21: planner: found "fast", expected a map)");
}

TEST_F(ScenarioDescription, TakesSeveralSeats) {
  const auto seats = [&](const std::string& list) {
    return parse(replaced(smallest, "{xyz: [0, 0, 0.01]}", list)).target.target_from_seated_tool;
  };
  const std::vector<geometry::Pose> two = seats("[{xyz: [0, 0, 0.02]}, {rpy: [0, 0, pi]}]");
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[0].translation(), Vector3(0, 0, 0.02));
  EXPECT_TRUE(two[1].isApprox(geometry::pose_from({0, 0, 0, 0, 0, pi})));
  EXPECT_EQ(seats("[{}]").size(), 1u);

  const auto expect_wrong = [&](const std::string& list, const std::string& mistake) {
    expect_mistake(replaced(smallest, "{xyz: [0, 0, 0.01]}", list), "9: target.seated" + mistake);
  };
  expect_wrong("[]", ": found a list of 0, expected a map or a list of maps");
  expect_wrong("0.01", ": found 0.01, expected a map or a list of maps");
  expect_wrong("[{}, 1]", "[1]: found 1, expected a map");
  expect_wrong("[{}, {yaw: 1}]", "[1].yaw: found a key that isn't known, expected xyz or rpy");
}

TEST_F(ScenarioDescription, RefusesWrongTypes) {
  expect_mistake(smallest + "world: {}\n", "14: world: found a map, expected a list of maps");
  expect_mistake(smallest + "world: [table]\n", "14: world[0]: found \"table\", expected a map");
  expect_mistake(smallest + "cost:\n  metre: \"1\"\n", "15: cost.metre: found \"1\", expected a number of at least 0");
  expect_mistake(smallest + "limits:\n", "14: limits: found nothing, expected a map");
  expect_mistake(smallest + "contact:\n  stop_tolerance: 0\n",
                 "15: contact.stop_tolerance: found 0, expected a number greater than 0");
  expect_mistake(smallest + "actions:\n  probe_depth: 0.1\n",
                 "15: actions.probe_depth: found 0.1, expected a list of numbers");
  expect_mistake(smallest + "[1, 2]: 3\n", "14: found a list of 2 as a key, expected a word");
}

TEST_F(ScenarioDescription, RefusesNumbersOutOfRange) {
  expect_mistake(smallest + "planner: {epsilon: 1.5}\n",
                 "14: planner.epsilon: found 1.5, expected a number from 0 to 1");
  expect_mistake(smallest + "planner: {horizon: 0}\n",
                 "14: planner.horizon: found 0, expected a whole number of at least 1");
  expect_mistake(smallest + "planner: {horizon: 3e9}\n",
                 "14: planner.horizon: found 3e9, expected a whole number from 1 to 2147483647");
  expect_mistake(smallest + "planner: {budget_expansions: -1}\n",
                 "14: planner.budget_expansions: found -1, expected a whole number of at least 0");
  expect_mistake(smallest + "sensing:\n  stopping_distance: -0.001\n",
                 "15: sensing.stopping_distance: found -0.001, expected a number of at least 0");
  expect_mistake(smallest + "sensing: {encoder_error: -1}\n",
                 "14: sensing.encoder_error: found -1, expected a number of at least 0");
  for (const std::string rate : {"missed_contacts", "false_contacts"})
    for (const std::string bad : {"-0.01", "0.51"})
      expect_mistake(smallest + "sensing: {" + rate + ": " + bad + "}\n",
                     "14: sensing." + rate + ": found " + bad + ", expected a number from 0 to 0.5");
  expect_mistake(smallest + "  width: {yaw: 3pi}\n",
                 "14: prior.width.yaw: found 3pi, expected a number from 0 to 6.283185307179586");
}

TEST_F(ScenarioDescription, RefusesNumbersThatAreNotFinite) {
  for (const std::string word :
       {".nan", ".inf", "-.inf", "nan", "inf", "1e999", "pi/0", "--1", "pie", "1.2.3", "0x10", "2 pi"})
    EXPECT_NE(mistakes_in(smallest + "cost: {metre: " + word + "}\n").find("shelf.yaml:14: cost.metre: found"),
              std::string::npos)
        << word;
}

TEST_F(ScenarioDescription, ReadsMultiplesOfPi) {
  for (const auto& [word, value] : std::vector<std::pair<std::string, double>>{{"pi", pi},
                                                                               {"2pi", 2 * pi},
                                                                               {"pi/2", pi / 2},
                                                                               {"-pi/4", -pi / 4},
                                                                               {"1.5pi", 1.5 * pi},
                                                                               {"+3pi/4", 0.75 * pi}})
    EXPECT_DOUBLE_EQ(parse(replaced(smallest, "[0, -pi/2, pi]", '[' + word + ']')).robot.start.at(0), value) << word;
}

const std::string flat = smallest + "  width: {x: 0.1, y: 0.2, yaw: 0.5}\n";

TEST_F(ScenarioDescription, TakesANormalPrior) {
  const PriorDescription sure = parse(flat +
                                      "  normal:\n    mean: {xyz: [0.71, 0.02, 9], rpy: [0, 0, pi/2]}\n"
                                      "    deviation: {x: 0.01, y: 0.02, z: 0, yaw: 0.1}\n  floor: 0.05\n")
                                    .prior;
  ASSERT_EQ(sure.guesses.size(), 1u);
  EXPECT_EQ(sure.guesses[0].mean, (geometry::PoseVector{0.71, 0.02, 9, 0, 0, pi / 2}));
  EXPECT_DOUBLE_EQ(sure.guesses[0].covariance(0, 0), 1e-4);
  EXPECT_DOUBLE_EQ(sure.guesses[0].covariance(1, 1), 4e-4);
  EXPECT_DOUBLE_EQ(sure.guesses[0].covariance(5, 5), 0.01);
  EXPECT_EQ(sure.floor, 0.05);

  const PriorDescription full = parse(flat + R"(  normal:
    mean: {xyz: [0.7, 0, 0.4], rpy: [0, 0, 2.5pi]}
    covariance: [1e-4, 5e-5, 0, 0, 0, 1e-3,
                 5e-5, 1e-4, 0, 0, 0, 0,
                 0, 0, 0, 0, 0, 0,
                 0, 0, 0, 0, 0, 0,
                 0, 0, 0, 0, 0, 0,
                 1e-3, 0, 0, 0, 0, 0.04]
)")
                                    .prior;
  ASSERT_EQ(full.guesses.size(), 1u);
  EXPECT_EQ(full.guesses[0].covariance(0, 1), 5e-5);
  EXPECT_EQ(full.guesses[0].covariance(5, 0), 1e-3);
  EXPECT_EQ(full.guesses[0].covariance(5, 5), 0.04);
  EXPECT_EQ(full.floor, 0.01);
}

TEST_F(ScenarioDescription, TakesWeightedPosesAsAPrior) {
  const PriorDescription prior = parse(flat + R"(  poses:
    - {xyz: [0.7, 0, 0.4], rpy: [0, 0, pi/2], weight: 0.7}
    - {xyz: [0.72, 0, 0.4], rpy: [0, 0, 1.6]}
  spread: {angle: 0.2}
)")
                                     .prior;
  ASSERT_EQ(prior.guesses.size(), 2u);
  EXPECT_EQ(prior.guesses[0].weight, 0.7);
  EXPECT_EQ(prior.guesses[1].weight, 1.0);
  EXPECT_EQ(prior.guesses[1].mean, (geometry::PoseVector{0.72, 0, 0.4, 0, 0, 1.6}));
  for (const GuessDescription& guess : prior.guesses)
    for (int d = 0; d < 6; ++d) EXPECT_DOUBLE_EQ(guess.covariance(d, d), d < 3 ? 4e-4 : 0.04);
}

TEST_F(ScenarioDescription, RefusesPriorsThatSayWhereTwiceOrNowhere) {
  const std::string normal =
      "  normal: {mean: {xyz: [0.7, 0, 0], rpy: [0, 0, 1.5]}, deviation: {x: 1, y: 1, yaw: 1}}\n";
  const std::string poses = "  poses: [{xyz: [0.7, 0, 0], rpy: [0, 0, 1.5]}]\n";
  EXPECT_EQ(mistakes_in(flat + normal), "none");
  EXPECT_EQ(mistakes_in(flat + poses), "none");
  expect_mistake(flat + normal + poses, "12: prior: found both normal and poses, expected one of them");
  expect_mistake(flat + "  poses: []\n", "15: prior.poses: found none, expected at least one");
  expect_mistake(flat + normal + "  spread: {angle: 1}\n",
                 "16: prior.spread: found a spread without poses, expected it beside poses only");
  expect_mistake(flat + "  floor: 0.1\n",
                 "15: prior.floor: found a floor without normal or poses, expected it beside one of them only");
  for (const std::string bad : {"0", "1.1"})
    expect_mistake(flat + poses + "  floor: " + bad + "\n",
                   "16: prior.floor: found " + bad + ", expected a number from 0.001 to 1");
  expect_mistake(flat + poses + "  spread: {angle: 1e200}\n",
                 "16: prior.spread.angle: found 1e200, expected a number from 1e-06 to 1000");
  expect_mistake(flat + "  poses:\n    - {xyz: [0.76, 0, 0.4], rpy: [0, 0, 1.5]}\n",
                 "16: prior.poses[0]: found a pose outside the prior's widths, expected one within them");
  expect_mistake(flat + "  poses:\n    - {xyz: [0.7, 0, 0], rpy: [0, 0, 1.5], weight: 0}\n",
                 "16: prior.poses[0].weight: found 0, expected a number greater than 0");
}

TEST_F(ScenarioDescription, RefusesNormalPriorsThatAreNone) {
  const std::string mean = flat + "  normal:\n    mean: {xyz: [0.7, 0, 0.4], rpy: [0, 0, pi/2]}\n";
  const auto matrix = [](double xx, double xy, double yx, double yaw) {
    std::ostringstream text;
    text << "    covariance: [" << xx << ',' << xy << ",0,0,0,0, " << yx << ",1,0,0,0,0, "
         << "0,0,0,0,0,0, 0,0,0,0,0,0, "
         << "0,0,0,0,0,0, 0,0,0,0,0," << yaw << "]\n";
    return text.str();
  };
  const std::string deviation = "    deviation: {x: 1, y: 1, yaw: 1}\n";
  EXPECT_EQ(mistakes_in(mean + matrix(1, 0.5, 0.5, 1)), "none");
  expect_mistake(mean + matrix(1, 0.5, 0.4, 1),
                 "17: prior.normal.covariance: found a matrix that isn't symmetric, expected a symmetric one");
  for (const std::string& bad : {matrix(1, 1.1, 1.1, 1), matrix(1, 1, 1, 1), matrix(-1, 0, 0, 1), matrix(1, 0, 0, 0),
                                 matrix(1e-14, 0, 0, 1), matrix(1, 0, 0, 1e300)})
    expect_mistake(mean + bad,
                   "17: prior.normal.covariance: found a matrix that isn't positive definite in the "
                   "dimensions of some width, expected one that is, with variances from 1e-12 to 1e6");
  for (const auto& [list, count] : {std::pair{"[]", "0"}, {"[1, 2]", "2"}})
    expect_mistake(mean + "    covariance: " + list + "\n",
                   std::string("17: prior.normal.covariance: found a list of ") + count +
                       ", expected a list of 36 numbers, row by row");
  expect_mistake(mean + "    deviation: {x: 1, yaw: 1}\n",
                 "17: prior.normal.deviation.y: found nothing, expected a number from 1e-06 to 1000");
  expect_mistake(mean + "    deviation: {x: 1, y: 0, yaw: 1}\n",
                 "17: prior.normal.deviation.y: found 0, expected a number from 1e-06 to 1000");
  expect_mistake(mean, "15: prior.normal: found neither covariance nor deviation, expected one of them");
  expect_mistake(mean + deviation + matrix(1, 0, 0, 1),
                 "15: prior.normal: found both covariance and deviation, expected one of them");
  expect_mistake(flat + "  normal:\n" + deviation, "15: prior.normal.mean: found nothing, expected a map");
  expect_mistake(flat + "  normal:\n    mean: {xyz: [0.7, 0, 0.4]}\n" + deviation,
                 "16: prior.normal.mean: found a pose outside the prior's widths, expected one within them");
}

TEST_F(ScenarioDescription, RefusesObjectsOfNoOrTwoShapes) {
  expect_mistake(smallest + "world:\n  - {name: a, box: [1, 1, 1], mesh: plug.stl}\n",
                 "15: world[0]: found both box and mesh, expected one of them");
  expect_mistake(smallest + "world:\n  - {name: a, box: [1, 1, 1], scale: 2}\n",
                 "15: world[0].scale: found a scale without a mesh, expected it beside a mesh only");
}

TEST_F(ScenarioDescription, RefusesAFolderInPlaceOfAFile) {
  const std::string meshes = (folder_ / "meshes").string();
  expect_mistake(replaced(smallest, "plug.stl", "meshes"),
                 "6: tool.mesh: found " + meshes + ", which is something else, expected the path of a file");
  expect_mistake(replaced(smallest, "robot.urdf", "robot.urdf\n  packages: {parts: plug.stl}"),
                 "3: robot.packages.parts: found " + (folder_ / "plug.stl").string() +
                     ", which is something else, expected the path of a folder");
}

TEST_F(ScenarioDescription, RefusesWhatIsNotOneMap) {
  for (const char* yaml : {"", "# only a comment\n", "just text", "[1, 2]", "~"})
    EXPECT_NE(mistakes_in(yaml).find("shelf.yaml:1: found no map"), std::string::npos) << yaml;
  EXPECT_NE(mistakes_in(smallest + "---\nname: two\n").find("several documents"), std::string::npos);
  EXPECT_NE(mistakes_in("robot:\n  urdf: [1, 2\n").find("what isn't YAML"), std::string::npos);
  EXPECT_NE(mistakes_in("robot:\n\turdf: x\n").find("shelf.yaml:2"), std::string::npos);
  EXPECT_NE(mistakes_in(std::string(100'000, '[')).find("shelf.yaml:1"), std::string::npos);
  EXPECT_NE(mistakes_in("robot: &a\n  urdf: *a\n").find("robot.urdf"), std::string::npos);
}

TEST_F(ScenarioDescription, IsReadFromAFileBesideItsMeshes) {
  std::ofstream(folder_ / "shelf.yaml") << smallest;
  EXPECT_EQ(read_description(folder_ / "shelf.yaml").tool.mesh.file, folder_ / "plug.stl");
  try {
    read_description(folder_ / "absent.yaml");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::file_not_found);
    EXPECT_NE(std::string(error.what()).find((folder_ / "absent.yaml").string()), std::string::npos);
  }
  EXPECT_THROW(read_description(folder_), Error);
}

std::string documentation() {
  std::ifstream stream(fs::path(TACTUS_SOURCE_DIR) / "examples/scenarios/README.md");
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST_F(ScenarioDescription, DocumentationBeginsWithAScenarioThatParses) {
  const std::string page = documentation();
  const std::size_t from = page.find("```yaml\n") + 8;
  EXPECT_EQ(parse(page.substr(from, page.find("```", from) - from)).robot.start.size(), 6u);
}

/// The parser itself names its keys: put an unknown one everywhere and read what it expected instead.
TEST_F(ScenarioDescription, DocumentationHasEveryKey) {
  const std::string page = documentation();
  std::string yaml = "unknown: 1\nworld: [{unknown: 1}]\ntarget: {unknown: 1, tolerance: {unknown: 1}}\n";
  yaml += "prior: {unknown: 1, width: {unknown: 1}, normal: {unknown: 1, deviation: {unknown: 1}}, ";
  yaml += "poses: [{unknown: 1}], spread: {unknown: 1}}\nbelief: {unknown: 1, cell: {unknown: 1}}\n";
  for (const char* section : {"robot", "tool", "contact", "sensing", "motion", "actions", "cost", "planner", "limits"})
    yaml += std::string(section) + ": {unknown: 1}\n";

  int keys = 0;
  std::istringstream lines(mistakes_in(yaml));
  for (std::string line; std::getline(lines, line);) {
    const std::string marker = ": found a key that isn't known, expected ";
    const std::size_t at = line.find(marker);
    if (at == std::string::npos) continue;
    std::string section = line.substr(line.find(": ") + 2, at - line.find(": ") - 2);
    section = replaced(replaced(section, "unknown", "") + "[0]", "[0]", "[]");
    section = section.substr(0, section.find_last_of('.') + 1);
    std::string words = replaced(line.substr(at + marker.size()), " or ", ", ");
    for (std::size_t from = 0, to = 0; from < words.size(); from = to + 2, ++keys) {
      to = std::min(words.find(", ", from), words.size());
      const std::string key = section + words.substr(from, to - from);
      EXPECT_TRUE(page.find('`' + key + '`') != std::string::npos || page.find('`' + key + '.') != std::string::npos)
          << key;
    }
  }
  EXPECT_GT(keys, 94);
}

}  // namespace
}  // namespace tactus::scenario
