// SPDX-License-Identifier: BSD-3-Clause
#include "solver/sampled_instance.hpp"

#include <gtest/gtest.h>

#include "belief/small_task.hpp"
#include "solver/evaluation.hpp"
#include "solver/exact.hpp"
#include "support/error.hpp"

/// Instances cut out of a task.
namespace tactus::test {
namespace {

using solver::Instance;
using solver::InstancePtr;
using solver::SampleOptions;
using solver::Solver;
using support::Rng;

constexpr double exact = 1e-9;

const action::Task& task() {
  static const auto made = small_task({.roll_width = 0.3});
  return *made;
}

InstancePtr sampled(const SampleOptions& options = {.poses = 8, .configurations = 40, .motions = 4},
                    std::uint64_t seed = 1) {
  Rng rng(seed);
  return std::make_shared<const Instance>(solver::sampled_instance(task(), options, rng));
}

/// Calls `visit(configuration, motion, results)` for each motion that can be made.
template <typename Visit>
void for_each_motion(const Instance& instance, Visit&& visit) {
  for (std::size_t place = 0; place < instance.configurations.size(); ++place)
    for (std::size_t motion = 0; motion < instance.motions.size(); ++motion)
      if (const auto& results = instance.configurations[place].results[motion]; !results.empty())
        visit(place, motion, results);
}

TEST(SampledInstance, IsWhatWasAskedFor) {
  for (const SampleOptions& options : {SampleOptions{.poses = 8, .configurations = 40, .motions = 4},
                                       SampleOptions{.poses = 1, .configurations = 5, .motions = 1},
                                       SampleOptions{.poses = 12, .configurations = 20, .motions = 9}}) {
    const InstancePtr instance = sampled(options);
    EXPECT_EQ(instance->weight.size(), options.poses);
    EXPECT_LE(instance->configurations.size(), options.configurations);
    EXPECT_EQ(instance->configurations.front().q, task().scene().start);
    EXPECT_EQ(instance->discount, 0.999);
  }
}

TEST(SampledInstance, IsClosedAndNothingIsFree) {
  const InstancePtr instance = sampled();
  for_each_motion(*instance, [&](std::size_t, std::size_t, const Instance::Results& results) {
    ASSERT_EQ(results.size(), instance->weight.size());
    for (const auto& [to, cost] : results) {
      ASSERT_GE(to, Instance::goal);
      ASSERT_LT(to, static_cast<int>(instance->configurations.size()));
      ASSERT_GT(cost, 0.0);
    }
  });
}

TEST(SampledInstance, OffersAnInsertionAtEveryPoseFromEverywhere) {
  const InstancePtr instance = sampled();
  std::vector<std::size_t> seats(instance->weight.size(), 0);
  for_each_motion(*instance, [&](std::size_t, std::size_t motion, const Instance::Results& results) {
    for (std::size_t pose = 0; pose < results.size(); ++pose)
      seats[pose] += instance->motions[motion] == "insertion" + std::to_string(pose) ||
                             instance->motions[motion].rfind("insertion", 0) != 0
                         ? results[pose].to == Instance::goal
                         : 0;
  });
  for (const std::size_t count : seats) EXPECT_EQ(count, instance->configurations.size());
}

/// The straight way there is the shortest.
TEST(SampledInstance, MotionsCostAtLeastTheStraightWayToWhereTheyEnd) {
  const InstancePtr instance = sampled();
  for_each_motion(*instance, [&](std::size_t place, std::size_t, const Instance::Results& results) {
    const Pose from = task().base_from_tool(instance->configurations[place].q);
    for (const auto& [to, cost] : results) {
      if (to == Instance::goal) continue;
      const Pose end = task().base_from_tool(instance->configurations[static_cast<std::size_t>(to)].q);
      ASSERT_GE(cost, (end.translation() - from.translation()).norm() - exact);
    }
  });
}

TEST(SampledInstance, ContactsAndOnlyTheseEndWhereThereWasContact) {
  const InstancePtr instance = sampled();
  bool touched = false, free = false;
  for (const Instance::Configuration& configuration : instance->configurations)
    (configuration.contact ? touched : free) = true;
  EXPECT_TRUE(touched);
  EXPECT_TRUE(free);
  EXPECT_FALSE(instance->configurations.front().contact);
}

TEST(SampledInstance, IsTheSameForTheSameSeed) {
  const InstancePtr a = sampled(), b = sampled(), other = sampled({.poses = 8, .configurations = 40, .motions = 4}, 2);
  ASSERT_EQ(a->configurations.size(), b->configurations.size());
  for (std::size_t place = 0; place < a->configurations.size(); ++place)
    EXPECT_EQ(a->configurations[place].results, b->configurations[place].results);
  EXPECT_NE(a->configurations.front().results, other->configurations.front().results);
}

TEST(SampledInstance, RefusesOptionsOutOfRange) {
  const auto refused = [](const SampleOptions& options, const std::string& word) {
    try {
      sampled(options);
      ADD_FAILURE() << word;
    } catch (const support::Error& error) {
      EXPECT_EQ(error.status(), support::Status::invalid_argument);
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  };
  refused({.poses = 0}, "poses");
  refused({.configurations = 4}, "configurations");
  refused({.motions = 1001}, "motions");
  refused({.discount = 0.0}, "discount");
  refused({.discount = std::nan("")}, "discount");
}

TEST(SampledInstance, EverySolverInsertsAtEveryPoseAndNoneBeatsTheOptimum) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const InstancePtr instance = sampled({.poses = 8, .configurations = 40, .motions = 4}, seed);
    solver::ExactSolver solver(instance, instance->discount);
    const auto optimum = solver.value(0, support::Bitset(instance->weight.size(), true));
    ASSERT_TRUE(optimum);
    for (const Solver by : {Solver::rtdp_bel, Solver::rtdp_inad, Solver::tbl, Solver::frontier, Solver::rate}) {
      solver::PlannerOptions options;
      options.solver = by;
      options.budget_seconds = std::numeric_limits<double>::infinity();
      options.budget_expansions = 100;
      const solver::Evaluation run = evaluate(instance, options);
      EXPECT_NEAR(run.inserted, 1.0, exact) << name_of(by);
      EXPECT_GE(run.expected_cost, *optimum - exact) << name_of(by);
      EXPECT_GE(run.worst_cost, run.expected_cost - exact);
    }
  }
}

TEST(SampledInstance, IsNotCutOutWhereMotionsCostNothing) {
  action::TaskOptions options = task().options();
  options.cost = {0.0, 0.0, 0.0};
  const action::Task free(task().scene(), options);
  Rng rng(1);
  try {
    solver::sampled_instance(free, {.poses = 6, .configurations = 20, .motions = 4}, rng);
    ADD_FAILURE();
  } catch (const support::Error& error) {
    EXPECT_NE(std::string(error.what()).find("cost.action"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tactus::test
