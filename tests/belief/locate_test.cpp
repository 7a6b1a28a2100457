// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>

#include "belief/plain_world.hpp"
#include "support/error.hpp"

/// Where on its path the robot stopped.
namespace tactus::test {
namespace {

using belief::Belief;
using belief::Observation;
using belief::Stop;
using support::Rng;
using support::Status;

const std::shared_ptr<const belief::Model>& model() {
  static const auto made = small_model(belief::Kind::hierarchical);
  return made;
}

const action::Task& task() { return *model()->task; }

JointVector between(const JointVector& a, const JointVector& b, double fraction) { return a + fraction * (b - a); }

/// In front of the prior: nothing to touch but what a test says.
JointVector in_front(double x, double y = 0.0) { return joints({x, y, 0, 0, 0, 0}); }

/// Out by `steps` of 4 mm along y, and back.
action::Action out_and_back(int steps) {
  std::vector<JointVector> path;
  for (int i = 0; i <= steps; ++i) path.push_back(in_front(0.34, 0.004 * i));
  for (int i = steps - 1; i >= 0; --i) path.push_back(path[static_cast<std::size_t>(i)]);
  return action_along(task(), path);
}

template <typename Work>
Status status_of(Work work) {
  try {
    work();
  } catch (const support::Error& error) {
    return error.status();
  }
  return Status::ok;
}

TEST(Locate, FindsStopsAtRandomFractions) {
  Rng rng(1);
  action::ActionLibrary library(task());
  for (int i = 0; i < 40; ++i) {
    const action::Action action = random_action(task(), library, task().scene().start, rng);
    const std::size_t segment = 1 + rng.below(action.path.size() - 1);
    const double fraction = rng.uniform(0.02, 0.98);
    const JointVector q = between(action.path[segment - 1], action.path[segment], fraction);
    for (const bool contact : {true, false}) {
      const Stop stop = belief::locate(task(), action, {contact, q});
      ASSERT_EQ(stop.segment, segment);
      EXPECT_NEAR(stop.fraction, fraction, 1e-6);
      EXPECT_LT(stop.last_free, segment);
      const auto trace = belief::trace_of(task(), action, {contact, q}, stop);
      EXPECT_EQ(trace.contact, contact);
      EXPECT_EQ(trace.path.back(), q);
      EXPECT_EQ(trace.bodies.size(), trace.path.size());
      EXPECT_EQ(trace.outcome, contact ? segment : stop.last_free);
    }
  }
}

TEST(Locate, TakesAStopAtTheFirstPassUnlessItIsTheEndOfAFreePath) {
  const action::Action action = out_and_back(5);
  const JointVector q = between(action.path[2], action.path[3], 0.5);
  EXPECT_EQ(belief::locate(task(), action, {true, q}).segment, 3u);
  EXPECT_EQ(belief::locate(task(), action, {false, q}).segment, 3u);
  EXPECT_EQ(belief::locate(task(), action, {true, action.path[2]}).segment, 2u);
  EXPECT_EQ(belief::locate(task(), action, {false, action.path[2]}).last_free, 2u);
  EXPECT_EQ(belief::locate(task(), action, {true, action.path.front()}).segment, 0u);
  EXPECT_EQ(belief::locate(task(), action, {false, action.path.front()}).last_free, 10u);
}

TEST(Locate, TheLastFreeWaypointIsFartherBackThanTheStopTolerance) {
  const action::Action action = out_and_back(5);
  const JointVector just_after = between(action.path[2], action.path[3], 0.1);  // 0.4 mm
  EXPECT_EQ(belief::locate(task(), action, {true, just_after}).last_free, 1u);
  const JointVector well_after = between(action.path[2], action.path[3], 0.3);  // 1.2 mm
  EXPECT_EQ(belief::locate(task(), action, {true, well_after}).last_free, 2u);
  EXPECT_EQ(belief::locate(task(), action, {true, action.path[3]}).last_free, 2u);
}

TEST(Locate, WhatIsFreeBeforeAContactEndsTheStopToleranceBeforeIt) {
  const action::Action action = out_and_back(5);
  const Observation seen{true, between(action.path[2], action.path[3], 0.75)};  // 3 mm behind waypoint 2
  const auto trace = belief::trace_of(task(), action, seen, belief::locate(task(), action, seen));
  ASSERT_EQ(trace.path.size(), 5u);
  EXPECT_NEAR(trace.path[4][1] - trace.path[3][1], task().options().stop_tolerance, 1e-9);
}

TEST(Locate, AStopALittleBesideThePathIsStillOnIt) {
  const action::Action action = out_and_back(5);
  JointVector q = between(action.path[2], action.path[3], 0.5);
  q[0] += 0.0008;
  EXPECT_EQ(belief::locate(task(), action, {true, q}).segment, 3u);
  q[0] += 0.0004;
  EXPECT_EQ(status_of([&] { belief::locate(task(), action, {true, q}); }), Status::stop_off_path);
}

TEST(Locate, AllOfAFreePathIsFree) {
  const action::Action action = out_and_back(3);
  const Observation seen{false, action.path.back()};
  const auto trace = belief::trace_of(task(), action, seen, belief::locate(task(), action, seen));
  EXPECT_EQ(trace.path, action.path);
  EXPECT_EQ(trace.outcome, action.path.size());
}

/// What a robot at `q` reports if its encoders put some point of it `off` metres off.
JointVector misread(const action::Task& noisy, const JointVector& q, double off, Rng& rng) {
  JointVector error(q.size());
  for (double& component : error) component = rng.uniform(-1.0, 1.0) * 0.01;
  for (int i = 0; i < 5; ++i) error *= off / noisy.known_world().displacement(q, q + error);
  return q + error;
}

TEST(Locate, IsOffByNoMoreThanTheEncodersAreAtBothEnds) {
  const action::Sensing sensing{.stopping_distance = 0.002, .encoder_error = 0.0015};
  const auto noisy = small_task({.sensing = sensing});
  Rng rng(2);
  action::ActionLibrary library(*noisy);
  for (int i = 0; i < 60; ++i) {
    const action::Action action = random_action(*noisy, library, noisy->scene().start, rng);
    const std::size_t segment = 1 + rng.below(action.path.size() - 1);
    const JointVector truth = between(action.path[segment - 1], action.path[segment], rng.uniform());
    const JointVector q = misread(*noisy, truth, 0.999 * sensing.encoder_error, rng);
    const Stop stop = belief::locate(*noisy, action, {true, q});
    const JointVector located = stop.segment == 0
                                    ? action.path.front()
                                    : between(action.path[stop.segment - 1], action.path[stop.segment], stop.fraction);
    EXPECT_LE(noisy->known_world().displacement(located, truth), 2.0 * sensing.encoder_error + 1e-6);
    if (stop.last_free == 0) continue;
    const double back = noisy->known_world().displacement(action.path[stop.last_free], truth);
    EXPECT_GE(back, noisy->options().stop_tolerance + sensing.stopping_distance - 1e-6);
  }
}

TEST(Locate, AStopNearThePathIsOnItHoweverFarTheJointsAreOff) {
  std::vector<JointVector> path;
  for (int i = 0; i <= 5; ++i) path.push_back(joints({0.34, 0.004 * i, 0, 0.09 * i, 0, 0}));
  JointVector q = between(path[2], path[3], 0.5);
  q[3] += 0.03;  // turns the tool by half a millimetre, and is nearest in joints to a point 1.3 mm on
  const Stop stop = belief::locate(task(), action_along(task(), path), {true, q});
  EXPECT_EQ(stop.segment, 3u);
}

TEST(Locate, AStopWithinTheEncoderErrorOfTheEndIsTheEnd) {
  const action::Sensing sensing{.encoder_error = 0.0005};
  const auto noisy = small_task({.sensing = sensing});
  const action::Action action = out_and_back(5);
  Rng rng(3);
  for (int i = 0; i < 50; ++i) {
    const Observation seen{false, misread(*noisy, action.path.back(), rng.uniform() * sensing.encoder_error, rng)};
    const Stop stop = belief::locate(*noisy, action, seen);
    EXPECT_EQ(stop.last_free, action.path.size() - 1);
    EXPECT_EQ(belief::trace_of(*noisy, action, seen, stop).path, action.path);
  }
  const JointVector halted = between(action.path[9], action.path[10], 0.5);  // 2 mm
  EXPECT_LT(belief::locate(*noisy, action, {false, halted}).last_free, action.path.size() - 1);
}

TEST(Step, GoesBackToTheLastFreeWaypointAfterAContactAndStaysWhereItStoppedWithout) {
  const action::Action action =
      action_along(task(), {in_front(0.40), in_front(0.404), in_front(0.408), in_front(0.412), in_front(0.416)});
  const JointVector stop = between(action.path[3], action.path[4], 0.5);
  Belief touched(model(), action.path.front()), halted = touched;
  touched.step(action, {true, stop});
  EXPECT_EQ(touched.configuration(), action.path[3]);
  halted.step(action, {false, stop});
  EXPECT_EQ(halted.configuration(), stop);
}

TEST(Step, NothingChangesAfterAnErrorOfTheCaller) {
  const action::Action action = out_and_back(5);
  Belief belief(model(), action.path.front());
  belief.step(action, {false, action.path.back()});
  const std::vector<std::uint8_t> before = belief.save();
  JointVector off = action.path[3], infinite = off, nan = off;
  off[0] -= 0.01;
  nan[4] = std::numeric_limits<double>::quiet_NaN();
  infinite[0] = std::numeric_limits<double>::infinity();
  for (const bool contact : {true, false}) {
    EXPECT_EQ(status_of([&] { belief.step(action, {contact, off}); }), Status::stop_off_path);
    EXPECT_EQ(status_of([&] { belief.step(action, {contact, nan}); }), Status::invalid_argument);
    EXPECT_EQ(status_of([&] { belief.step(action, {contact, infinite}); }), Status::invalid_argument);
    EXPECT_EQ(status_of([&] { belief.step(action, {contact, joints({0, 0, 0})}); }), Status::invalid_argument);
    EXPECT_EQ(status_of([&] { belief.step(action, {contact, {}}); }), Status::invalid_argument);
  }
  EXPECT_EQ(belief.save(), before);
}

TEST(Step, TheErrorNamesTheJointAndHowFarOff) {
  const action::Action action = out_and_back(5);
  JointVector nan = action.path[3], off = nan;
  nan[4] = std::numeric_limits<double>::quiet_NaN();
  off[0] -= 0.01;
  const auto text = [&](const JointVector& q) {
    try {
      belief::locate(task(), action, {true, q});
    } catch (const support::Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(text(nan).find("pitch_joint"), std::string::npos) << text(nan);
  EXPECT_NE(text(off).find("10.0"), std::string::npos) << text(off);
}

/// In along x, a millimetre aside and out again: reported from the way in, and nearer to the way out.
TEST(Locate, OfPassesThatARobotMayHaveStoppedOnTakesTheFirst) {
  const auto may_err = small_model(belief::Kind::particles, {.sensing = {.encoder_error = 0.0015}});
  const Pose truth = geometry::pose_from({0.45, 0.0, 0.01, 0.1, 0.0, 0.0});
  const auto at = [](double x, double y) { return joints({x, y, 0.01, 0, 0, 0}); };
  const action::Action action =
      action_round(*may_err->task, {at(0.40, 0.012), at(0.446, 0.012), at(0.446, 0.013), at(0.40, 0.013)});
  for (const double aside : {0.0, 0.0003, 0.0006, 0.0009, 0.0012}) {
    const Observation seen{true, at(0.4216, 0.012 + aside)};
    EXPECT_LE(belief::locate(*may_err->task, action, seen).segment, 6u) << aside;
    Belief belief(may_err, may_err->task->scene().start);
    belief.step(action, seen);
    EXPECT_TRUE(belief.contains(truth)) << aside;
    EXPECT_EQ(belief.health(), belief::Health::good) << aside;
  }
}

TEST(Locate, ATraceRetracedStaysAsFarOffAsItWas) {
  action::Action action = action_round(task(), {in_front(0.30), in_front(0.32)});
  action.sensing.encoder_error = 0.006;
  const Observation seen{false, action.path.back()};
  const belief::Trace trace = belief::trace_of(task(), action, seen, belief::locate(task(), action, seen));
  EXPECT_EQ(belief::retraced(task(), trace, {.encoder_error = 0.0001}).error, 0.006);
  EXPECT_EQ(belief::retraced(task(), trace, {.encoder_error = 0.007}).error, 0.007);
}

}  // namespace
}  // namespace tactus::test
