// SPDX-License-Identifier: BSD-3-Clause
#include "scenario/scenario.hpp"

#include <gtest/gtest.h>

#include <fstream>

/// What a scenario's keys become.
namespace tactus::scenario {
namespace {

const std::filesystem::path folder = std::filesystem::path(TACTUS_SOURCE_DIR) / "tests/capi";

/// The small shelf and further keys.
std::shared_ptr<const Scenario> shelf_with(const std::string& keys) {
  std::ifstream stream(folder / "small_shelf.yaml");
  return parse(std::string(std::istreambuf_iterator<char>(stream), {}) + keys, folder);
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

}  // namespace
}  // namespace tactus::scenario
