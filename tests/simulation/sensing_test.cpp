// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/random_worlds.hpp"

/// What an imperfect robot reports, and what a belief that is told of it makes of that.
namespace tactus::test {
namespace {

Model with_sensing(const action::Sensing& sensing, Kind kind = Kind::particles) {
  return small_model(kind, {.roll_width = 0.2, .position_width = 0.04, .most_cells = 200, .sensing = sensing});
}

double apart(const JointVector& a, const JointVector& b) { return model()->task->known_world().displacement(a, b); }

/// One random action a trial, in a new world each, beside what a perfect robot would have seen;
/// `visit(world, action, seen, perfect)`.
template <typename Visit>
void for_single_actions(const action::Sensing& sensing, std::uint64_t seed, int trials, Visit&& visit) {
  Rng rng(seed);
  action::ActionLibrary library(*model()->task);
  for (int trial = 0; trial < trials; ++trial) {
    const Pose truth = model()->task->scene().prior.sample(rng);
    World world(model(), truth, {.sensing = sensing, .seed = rng.next()}), perfect(model(), truth);
    const action::Action action = random_action(*model()->task, library, world.configuration(), rng);
    const Observation seen = world.execute(action);
    ASSERT_NO_FATAL_FAILURE(visit(world, action, seen, perfect.execute(action)));
  }
}

/// Insertions beside the seat that touch something; in worlds that miss half of their contacts.
template <typename Visit>
void for_faulty_insertions(std::uint64_t seed, Visit&& visit) {
  Rng rng(seed);
  const Model m = with_sensing({.missed_contacts = 0.5});
  action::ActionLibrary library(*m->task);
  for (int i = 0; i < 60; ++i) {
    const Pose truth = m->task->scene().prior.sample(rng);
    World world(m, truth, {.seed = rng.next()}), perfect(model(), truth);
    PoseVector off;
    for (std::size_t d = 0; d < 6; ++d) off[d] = rng.uniform(-1.0, 1.0) * (d == 0 ? 1.5e-3 : d < 3 ? 5e-4 : 0.05);
    const action::Action action =
        insertion_at(*m->task, library, world.configuration(), truth * geometry::pose_from(off));
    if (perfect.execute(action).contact) visit(world, action, world.execute(action));
  }
}

TEST(Sensing, OfNoErrorIsAPerfectRobotWhateverTheSeed) {
  for_single_actions({}, 20, 40,
                     [](const World&, const action::Action&, const Observation& seen, const Observation& perfect) {
                       EXPECT_EQ(seen.contact, perfect.contact);
                       EXPECT_EQ(seen.q, perfect.q);
                     });
}

TEST(Sensing, ReportsAStopWithinTheStoppingDistanceAndTheEncoderErrorOfTheFirstContact) {
  const action::Sensing sensing{.stopping_distance = 0.003, .encoder_error = 0.0005};
  int contacts = 0;
  double farthest = 0.0;
  for_random_actions(with_sensing(sensing), 21, 15,
                     [&](const World& world, const action::Action& action, const Observation& seen) {
                       const Observation plain = plain_stop(*model()->task, world.base_from_target(), action);
                       ASSERT_EQ(seen.contact, plain.contact);
                       const double off = apart(seen.q, plain.q);
                       ASSERT_LE(off, sensing.encoder_error + (seen.contact ? sensing.stopping_distance : 0.0) + 1e-6);
                       if (!seen.contact) return;
                       ++contacts;
                       farthest = std::max(farthest, off);
                     });
  EXPECT_GT(contacts, 15);
  EXPECT_GT(farthest, 0.6 * sensing.stopping_distance);
}

TEST(Sensing, GoesBackToWhereTheRobotIsClearAndABeliefIsToo) {
  const Model m = with_sensing({.stopping_distance = 0.003, .encoder_error = 0.0005});
  for_random_actions(m, 22, 15, [&](const World& world, const action::Action& action, const Observation& seen) {
    belief::Belief belief(m, action.path.front());
    belief.step(action, seen);
    ASSERT_EQ(world.configuration(), belief.configuration());
    const auto end = std::find(action.path.begin(), action.path.end(), world.configuration());
    ASSERT_NE(end, action.path.end());
    const action::Action free = action_along(*m->task, {action.path.begin(), end + 1});
    if (free.path.size() < 2) return;
    EXPECT_FALSE(plain_stop(*m->task, world.base_from_target(), free).contact);
  });
}

TEST(Sensing, ReportsJointsThatAreOffByUpToTheEncoderErrorEverywhere) {
  const double most = 0.0005;
  double sum = 0.0, largest = 0.0;
  int free = 0;
  for_single_actions(
      {.encoder_error = most}, 23, 150,
      [&](const World& world, const action::Action& action, const Observation& seen, const Observation&) {
        if (seen.contact) return;
        EXPECT_EQ(world.configuration(), action.path.back());
        const double off = apart(seen.q, action.path.back());
        ++free, sum += off, largest = std::max(largest, off);
      });
  ASSERT_GT(free, 50);
  EXPECT_LE(largest, most);
  EXPECT_NEAR(sum / free, 0.5 * most, 0.1 * most);
}

TEST(Sensing, MissesItsShareOfContactsAndThenGoesOnToTheEnd) {
  int contacts = 0, missed = 0;
  for_single_actions(
      {.missed_contacts = 0.3}, 24, 400,
      [&](const World& world, const action::Action& action, const Observation& seen, const Observation& perfect) {
        EXPECT_TRUE(perfect.contact || !seen.contact);
        if (!perfect.contact) return;
        ++contacts;
        if (seen.contact) return;
        ++missed;
        EXPECT_EQ(world.configuration(), action.path.back());
      });
  ASSERT_GT(contacts, 100);
  EXPECT_NEAR(static_cast<double>(missed) / contacts, 0.3, 4.0 * std::sqrt(0.21 / contacts));
}

TEST(Sensing, IsStoppedByItsShareOfFalseContactsAnywhereOnTheWay) {
  int motions = 0, stopped = 0;
  double fractions = 0.0;
  for_single_actions(
      {.false_contacts = 0.3}, 25, 400,
      [&](const World&, const action::Action& action, const Observation& seen, const Observation& perfect) {
        EXPECT_TRUE(seen.contact || !perfect.contact);
        if (perfect.contact) return;
        ++motions;
        if (!seen.contact) return;
        ++stopped;
        const belief::Stop stop = belief::locate(*model()->task, action, seen);
        fractions +=
            (static_cast<double>(stop.segment) - 1.0 + stop.fraction) / static_cast<double>(action.path.size() - 1);
      });
  ASSERT_GT(motions, 100);
  EXPECT_NEAR(static_cast<double>(stopped) / motions, 0.3, 4.0 * std::sqrt(0.21 / motions));
  EXPECT_NEAR(fractions / stopped, 0.5, 4.0 * std::sqrt(1.0 / 12.0 / stopped));
}

TEST(Sensing, IsTheSameForTheSameSeed) {
  const Model m = with_sensing(
      {.stopping_distance = 0.002, .encoder_error = 0.0002, .missed_contacts = 0.3, .false_contacts = 0.3});
  const Pose truth = m->task->scene().prior.central_pose();
  World one(m, truth, {.seed = 5}), same(m, truth, {.seed = 5}), other(m, truth, {.seed = 6});
  action::ActionLibrary library(*m->task);
  Rng rng(26);
  for (int i = 0; i < 10; ++i) {
    const action::Action action = random_action(*m->task, library, one.configuration(), rng);
    const Observation seen = one.execute(action), again = same.execute(action);
    EXPECT_EQ(seen.contact, again.contact);
    EXPECT_EQ(seen.q, again.q);
    if (i == 0) {
      EXPECT_NE(seen.q, other.execute(action).q);
    }
  }
}

TEST(Sensing, AMissedContactIsNoInsertion) {
  int at_seat = 0;
  for_faulty_insertions(27, [&](const World& world, const action::Action&, const Observation& seen) {
    EXPECT_FALSE(world.inserted());
    const action::Task& task = *model()->task;
    at_seat +=
        !seen.contact && task.scene().is_seated(task.base_from_tool(world.configuration()), world.base_from_target());
  });
  EXPECT_GT(at_seat, 3);
}

TEST(Sensing, ATouchThatWasThereAtTheStartIsFeltOnlyAfterTheRobotWasClear) {
  int left = 0;
  for_faulty_insertions(28, [&](World& world, const action::Action& in, const Observation& seen) {
    if (seen.contact) return;
    const action::Action out = action_along(*model()->task, {in.path.rbegin(), in.path.rend()});
    EXPECT_FALSE(world.execute(out).contact);
    EXPECT_EQ(world.configuration(), in.path.front());
    ++left;
  });
  EXPECT_GT(left, 5);
}

TEST(Sensing, NeverMakesABeliefThrow) {
  const action::Sensing all{
      .stopping_distance = 0.002, .encoder_error = 0.0005, .missed_contacts = 0.2, .false_contacts = 0.2};
  for (const Kind kind : {Kind::hierarchical, Kind::particles}) {
    const Model m = with_sensing(all, kind);
    Rng rng(29);
    action::ActionLibrary library(*m->task);
    for (int episode = 0; episode < 5; ++episode) {
      World world(m, m->task->scene().prior.sample(rng), {.seed = rng.next()});
      belief::Belief belief(m, world.configuration());
      for (int i = 0; i < 12; ++i) {
        const action::Action action = random_action(*m->task, library, belief.configuration(), rng);
        ASSERT_NO_THROW(belief.step(action, world.execute(action)));
        ASSERT_EQ(world.configuration(), belief.configuration());
      }
    }
  }
}

/// Episodes of a real robot and a belief that is told of another one; in how many the truth was lost. `expect_none`: it
/// must be there after each action.
int losses(const Model& told, const action::Sensing& real, bool expect_none) {
  Rng rng(31);
  action::ActionLibrary library(*told->task);
  int lost = 0;
  for (int episode = 0; episode < 10; ++episode) {
    const Pose truth = told->task->scene().prior.sample(rng);
    World world(told, truth, {.sensing = real, .seed = rng.next()});
    belief::Belief belief(told, world.configuration());
    for (int i = 0; i < 10; ++i) {
      const action::Action action = i % 5 == 4 ? insertion_at(*told->task, library, belief.configuration(), truth)
                                               : random_action(*told->task, library, belief.configuration(), rng);
      belief.step(action, world.execute(action));
      if (expect_none) {
        EXPECT_EQ(belief.health(), belief::Health::good) << "episode " << episode << ", action " << i;
        EXPECT_TRUE(belief.contains(truth)) << "episode " << episode << ", action " << i;
        for (const belief::Trace& trace : belief.history())
          EXPECT_TRUE(belief::reproduces(*told->task, trace, truth)) << "episode " << episode << ", action " << i;
      }
    }
    lost += !belief.contains(truth);
  }
  return lost;
}

/// Nothing is missed or made up, but the robot travels on after a contact and its encoders are off: a belief that is
/// told so never loses the truth; one that is not does.
TEST(Sensing, ThatABeliefKnowsOfNeverCostsItTheTruth) {
  const action::Sensing real{.stopping_distance = 0.002, .encoder_error = 0.0003};
  for (const Kind kind : {Kind::hierarchical, Kind::particles})
    EXPECT_EQ(losses(with_sensing(real, kind), real, true), 0);
  EXPECT_GT(losses(with_sensing({.encoder_error = 0.0003}), real, false), 0);
}

TEST(Sensing, OfTheWorldMayBeOtherThanTheScenarioSays) {
  const Pose truth = model()->task->scene().prior.central_pose();
  World world(model(), truth, {.sensing = action::Sensing{.encoder_error = 0.0005}});
  JointVector reported = world.configuration();
  reported[0] += 0.0004;
  const JointVector there = joints({0.35, 0.01, -0.02, 0, 0, 0});
  EXPECT_NO_THROW(world.execute(action_along(*model()->task, {reported, there})));
  EXPECT_EQ(world.configuration(), there);
  reported = there;
  reported[0] += 0.0006;
  EXPECT_THROW(world.execute(action_along(*model()->task, {reported, there})), support::Error);
}

TEST(Sensing, ChangesNothingIfItsReportIsNowhereOnThePath) {
  const Pose truth = model()->task->scene().prior.central_pose();
  action::ActionLibrary library(*model()->task);
  Pose behind = truth;
  behind.translation().x() += 0.01;
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    World world(model(), truth, {.sensing = action::Sensing{.encoder_error = 0.05}, .seed = seed});
    const JointVector start = world.configuration();
    try {
      world.execute(insertion_at(*model()->task, library, start, behind));
    } catch (const support::Error& error) {
      EXPECT_EQ(error.status(), Status::stop_off_path);
      EXPECT_EQ(world.configuration(), start);
      EXPECT_EQ(world.travelled().metres, 0.0);
      ++refused;
    }
  }
  EXPECT_GT(refused, 2);
}

TEST(Options, SensingIsInItsRange) {
  const Pose truth = model()->task->scene().prior.central_pose();
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const auto refused = [&](const action::Sensing& sensing, const std::string& named) {
    try {
      World(model(), truth, {.sensing = sensing});
    } catch (const support::Error& error) {
      return error.status() == Status::invalid_argument && std::string(error.what()).find(named) != std::string::npos;
    }
    return false;
  };
  for (const double bad : {-1e-9, nan, infinite}) {
    EXPECT_TRUE(refused({.stopping_distance = bad}, "stopping_distance")) << bad;
    EXPECT_TRUE(refused({.encoder_error = bad}, "encoder_error")) << bad;
  }
  for (const double bad : {-1e-9, 0.51, nan}) {
    EXPECT_TRUE(refused({.missed_contacts = bad}, "missed_contacts")) << bad;
    EXPECT_TRUE(refused({.false_contacts = bad}, "false_contacts")) << bad;
  }
  EXPECT_FALSE(refused({0.01, 0.01, 0.5, 0.5}, ""));
}

}  // namespace
}  // namespace tactus::test
