// SPDX-License-Identifier: BSD-3-Clause
#include "scenario/scenario.hpp"

#include <gtest/gtest.h>

#include <fstream>

/// What a scenario's keys become.
namespace tactus::scenario {
namespace {

const std::filesystem::path folder = std::filesystem::path(TACTUS_SOURCE_DIR) / "tests/capi";

/// The small shelf and further keys, at the end and in the prior.
std::shared_ptr<const Scenario> shelf_with(const std::string& keys, const std::string& of_prior = "") {
  std::ifstream stream(folder / "small_shelf.yaml");
  std::string yaml(std::istreambuf_iterator<char>(stream), {});
  const std::string width = "  width: {y: 0.04, z: 0.04, roll: 0.3}\n";
  yaml.insert(yaml.find(width) + width.size(), of_prior);
  return parse(yaml + keys, folder);
}

TEST(Scenario, TellsTheTaskWhatTheRobotFeels) {
  const action::Sensing none = shelf_with("")->task->options().sensing;
  EXPECT_EQ(none.stopping_distance, 0.0);
  EXPECT_EQ(none.encoder_error, 0.0);
  EXPECT_EQ(none.missed_contacts, 0.0);
  EXPECT_EQ(none.false_contacts, 0.0);
  const auto scenario = shelf_with(
      "sensing: {stopping_distance: 0.002, encoder_error: 0.0001, missed_contacts: 0.02, false_contacts: 0.03}\n");
  const action::Sensing& sensing = scenario->task->options().sensing;
  EXPECT_EQ(sensing.stopping_distance, 0.002);
  EXPECT_EQ(sensing.encoder_error, 0.0001);
  EXPECT_EQ(sensing.missed_contacts, 0.02);
  EXPECT_EQ(sensing.false_contacts, 0.03);
}

TEST(Scenario, SharesTheProbabilityAmongThePriorsGuesses) {
  EXPECT_TRUE(shelf_with("")->task->scene().prior.guesses.empty());
  const auto scenario =
      shelf_with("", R"(  poses: [{xyz: [1, 0.055, 0.55], weight: 3}, {xyz: [1, 0.045, 0.56], rpy: [0.1, 0, 0]}]
  spread: {position: 0.003, angle: 0.05}
  floor: 0.2
)");
  const std::vector<scene::Guess>& guesses = scenario->task->scene().prior.guesses;
  ASSERT_EQ(guesses.size(), 2u);
  EXPECT_DOUBLE_EQ(guesses[0].share, 0.6);
  EXPECT_DOUBLE_EQ(guesses[1].share, 0.2);
  EXPECT_EQ(guesses[1].normal.mean(), (geometry::PoseVector{1, 0.045, 0.56, 0.1, 0, 0}));
  EXPECT_DOUBLE_EQ(guesses[0].normal.covariance()(1, 1), 9e-6);
  EXPECT_DOUBLE_EQ(guesses[0].normal.covariance()(3, 3), 25e-4);
}

}  // namespace
}  // namespace tactus::scenario
