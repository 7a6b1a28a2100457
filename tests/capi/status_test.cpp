// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>
#include <thread>

#include "capi/shelf.hpp"

namespace {

TEST(Status, NamesEveryCodeAndNoOther) {
  EXPECT_STREQ(tactus_status_name(TACTUS_OK), "TACTUS_OK");
  EXPECT_STREQ(tactus_status_name(TACTUS_STOP_OFF_PATH), "TACTUS_STOP_OFF_PATH");
  EXPECT_STREQ(tactus_status_name(4711), "unknown status");
}

TEST(Status, TheVersionOfTheHeaderIsThatOfTheLibrary) {
  EXPECT_EQ(tactus_version(), 10000 * TACTUS_VERSION_MAJOR + 100 * TACTUS_VERSION_MINOR + TACTUS_VERSION_PATCH);
  EXPECT_EQ(std::string(tactus_version_string()), std::to_string(TACTUS_VERSION_MAJOR) + "." +
                                                      std::to_string(TACTUS_VERSION_MINOR) + "." +
                                                      std::to_string(TACTUS_VERSION_PATCH));
}

TEST(Status, TheLastErrorIsOfItsThread) {
  double pose[7];
  EXPECT_EQ(tactus_pose_from_rpy(nullptr, pose), TACTUS_INVALID_ARGUMENT);
  EXPECT_STREQ(tactus_last_error(), "tactus_pose_from_rpy: xyzrpy: found NULL, expected a pointer");
  std::string elsewhere = "?";
  std::thread([&] { elsewhere = tactus_last_error(); }).join();
  EXPECT_EQ(elsewhere, "");
}

TEST(Status, NullIsLegalForEveryDestroy) {
  tactus_scenario_destroy(nullptr);
  tactus_belief_destroy(nullptr);
  tactus_planner_destroy(nullptr);
  tactus_action_destroy(nullptr);
  tactus_world_destroy(nullptr);
}

TEST(Status, InitSetsTheSizeAndWritesNoMoreThanIt) {
  struct {
    tactus_planner_options options;
    unsigned char beyond[8];
  } given;
  std::memset(&given, 0xff, sizeof given);
  shelf::expect_ok(tactus_planner_options_init(&given.options, sizeof given.options));
  EXPECT_EQ(given.options.struct_size, sizeof given.options);
  EXPECT_EQ(given.options.solver, TACTUS_SOLVER_BRTDP_BEL);
  EXPECT_GT(given.options.budget_seconds, 0.0);
  for (const unsigned char byte : given.beyond) EXPECT_EQ(byte, 0xff);
}

TEST(Status, InitFillsAnOlderAndANewerStruct) {
  alignas(8) unsigned char bytes[sizeof(tactus_planner_options) + 16];
  auto* options = reinterpret_cast<tactus_planner_options*>(bytes);
  std::memset(bytes, 0xff, sizeof bytes);
  shelf::expect_ok(tactus_planner_options_init(options, 16));
  EXPECT_EQ(options->struct_size, 16u);
  EXPECT_EQ(options->budget_expansions, UINT64_MAX);  // not covered, so not written
  shelf::expect_ok(tactus_planner_options_init(options, sizeof bytes));
  EXPECT_EQ(options->struct_size, sizeof bytes);
  for (std::size_t i = sizeof *options; i < sizeof bytes; ++i) EXPECT_EQ(bytes[i], 0);
}

TEST(Status, InitRefusesSizesThatNobodyCanMean) {
  tactus_summary summary;
  shelf::expect_refused(tactus_summary_init(&summary, 0), TACTUS_STRUCT_SIZE, "size");
  shelf::expect_refused(tactus_summary_init(&summary, 1 << 20), TACTUS_STRUCT_SIZE, "size");
  shelf::expect_refused(tactus_summary_init(nullptr, sizeof summary), TACTUS_INVALID_ARGUMENT, "summary");
}

TEST(Status, TheLogGoesToTheCallbackUntilItIsTakenAway) {
  int lines = 0;
  const auto count = [](int32_t, const char*, void* context) { ++*static_cast<int*>(context); };
  shelf::expect_ok(tactus_set_log_callback(count, &lines));
  shelf::expect_ok(tactus_set_log_callback(nullptr, nullptr));
  EXPECT_EQ(lines, 0);
}

}  // namespace
