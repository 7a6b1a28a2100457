// SPDX-License-Identifier: BSD-3-Clause
#include "capi/shelf.hpp"

namespace {

using shelf::expect_ok;
using shelf::expect_refused;

using Instance = std::unique_ptr<tactus_instance, shelf::Destroy<tactus_instance, tactus_instance_destroy>>;

tactus_instance_options options() {
  tactus_instance_options made{};
  expect_ok(tactus_instance_options_init(&made, sizeof made));
  made.poses = 6;
  made.configurations = 20;
  made.motions = 3;
  return made;
}

Instance instance(const tactus_scenario* of = shelf::scenario()) {
  const tactus_instance_options given = options();
  tactus_instance* made = nullptr;
  expect_ok(tactus_instance_create(of, &given, &made));
  return Instance(made);
}

tactus_planner_options planner(std::uint64_t expansions = 50) {
  tactus_planner_options made{};
  expect_ok(tactus_planner_options_init(&made, sizeof made));
  made.budget_seconds = shelf::infinity;
  made.budget_expansions = expansions;
  return made;
}

tactus_evaluation evaluate(const Instance& of, const tactus_planner_options& by) {
  tactus_evaluation found{};
  expect_ok(tactus_evaluation_init(&found, sizeof found));
  expect_ok(tactus_instance_evaluate(of.get(), &by, &found));
  return found;
}

std::string exported(const Instance& of, int32_t format) {
  std::size_t count = 0;
  expect_ok(tactus_instance_export(of.get(), format, nullptr, 0, &count));
  std::string text(count, 'x');
  expect_ok(tactus_instance_export(of.get(), format, text.data(), count, &count));
  EXPECT_EQ(text.back(), '\0');
  text.pop_back();
  return text;
}

TEST(Instance, HasTheSizeThatWasAskedFor) {
  std::size_t poses = 0, configurations = 0, motions = 0;
  expect_ok(tactus_instance_size(instance().get(), &poses, &configurations, &motions));
  EXPECT_EQ(poses, 6u);
  EXPECT_LE(configurations, 20u);
  EXPECT_GT(motions, 6u);
}

TEST(Instance, OptionsOutOfRangeAreRefused) {
  const auto refused = [](const tactus_instance_options& given, const char* word) {
    tactus_instance* made = reinterpret_cast<tactus_instance*>(8);
    expect_refused(tactus_instance_create(shelf::scenario(), &given, &made), TACTUS_INVALID_ARGUMENT, word);
    EXPECT_EQ(made, nullptr);
  };
  tactus_instance_options given = options();
  given.poses = 0;
  refused(given, "poses");
  given = options(), given.configurations = 2;
  refused(given, "configurations");
  given = options(), given.discount = shelf::nan;
  refused(given, "discount");
}

TEST(Instance, APolicyCostsAtLeastTheOptimum) {
  const Instance is = instance();
  const tactus_evaluation found = evaluate(is, planner());
  double optimum = 0.0;
  std::uint64_t beliefs = 0;
  expect_ok(tactus_instance_optimum(is.get(), 1'000'000, &optimum, &beliefs));
  EXPECT_NEAR(found.inserted, 1.0, 1e-9);
  EXPECT_GE(found.expected_cost, optimum - 1e-9);
  EXPECT_GE(found.worst_cost, found.expected_cost);
  EXPECT_GT(optimum, 0.0);
  EXPECT_GT(beliefs, 0u);
  EXPECT_GT(found.plans, 0u);
  EXPECT_EQ(evaluate(is, planner()).expected_cost, found.expected_cost) << "same options, same policy";
}

TEST(Instance, TheOptimumIsAtLeastWhatPairsCostAndTheseWhatWhoKnowsPays) {
  const Instance is = instance();
  double informed = 0.0, pairs = 0.0, optimum = 0.0;
  std::uint64_t beliefs = 0;
  expect_ok(tactus_instance_bounds(is.get(), 1'000'000, &informed, &pairs));
  expect_ok(tactus_instance_optimum(is.get(), 1'000'000, &optimum, &beliefs));
  EXPECT_GT(informed, 0.0);
  EXPECT_GT(pairs, informed + 1e-9) << "there are pairs that have to be told apart";
  EXPECT_LE(pairs, optimum + 1e-9);
  double same = 0.0, not_solved = 0.0;
  expect_ok(tactus_instance_bounds(is.get(), 1, &same, &not_solved));
  EXPECT_EQ(same, informed);
  EXPECT_TRUE(std::isnan(not_solved));
  expect_refused(tactus_instance_bounds(is.get(), 1, &same, nullptr), TACTUS_INVALID_ARGUMENT, "pairs");
}

TEST(Instance, AnOptimumOfTooManyBeliefsIsNotANumber) {
  double optimum = 0.0;
  std::uint64_t beliefs = 0;
  expect_ok(tactus_instance_optimum(instance().get(), 1, &optimum, &beliefs));
  EXPECT_TRUE(std::isnan(optimum));
}

TEST(Instance, IsExportedAsText) {
  const Instance is = instance();
  const std::string pomdpx = exported(is, TACTUS_FORMAT_POMDPX), pomdp = exported(is, TACTUS_FORMAT_POMDP);
  EXPECT_NE(pomdpx.find("<Discount>0.999"), std::string::npos);
  EXPECT_NE(pomdpx.find("small_shelf"), std::string::npos);
  EXPECT_NE(pomdp.find("discount: 0.999"), std::string::npos);
  std::size_t count = 0;
  expect_refused(tactus_instance_export(is.get(), 0, nullptr, 0, &count), TACTUS_INVALID_ARGUMENT, "format");
  char small[4];
  expect_refused(tactus_instance_export(is.get(), TACTUS_FORMAT_POMDP, small, sizeof small, &count),
                 TACTUS_BUFFER_TOO_SMALL, "text");
  EXPECT_EQ(count, pomdp.size() + 1);
}

TEST(Instance, OutlivesTheScenariosHandle) {
  shelf::Scenario scenario = shelf::load();
  const Instance is = instance(scenario.get());
  scenario.reset();
  EXPECT_GT(evaluate(is, planner()).expected_cost, 0.0);
}

TEST(Instance, NullIsNamed) {
  tactus_evaluation found{};
  found.struct_size = sizeof found;
  expect_refused(tactus_instance_evaluate(nullptr, nullptr, &found), TACTUS_INVALID_ARGUMENT, "instance");
  expect_refused(tactus_instance_create(nullptr, nullptr, nullptr), TACTUS_INVALID_ARGUMENT, "instance");
  double optimum = 0.0;
  expect_refused(tactus_instance_optimum(instance().get(), 1, &optimum, nullptr), TACTUS_INVALID_ARGUMENT, "beliefs");
}

}  // namespace
