// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>

#include "capi/shelf.hpp"

namespace {

using shelf::expect_ok;
using shelf::expect_refused;

tactus_action_properties properties(const tactus_action* action) {
  tactus_action_properties made{};
  expect_ok(tactus_action_properties_init(&made, sizeof made));
  expect_ok(tactus_action_info(action, &made));
  return made;
}

TEST(Action, KindsHaveNames) {
  EXPECT_STREQ(tactus_action_kind_name(TACTUS_ACTION_SWEEP), "sweep");
  EXPECT_STREQ(tactus_action_kind_name(99), "unknown");
}

TEST(Action, BeginsWhereTheRobotIs) {
  const std::vector<double> path = shelf::waypoints(shelf::first_action());
  EXPECT_EQ(std::vector<double>(path.begin(), path.begin() + 6), shelf::start());
}

TEST(Action, SaysWhatItIs) {
  const tactus_action_properties is = properties(shelf::first_action());
  EXPECT_EQ(is.waypoints, shelf::waypoints(shelf::first_action()).size() / 6);
  EXPECT_GT(is.length, 0.0);
  EXPECT_GT(is.full_cost, 0.0);
  EXPECT_GE(is.contact_probability, 0.0);
  EXPECT_LE(is.contact_probability, 1.0);
  std::vector<double> times(is.waypoints);
  std::size_t count = 0;
  expect_ok(tactus_action_times(shelf::first_action(), times.data(), times.size(), &count));
  EXPECT_EQ(count, is.waypoints);
  EXPECT_EQ(times.front(), 0.0);
  EXPECT_EQ(times.back(), is.duration);
}

TEST(Action, AStructOfANewerCallerIsFilledUpWithZeros) {
  struct {
    tactus_action_properties properties;
    std::uint64_t newer;
  } given;
  std::memset(&given, 0xff, sizeof given);
  given.properties.struct_size = sizeof given;
  expect_ok(tactus_action_info(shelf::first_action(), &given.properties));
  EXPECT_EQ(given.properties.struct_size, sizeof given);
  EXPECT_EQ(given.newer, 0u);
}

TEST(Action, AContactSendsTheRobotBackToAFreeWaypoint) {
  const std::vector<double> path = shelf::waypoints(shelf::first_action());
  const std::size_t last = path.size() / 6 - 1;
  std::vector<double> q(path.end() - 6, path.end());
  std::size_t waypoint = 0;
  tactus_observation seen = shelf::observation(q, true);
  expect_ok(tactus_action_retreat(shelf::first_action(), &seen, &waypoint));
  EXPECT_LT(waypoint, last);
  seen.contact = 0;
  expect_ok(tactus_action_retreat(shelf::first_action(), &seen, &waypoint));
  EXPECT_EQ(waypoint, last);
  q[0] += 0.5;
  expect_refused(tactus_action_retreat(shelf::first_action(), &seen, &waypoint), TACTUS_STOP_OFF_PATH, "joints");
  expect_refused(tactus_action_retreat(shelf::first_action(), nullptr, &waypoint), TACTUS_INVALID_ARGUMENT,
                 "observation");
}

TEST(Action, ComesBackAsItWasSaved) {
  std::size_t count = 0;
  expect_ok(tactus_action_save(shelf::first_action(), nullptr, 0, &count));
  std::vector<std::uint8_t> bytes(count);
  expect_ok(tactus_action_save(shelf::first_action(), bytes.data(), bytes.size(), &count));
  tactus_action* made = nullptr;
  expect_ok(tactus_action_restore(shelf::scenario(), bytes.data(), bytes.size(), &made));
  const shelf::Action restored(made);
  EXPECT_EQ(properties(restored.get()).id, properties(shelf::first_action()).id);
  EXPECT_EQ(shelf::waypoints(restored.get()), shelf::waypoints(shelf::first_action()));
  bytes.back() ^= 1;
  expect_refused(tactus_action_restore(shelf::scenario(), bytes.data(), bytes.size(), &made), TACTUS_BAD_SAVED_STATE,
                 "saved action");
  EXPECT_EQ(made, nullptr);
}

}  // namespace
