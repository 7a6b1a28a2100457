// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include "action/insertion.hpp"
#include "simulation/random_worlds.hpp"

/// The simulated robot against one that is written plainly: the same steps, every pair of triangles.
namespace tactus::test {
namespace {

/// A task whose target's frame is turned about y by `pitch` from the shape, so that a pose of that pitch has the hole
/// where the arm gets at it.
Model turned_model(double pitch, double pitch_width) {
  scene::Scene scene = small_scene();
  const Pose target_from_shape = geometry::pose_from({0, 0, 0, 0, pitch, 0}).inverse();
  scene.target.mesh = geometry::transformed(scene.target.mesh, target_from_shape);
  for (Pose& target_from_seated : scene.target.target_from_seated)
    target_from_seated = target_from_shape * target_from_seated;
  scene.target.approach_axis = target_from_shape.linear() * scene.target.approach_axis;
  scene.prior = {{0.45, 0.0, 0.01, 0.0, pitch, 0.0}, {0.0, 0.04, 0.04, 0.0, pitch_width, 0.0}};
  return small_model(std::make_shared<const action::Task>(scene, action::TaskOptions{}), Kind::particles);
}

motion::ToolTravel travel(const motion::JointPath& path) {
  const scene::Scene& scene = model()->task->scene();
  return motion::tool_travel(*scene.robot, scene.tool_link, path);
}

Status refusal(const Model& m, const Pose& truth, const std::string& named) {
  try {
    World world(m, truth);
  } catch (const support::Error& error) {
    EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
    return error.status();
  }
  return Status::ok;
}

TEST(Execution, StopsAtTheFirstContactAndNowhereElse) {
  int contacts = 0, free = 0;
  for (const Model& m : {model(), turned_model(1.5, 0.4)})
    for_random_actions(m, 1, 15, [&](const World& world, const action::Action& action, const Observation& seen) {
      const Observation plain = plain_stop(*m->task, world.base_from_target(), action);
      ASSERT_EQ(seen.contact, plain.contact);
      ASSERT_TRUE(seen.q.isApprox(plain.q, 1e-12));
      (seen.contact ? contacts : free) += 1;
    });
  EXPECT_GT(std::min(contacts, free), 20);
}

TEST(Execution, EndsAtTheLastFreeWaypointWhereABeliefIsToo) {
  for_random_actions(model(), 2, 15, [](const World& world, const action::Action& action, const Observation& seen) {
    belief::Belief belief(model(), action.path.front());
    belief.step(action, seen);
    ASSERT_EQ(world.configuration(), belief.configuration());
    if (!seen.contact) {
      ASSERT_EQ(world.configuration(), action.path.back());
    }
  });
}

TEST(Execution, TravelsThereAndBack) {
  motion::ToolTravel before;
  for_random_actions(model(), 3, 10, [&](const World& world, const action::Action& action, const Observation& seen) {
    const auto end = std::find(action.path.begin(), action.path.end(), world.configuration());
    const motion::ToolTravel last_free = travel({action.path.begin(), end + 1});
    motion::ToolTravel expected = last_free;
    if (seen.contact) {
      const std::size_t segment = belief::locate(*model()->task, action, seen).segment;
      motion::JointPath beyond(end, action.path.begin() + std::ptrdiff_t(segment));
      beyond.push_back(seen.q);
      expected.metres += 2.0 * travel(beyond).metres;
      expected.radians += 2.0 * travel(beyond).radians;
    }
    if (world.travelled().metres < before.metres) before = {};  // another world
    EXPECT_NEAR(world.travelled().metres - before.metres, expected.metres, 1e-9);
    EXPECT_NEAR(world.travelled().radians - before.radians, expected.radians, 1e-6);
    before = world.travelled();
  });
}

TEST(Execution, BeginsWhereTheRobotIs) {
  World world(model(), model()->task->scene().prior.central_pose());
  const JointVector start = world.configuration();
  EXPECT_EQ(start, model()->task->scene().start);
  action::Action action;
  EXPECT_THROW(world.execute(action), support::Error);
  for (const JointVector& q : {joints({0.34, 0.011, -0.02, 0, 0, 0}), joints({0.34, 0.01})}) {
    action.path = {q, start};
    EXPECT_THROW(world.execute(action), support::Error);
  }
  EXPECT_EQ(world.configuration(), start);
  EXPECT_EQ(world.travelled().metres, 0.0);
}

TEST(Insertion, IsDoneAtTheSeatAndNotAfterwards) {
  Rng rng(4);
  action::ActionLibrary library(*model()->task);
  for (int i = 0; i < 8; ++i) {
    const Pose truth = model()->task->scene().prior.sample(rng);
    World world(model(), truth);
    EXPECT_FALSE(world.inserted());
    const action::Action in = insertion_at(*model()->task, library, world.configuration(), truth);
    EXPECT_FALSE(world.execute(in).contact);
    EXPECT_TRUE(world.inserted());
    const action::Action out = action_along(*model()->task, {in.path.rbegin(), in.path.rend()});
    EXPECT_FALSE(world.execute(out).contact);
    EXPECT_FALSE(world.inserted());

    Pose beside = truth;
    beside.translation() += Vector3(0.0, 0.004, 0.0);
    EXPECT_TRUE(world.execute(insertion_at(*model()->task, library, world.configuration(), beside)).contact);
    EXPECT_FALSE(world.inserted());
  }
}

TEST(Insertion, IsDoneAtAnySeat) {
  Rng rng(12);
  const Model m = small_model(Kind::particles, {.roll_width = 0.2, .position_width = 0.04, .seats = 4});
  action::ActionLibrary library(*m->task);
  for (std::size_t seat = 0; seat < 3; ++seat) {  // the wrist does not turn to the last
    const Pose truth = m->task->scene().prior.sample(rng);
    World world(m, truth), of_one_seat(model(), truth);
    const auto motion = action::insertion(*m->task, truth, world.configuration(), seat);
    ASSERT_TRUE(motion);
    const auto in = library.realise(world.configuration(), *motion, support::Deadline::unlimited());
    ASSERT_TRUE(in);
    EXPECT_FALSE(world.execute(*in).contact);
    EXPECT_TRUE(world.inserted());
    EXPECT_FALSE(of_one_seat.execute(*in).contact);
    EXPECT_EQ(of_one_seat.inserted(), seat == 0);
  }
}

TEST(Truth, IsTakenAsGiven) {
  Rng rng(5);
  for (int i = 0; i < 50; ++i) {
    const Pose truth = geometry::pose_from(random_pose(model()->task->scene().prior, rng));
    EXPECT_EQ(World(model(), truth).base_from_target().matrix(), truth.matrix());
  }
}

TEST(Truth, LiesInThePriorToTheEdge) {
  const scene::Prior& prior = model()->task->scene().prior;
  for (std::size_t d = 0; d < 6; ++d)
    for (const double sign : {-1.0, 1.0}) {
      PoseVector v = prior.centre;
      v[d] += sign * 0.5 * prior.width[d];
      EXPECT_EQ(refusal(model(), geometry::pose_from(v), ""), Status::ok);
      v[d] += sign * 1e-4;
      EXPECT_EQ(refusal(model(), geometry::pose_from(v), "prior"), Status::invalid_argument) << d;
    }
}

TEST(Truth, IsFinite) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Pose truth = model()->task->scene().prior.central_pose();
    truth.translation().y() = bad;
    EXPECT_EQ(refusal(model(), truth, "true_pose"), Status::invalid_argument);
    truth = model()->task->scene().prior.central_pose();
    truth.linear()(1, 1) = bad;
    EXPECT_EQ(refusal(model(), truth, "true_pose"), Status::invalid_argument);
  }
}

