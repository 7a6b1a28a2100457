// SPDX-License-Identifier: BSD-3-Clause
#include "capi/shelf.hpp"

namespace {

using shelf::expect_ok;
using shelf::expect_refused;

/// What a robot reports of the first action.
std::vector<double> first_seen(const tactus_world_options* options) {
  tactus_world* made = nullptr;
  expect_ok(tactus_world_create(shelf::scenario(), shelf::pose(1).data(), options, &made));
  const shelf::World world(made);
  std::vector<double> q(6);
  tactus_observation seen = shelf::observation(q);
  expect_ok(tactus_world_execute(world.get(), shelf::first_action(), &seen));
  q.push_back(seen.contact);
  return q;
}

TEST(World, RefusesPosesThatTheTargetCannotHave) {
  tactus_world* made = reinterpret_cast<tactus_world*>(8);
  std::vector<double> pose = shelf::pose(1);
  pose[1] += 10.0;
  expect_refused(tactus_world_create(shelf::scenario(), pose.data(), nullptr, &made), TACTUS_INVALID_ARGUMENT,
                 "true_pose");
  EXPECT_EQ(made, nullptr);
  pose[1] = shelf::nan;
  expect_refused(tactus_world_create(shelf::scenario(), pose.data(), nullptr, &made), TACTUS_INVALID_ARGUMENT,
                 "true_pose[1]");
  expect_refused(tactus_world_create(shelf::scenario(), nullptr, nullptr, &made), TACTUS_INVALID_ARGUMENT, "true_pose");
}

TEST(World, RefusesOptionsOutOfRange) {
  tactus_world_options options{};
  expect_ok(tactus_world_options_init(&options, sizeof options));
  EXPECT_EQ(options.fineness, 10);
  options.fineness = 0;
  tactus_world* made = nullptr;
  expect_refused(tactus_world_create(shelf::scenario(), shelf::pose(1).data(), &options, &made),
                 TACTUS_INVALID_ARGUMENT, "options.fineness");
}

TEST(World, IsAsTheScenarioSaysUnlessTold) {
  tactus_world_options options{};
  expect_ok(tactus_world_options_init(&options, sizeof options));
  for (const double value :
       {options.stopping_distance, options.encoder_error, options.missed_contacts, options.false_contacts})
    EXPECT_LT(value, 0.0);
  options.stopping_distance = 0.003, options.encoder_error = 0.0001;
  options.missed_contacts = options.false_contacts = 0.5;
  EXPECT_NE(first_seen(&options), first_seen(nullptr));
  EXPECT_EQ(first_seen(&options), first_seen(&options));
  const std::vector<double> before = first_seen(&options);
  options.seed += 1;
  EXPECT_NE(first_seen(&options), before);
}

TEST(World, TakesOptionsOfTheFirstVersion) {
  tactus_world_options options{};
  expect_ok(tactus_world_options_init(&options, 8));
  EXPECT_EQ(first_seen(&options), first_seen(nullptr));
}

TEST(World, RefusesSensingOutOfRange) {
  tactus_world_options options{};
  expect_ok(tactus_world_options_init(&options, sizeof options));
  options.missed_contacts = 0.6;
  tactus_world* made = nullptr;
  expect_refused(tactus_world_create(shelf::scenario(), shelf::pose(1).data(), &options, &made),
                 TACTUS_INVALID_ARGUMENT, "missed_contacts");
  options.missed_contacts = -1.0, options.encoder_error = shelf::nan;
  expect_refused(tactus_world_create(shelf::scenario(), shelf::pose(1).data(), &options, &made),
                 TACTUS_INVALID_ARGUMENT, "encoder_error");
}

TEST(World, KeepsTheTruth) {
  double pose[7];
  expect_ok(tactus_world_true_pose(shelf::world(4).get(), pose));
  const std::vector<double> drawn = shelf::pose(4);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(pose[i], drawn[i], 1e-12);
}

TEST(World, ExecutesUpToTheFirstContactAndReportsWhere) {
  const shelf::World world = shelf::world();
  const shelf::Belief belief = shelf::belief();
  std::vector<double> q(6);
  tactus_observation seen = shelf::observation(q);
  expect_ok(tactus_world_execute(world.get(), shelf::first_action(), &seen));
  std::size_t waypoint = 0;
  expect_ok(tactus_action_retreat(shelf::first_action(), &seen, &waypoint));  // the stop lies on the path
  expect_ok(tactus_belief_step(belief.get(), shelf::first_action(), &seen));
  int32_t contained = 0, inserted = 1;
  expect_ok(tactus_belief_contains(belief.get(), shelf::pose(1).data(), &contained));
  EXPECT_EQ(contained, 1);
  expect_ok(tactus_world_inserted(world.get(), &inserted));
  EXPECT_EQ(inserted, 0);
  double metres = 0, radians = -1;
  expect_ok(tactus_world_travelled(world.get(), &metres, &radians));
  EXPECT_GT(metres, 0.0);
  EXPECT_GE(radians, 0.0);
}

TEST(World, NothingMovesIfTheObservationHasNoRoom) {
  const shelf::World world = shelf::world();
  std::vector<double> q(6, 9.0);
  tactus_observation seen = shelf::observation(q);
  seen.joint_count = 5;
  expect_refused(tactus_world_execute(world.get(), shelf::first_action(), &seen), TACTUS_BUFFER_TOO_SMALL,
                 "joint_count");
  seen.joint_count = 6;
  seen.joints = nullptr;
  expect_refused(tactus_world_execute(world.get(), shelf::first_action(), &seen), TACTUS_INVALID_ARGUMENT, "joints");
  double metres = 1, radians = 1;
  expect_ok(tactus_world_travelled(world.get(), &metres, &radians));
  EXPECT_EQ(metres, 0.0);
  EXPECT_EQ(q[0], 9.0);
}

TEST(World, AnActionMustBeginWhereTheRobotIs) {
  const shelf::World world = shelf::world();
  std::vector<double> q(6);
  tactus_observation seen = shelf::observation(q);
  expect_ok(tactus_world_execute(world.get(), shelf::first_action(), &seen));
  expect_refused(tactus_world_execute(world.get(), shelf::first_action(), &seen), TACTUS_INVALID_ARGUMENT, "action");
}

}  // namespace
