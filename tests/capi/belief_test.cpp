// SPDX-License-Identifier: BSD-3-Clause
#include <atomic>
#include <cstring>
#include <numeric>
#include <thread>

#include "capi/shelf.hpp"

namespace {

using shelf::expect_ok;
using shelf::expect_refused;

tactus_summary summary(const shelf::Belief& belief) {
  tactus_summary made{};
  expect_ok(tactus_summary_init(&made, sizeof made));
  expect_ok(tactus_belief_summary(belief.get(), &made));
  return made;
}

TEST(Belief, BeginsWithThePriorAndTheStart) {
  const shelf::Belief belief = shelf::belief();
  const tactus_summary known = summary(belief);
  EXPECT_EQ(known.phase, TACTUS_PHASE_VOXELS);
  EXPECT_EQ(known.health, TACTUS_HEALTH_GOOD);
  EXPECT_EQ(known.observations, 0u);
  EXPECT_GT(known.possibly_occupied, 0u);
  EXPECT_NEAR(known.mean[0], 1.004, 1e-12);
  std::size_t voxels = 0, poses = 1;
  expect_ok(tactus_belief_voxels(belief.get(), nullptr, 0, &voxels));
  expect_ok(tactus_belief_poses(belief.get(), nullptr, 0, &poses));
  EXPECT_EQ(voxels, known.possibly_occupied);
  EXPECT_EQ(poses, 0u);
  std::vector<double> q(6);
  expect_ok(tactus_belief_configuration(belief.get(), q.data(), 6, &voxels));
  EXPECT_EQ(q, shelf::start());
}

TEST(Belief, OfParticlesBeginsWithCells) {
  const shelf::Belief belief = shelf::belief(shelf::scenario(), TACTUS_BELIEF_PARTICLES);
  const tactus_summary known = summary(belief);
  EXPECT_EQ(known.phase, TACTUS_PHASE_POSES);
  std::size_t poses = 0;
  expect_ok(tactus_belief_poses(belief.get(), nullptr, 0, &poses));
  EXPECT_EQ(poses, known.cells);
}

TEST(Belief, CreateRefusesWhatMakesNoSense) {
  tactus_belief* made = reinterpret_cast<tactus_belief*>(8);
  std::vector<double> q = shelf::start();
  expect_refused(tactus_belief_create(nullptr, nullptr, q.data(), &made), TACTUS_INVALID_ARGUMENT, "scenario");
  EXPECT_EQ(made, nullptr);
  expect_refused(tactus_belief_create(shelf::scenario(), nullptr, nullptr, &made), TACTUS_INVALID_ARGUMENT, "q");
  q[2] = shelf::nan;
  expect_refused(tactus_belief_create(shelf::scenario(), nullptr, q.data(), &made), TACTUS_INVALID_ARGUMENT, "q[2]");
  q[2] = 100.0;  // outside the joint's limits
  expect_refused(tactus_belief_create(shelf::scenario(), nullptr, q.data(), &made), TACTUS_START_IN_COLLISION, "q");
  const tactus_belief_options unknown{sizeof unknown, 7};
  expect_refused(tactus_belief_create(shelf::scenario(), &unknown, shelf::start().data(), &made),
                 TACTUS_INVALID_ARGUMENT, "options.kind");
  EXPECT_EQ(made, nullptr);
}

TEST(Belief, OptionsThatThisVersionDoesNotKnowAreRefusedUnlessZero) {
  struct {
    tactus_belief_options options;
    std::uint64_t newer;
  } given = {{sizeof given, TACTUS_BELIEF_PARTICLES}, 0};
  tactus_belief* made = nullptr;
  expect_ok(tactus_belief_create(shelf::scenario(), &given.options, shelf::start().data(), &made));
  tactus_belief_destroy(made);
  given.newer = 1;
  expect_refused(tactus_belief_create(shelf::scenario(), &given.options, shelf::start().data(), &made),
                 TACTUS_STRUCT_SIZE, "options");
  given.options.struct_size = 0;
  expect_refused(tactus_belief_create(shelf::scenario(), &given.options, shelf::start().data(), &made),
                 TACTUS_STRUCT_SIZE, "_init");
  EXPECT_EQ(made, nullptr);
}

TEST(Belief, ContainsWhatThePriorDoes) {
  const shelf::Belief belief = shelf::belief();
  int32_t contained = 0;
  std::vector<double> pose = shelf::pose(5);
  expect_ok(tactus_belief_contains(belief.get(), pose.data(), &contained));
  EXPECT_EQ(contained, 1);
  pose[0] += 0.01;
  expect_ok(tactus_belief_contains(belief.get(), pose.data(), &contained));
  EXPECT_EQ(contained, 0);
  pose[6] = shelf::nan;
  expect_refused(tactus_belief_contains(belief.get(), pose.data(), &contained), TACTUS_INVALID_ARGUMENT, "pose[6]");
}

TEST(Belief, AfterAnErrorEverythingIsAsItWas) {
  const shelf::Belief belief = shelf::belief();
  const auto before = shelf::saved(belief.get());
  std::vector<double> q = shelf::start();
  const auto refused = [&](tactus_observation seen, tactus_status status, const char* word) {
    expect_refused(tactus_belief_step(belief.get(), shelf::first_action(), &seen), status, word);
    EXPECT_EQ(shelf::saved(belief.get()), before);
  };
  q[4] = shelf::nan;
  refused(shelf::observation(q), TACTUS_INVALID_ARGUMENT, "joints[4]");
  expect_refused(tactus_belief_set_configuration(belief.get(), q.data()), TACTUS_INVALID_ARGUMENT, "q[4]");
  q[4] = 3.0;
  refused(shelf::observation(q), TACTUS_STOP_OFF_PATH, "joints");
  q.pop_back();
  refused(shelf::observation(q), TACTUS_INVALID_ARGUMENT, "joint_count");
  q = shelf::start();
  tactus_observation seen = shelf::observation(q);
  seen.contact = 2;
  refused(seen, TACTUS_INVALID_ARGUMENT, "contact");
  seen = shelf::observation(q);
  seen.joints = nullptr;
  refused(seen, TACTUS_INVALID_ARGUMENT, "observation.joints");
  seen = shelf::observation(q);
  seen.struct_size = 4;
  refused(seen, TACTUS_STRUCT_SIZE, "observation");
  expect_refused(tactus_belief_step(belief.get(), nullptr, &seen), TACTUS_INVALID_ARGUMENT, "action");
}

TEST(Belief, TellsItsHistoryAndItsModes) {
  const shelf::Belief belief = shelf::belief(shelf::scenario(), TACTUS_BELIEF_PARTICLES);
  std::size_t count = 7;
  expect_ok(tactus_belief_history(belief.get(), nullptr, 0, &count));
  EXPECT_EQ(count, 0u);
  const std::vector<double> path = shelf::waypoints(shelf::first_action());
  std::vector<double> q(path.begin() + 6, path.begin() + 12);
  const tactus_observation seen = shelf::observation(q, true);  // a contact in the air: nothing can be there
  expect_ok(tactus_belief_step(belief.get(), shelf::first_action(), &seen));
  std::vector<int32_t> events(3);
  expect_ok(tactus_belief_history(belief.get(), events.data(), 1, &count));
  tactus_action_properties properties{};
  expect_ok(tactus_action_properties_init(&properties, sizeof properties));
  expect_ok(tactus_action_info(shelf::first_action(), &properties));
  EXPECT_EQ(events, (std::vector<int32_t>{properties.kind, 1, 1}));
  EXPECT_EQ(summary(belief).doubted, 1u);
  EXPECT_EQ(summary(belief).health, TACTUS_HEALTH_CONTRADICTED);
  std::vector<double> stop(6);
  expect_ok(tactus_belief_stops(belief.get(), stop.data(), 1, &count));
  EXPECT_EQ(stop, q);
  expect_refused(tactus_belief_stops(belief.get(), stop.data(), 0, &count), TACTUS_BUFFER_TOO_SMALL, "joints");

  std::vector<double> mode(13);
  expect_ok(tactus_belief_modes(belief.get(), mode.data(), 1, &count));
  ASSERT_EQ(count, 1u);
  EXPECT_NEAR(mode[0], 1.0, 1e-12);
  EXPECT_NEAR(mode[8], summary(belief).extent[1], 1e-12);
}

std::vector<double> forecast(const shelf::Belief& belief, tactus_likelihood likelihood, std::uint64_t seed = 1) {
  std::size_t count = 0;
  expect_ok(tactus_belief_forecast(belief.get(), shelf::first_action(), likelihood, seed, nullptr, 0, &count));
  std::vector<double> probabilities(count);
  expect_ok(tactus_belief_forecast(belief.get(), shelf::first_action(), likelihood, seed, probabilities.data(), count,
                                   &count));
  return probabilities;
}

TEST(Belief, ForecastsAnActionByEitherLikelihood) {
  const shelf::Belief belief = shelf::belief();
  for (const tactus_likelihood likelihood : {TACTUS_LIKELIHOOD_PAPER, TACTUS_LIKELIHOOD_CALIBRATED}) {
    const std::vector<double> expected = forecast(belief, likelihood);
    EXPECT_EQ(expected.size(), shelf::waypoints(shelf::first_action()).size() / 6 + 1);
    EXPECT_NEAR(std::accumulate(expected.begin(), expected.end(), 0.0), 1.0, 1e-9);
    EXPECT_EQ(forecast(belief, likelihood), expected);
  }
  EXPECT_NE(forecast(belief, TACTUS_LIKELIHOOD_PAPER), forecast(belief, TACTUS_LIKELIHOOD_CALIBRATED));
  const shelf::Belief poses = shelf::belief(shelf::scenario(), TACTUS_BELIEF_PARTICLES);
  EXPECT_EQ(forecast(poses, TACTUS_LIKELIHOOD_PAPER), forecast(poses, TACTUS_LIKELIHOOD_CALIBRATED));
  std::size_t count = 0;
  expect_refused(tactus_belief_forecast(belief.get(), shelf::first_action(), 3, 1, nullptr, 0, &count),
                 TACTUS_INVALID_ARGUMENT, "likelihood");
  expect_refused(tactus_belief_forecast(belief.get(), nullptr, 1, 1, nullptr, 0, &count), TACTUS_INVALID_ARGUMENT,
                 "action");
}

TEST(Belief, AStopWithoutContactMidwayIsLegal) {
  const shelf::Belief belief = shelf::belief();
  const std::vector<double> path = shelf::waypoints(shelf::first_action());
  std::vector<double> q(path.begin() + 6, path.begin() + 12);
  const tactus_observation seen = shelf::observation(q);
  expect_ok(tactus_belief_step(belief.get(), shelf::first_action(), &seen));
  EXPECT_EQ(summary(belief).observations, 1u);
  std::vector<double> at(6);
  std::size_t count = 0;
  expect_ok(tactus_belief_configuration(belief.get(), at.data(), 6, &count));
  EXPECT_EQ(at, q);
}

TEST(Belief, AClonePartsFromItsOriginal) {
  const shelf::Belief belief = shelf::belief();
  tactus_belief* made = nullptr;
  expect_ok(tactus_belief_clone(belief.get(), &made));
  const shelf::Belief clone(made);
  EXPECT_EQ(shelf::saved(clone.get()), shelf::saved(belief.get()));
  const std::vector<double> path = shelf::waypoints(shelf::first_action());
  std::vector<double> q(path.end() - 6, path.end());
  const tactus_observation seen = shelf::observation(q);
  expect_ok(tactus_belief_step(clone.get(), shelf::first_action(), &seen));
  EXPECT_EQ(summary(clone).observations, 1u);
  EXPECT_EQ(summary(belief).observations, 0u);
}

TEST(Belief, ComesBackAsItWasSavedWhateverItsKind) {
  for (const tactus_belief_kind kind : {TACTUS_BELIEF_HIERARCHICAL, TACTUS_BELIEF_PARTICLES}) {
    const std::vector<std::uint8_t> bytes = shelf::saved(shelf::belief(shelf::scenario(), kind).get());
    tactus_belief* made = nullptr;
    expect_ok(tactus_belief_restore(shelf::scenario(), bytes.data(), bytes.size(), &made));
    EXPECT_EQ(shelf::saved(shelf::Belief(made).get()), bytes);
  }
}

TEST(Belief, DamagedBytesAreRefused) {
  std::vector<std::uint8_t> bytes = shelf::saved(shelf::belief().get());
  tactus_belief* made = reinterpret_cast<tactus_belief*>(8);
  expect_refused(tactus_belief_restore(shelf::scenario(), bytes.data(), bytes.size() - 1, &made),
                 TACTUS_BAD_SAVED_STATE, "saved belief");
  EXPECT_EQ(made, nullptr);
  bytes[bytes.size() / 2] ^= 1;
  expect_refused(tactus_belief_restore(shelf::scenario(), bytes.data(), bytes.size(), &made), TACTUS_BAD_SAVED_STATE,
                 "saved belief");
  expect_refused(tactus_belief_restore(shelf::scenario(), nullptr, 0, &made), TACTUS_INVALID_ARGUMENT, "bytes");
}

TEST(Belief, TwoThreadsAtOnceAreBusyAndNoRace) {
  const shelf::Belief belief = shelf::belief();
  std::atomic<int> good{0}, busy{0}, other{0};
  const auto use = [&] {
    tactus_summary known{};
    known.struct_size = sizeof known;
    for (int i = 0; i < 20; ++i) {
      const tactus_status status = tactus_belief_summary(belief.get(), &known);
      ++(status == TACTUS_OK ? good : status == TACTUS_BUSY ? busy : other);
    }
  };
  std::thread one(use), two(use);
  one.join(), two.join();
  EXPECT_GE(good, 20);
  EXPECT_EQ(good + busy, 40);
  EXPECT_EQ(other, 0);
}

}  // namespace