TEST(Truth, LeavesTheStartFree) {
  scene::Scene scene = small_scene();
  scene.start = joints({0.44, 0.0, 0.01, 0.0, 0.0, 0.0});
  const Model m = small_model(std::make_shared<const action::Task>(scene, action::TaskOptions{}), Kind::particles);
  PoseVector v = scene.prior.centre;
  EXPECT_EQ(refusal(m, geometry::pose_from(v), "true_pose"), Status::start_in_collision);
  v[1] = 0.039;
  EXPECT_EQ(refusal(m, geometry::pose_from(v), ""), Status::ok);
}

TEST(Truth, MayBeTurnedPastAQuarterTurnOfPitch) {
  const Model m = turned_model(1.5, 0.4);
  action::ActionLibrary library(*m->task);
  for (const double pitch : {1.31, 1.56, 1.58, 1.69}) {
    const Pose truth = geometry::pose_from({0.45, 0.01, 0.0, 0.0, pitch, 0.0});
    World world(m, truth);
    world.execute(insertion_at(*m->task, library, world.configuration(), truth));
    EXPECT_TRUE(world.inserted()) << pitch;
  }
  EXPECT_EQ(refusal(m, geometry::pose_from({0.45, 0.01, 0.0, 0.0, 1.71, 0.0}), "prior"), Status::invalid_argument);
}

TEST(Options, FinenessIsAtLeastOne) {
  const Pose truth = model()->task->scene().prior.central_pose();
  for (const double bad : {0.5, 0.0, -3.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(World(model(), truth, {bad}), support::Error);
  EXPECT_NO_THROW(World(model(), truth, {1.0}));
}

TEST(Insertion, IsNotDoneByAContactShortOfTheSeat) {
  Rng rng(11);
  const action::Task& task = *model()->task;
  action::ActionLibrary library(task);
  int stopped = 0;
  for (int i = 0; i < 60; ++i) {
    const Pose truth = task.scene().prior.sample(rng);
    World world(model(), truth);
    PoseVector off;
    for (std::size_t d = 0; d < 6; ++d) off[d] = rng.uniform(-1.0, 1.0) * (d == 0 ? 1e-3 : d < 3 ? 5e-4 : 0.05);
    const action::Action action = insertion_at(task, library, world.configuration(), truth * geometry::pose_from(off));
    if (!world.execute(action).contact) continue;
    ++stopped;
    EXPECT_FALSE(world.inserted());
  }
  EXPECT_GT(stopped, 5);
}

/// The tolerance says how far before a reported stop the first contact may lie.
TEST(Execution, ReportsStopsWithinTheToleranceHoweverCoarseTheActionsSteps) {
  action::TaskOptions options;
  options.stop_tolerance = 0.0003;
  const auto task = std::make_shared<const action::Task>(small_scene(), options);
  const Model strict = small_model(task, Kind::particles);
  Rng rng(12);
  int contacts = 0;
  for (int i = 0; i < 40; ++i) {
    const Pose truth = geometry::pose_from(random_pose(task->scene().prior, rng));
    World world(strict, truth, {1.0});
    belief::Belief belief(strict, world.configuration());
    const double y = rng.uniform(-0.03, 0.03), z = rng.uniform(-0.02, 0.04), x = 0.34 + rng.uniform(0.0, 0.004);
    for (const JointVector& to : {joints({x, y, z, 0, 0, 0}), joints({0.44, y, z, 0, 0, 0})}) {
      const action::Action action = action_round(*task, {world.configuration(), to});
      const Observation seen = world.execute(action);
      belief.step(action, seen);
      contacts += seen.contact;
    }
    EXPECT_TRUE(belief::reproduces(*task, belief.history(), truth)) << i;
    EXPECT_TRUE(belief.contains(truth)) << i;
  }
  EXPECT_GT(contacts, 10);
}

}  // namespace
}  // namespace tactus::test
