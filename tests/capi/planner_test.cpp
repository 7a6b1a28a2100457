// SPDX-License-Identifier: BSD-3-Clause
#include <atomic>
#include <chrono>
#include <thread>

#include "capi/shelf.hpp"

namespace {

using shelf::expect_ok;
using shelf::expect_refused;

tactus_statistics statistics(const shelf::Planner& planner) {
  tactus_statistics made{};
  expect_ok(tactus_statistics_init(&made, sizeof made));
  expect_ok(tactus_planner_statistics(planner.get(), &made));
  return made;
}

tactus_planner_options options() {
  tactus_planner_options made{};
  expect_ok(tactus_planner_options_init(&made, sizeof made));
  expect_ok(tactus_scenario_planner_options(shelf::scenario(), &made));
  return made;
}

TEST(Planner, SolversHaveNames) {
  for (tactus_solver solver = TACTUS_SOLVER_RTDP_BEL; solver <= TACTUS_SOLVER_RATE; ++solver) {
    tactus_solver found = 0;
    expect_ok(tactus_solver_from_name(tactus_solver_name(solver), &found));
    EXPECT_EQ(found, solver);
  }
  tactus_solver found = 0;
  expect_refused(tactus_solver_from_name("guess", &found), TACTUS_INVALID_ARGUMENT, "'guess'");
  EXPECT_STREQ(tactus_solver_name(0), "unknown");
}

TEST(Planner, CreateRefusesOptionsOutOfRange) {
  const auto refused = [](const tactus_planner_options& given, const char* word) {
    tactus_planner* made = reinterpret_cast<tactus_planner*>(8);
    expect_refused(tactus_planner_create(shelf::scenario(), &given, &made), TACTUS_INVALID_ARGUMENT, word);
    EXPECT_EQ(made, nullptr);
  };
  tactus_planner_options given = options();
  given.budget_seconds = shelf::nan;
  refused(given, "budget_seconds");
  given = options(), given.epsilon = shelf::nan;
  refused(given, "epsilon");
  given = options(), given.horizon = 0;
  refused(given, "horizon");
  given = options(), given.solver = 0;
  refused(given, "solver");
}

TEST(Planner, FieldsThatTheSizeDoesNotCoverAreTheScenarios) {
  tactus_planner_options given = options();
  given.struct_size = 24;  // up to the budgets
  given.epsilon = shelf::nan;
  given.horizon = -1;
  tactus_planner* made = nullptr;
  expect_ok(tactus_planner_create(shelf::scenario(), &given, &made));
  tactus_planner_destroy(made);
}

TEST(Planner, SameSeedAndExpansionsGiveTheSameAction) {
  std::uint64_t ids[2];
  for (std::uint64_t& id : ids) {
    const shelf::Action action = shelf::query(shelf::planner(), shelf::belief());
    tactus_action_properties is{};
    is.struct_size = sizeof is;
    expect_ok(tactus_action_info(action.get(), &is));
    id = is.id;
  }
  EXPECT_EQ(ids[0], ids[1]);
}

TEST(Planner, CountsWhatItDid) {
  const shelf::Planner planner = shelf::planner();
  EXPECT_EQ(statistics(planner).total_calls, 0u);
  shelf::query(planner, shelf::belief());
  const tactus_statistics took = statistics(planner);
  EXPECT_EQ(took.total_calls, 1u);
  EXPECT_GT(took.expansions, 0u);
  EXPECT_GT(took.seconds, 0.0);
  EXPECT_EQ(took.from_policy, 0);
}

std::size_t alternative_count(const shelf::Planner& planner) {
  std::size_t count = 99;
  expect_ok(tactus_planner_alternative_count(planner.get(), &count));
  return count;
}

tactus_alternative alternative(const shelf::Planner& planner, std::size_t index) {
  tactus_alternative made{};
  expect_ok(tactus_alternative_init(&made, sizeof made));
  expect_ok(tactus_planner_alternative(planner.get(), index, &made));
  return made;
}

std::vector<double> outcomes(const shelf::Planner& planner, std::size_t index) {
  std::size_t count = 0;
  expect_ok(tactus_planner_alternative_outcomes(planner.get(), index, nullptr, 0, &count));
  std::vector<double> rows(7 * count);
  expect_ok(tactus_planner_alternative_outcomes(planner.get(), index, rows.data(), count, &count));
  return rows;
}

TEST(Planner, VerdictsHaveNames) {
  EXPECT_STREQ(tactus_verdict_name(TACTUS_VERDICT_CHOSEN), "chosen");
  EXPECT_STREQ(tactus_verdict_name(TACTUS_VERDICT_PASSED_OVER), "passed over");
  EXPECT_STREQ(tactus_verdict_name(TACTUS_VERDICT_SET_ASIDE), "set aside");
  EXPECT_STREQ(tactus_verdict_name(TACTUS_VERDICT_UNREACHABLE), "unreachable");
  EXPECT_STREQ(tactus_verdict_name(4), "unknown");
}

shelf::Planner searching() {
  tactus_planner_options given = options();
  given.solver = TACTUS_SOLVER_RTDP_BEL;
  given.budget_seconds = shelf::infinity;
  given.budget_expansions = 2;
  tactus_planner* made = nullptr;
  expect_ok(tactus_planner_create(shelf::scenario(), &given, &made));
  return shelf::Planner(made);
}

TEST(Planner, TellsWhatItWeighedBestFirst) {
  const shelf::Planner planner = searching();
  EXPECT_EQ(alternative_count(planner), 0u);
  const shelf::Action action = shelf::query(planner, shelf::belief());
  tactus_action_properties is{};
  expect_ok(tactus_action_properties_init(&is, sizeof is));
  expect_ok(tactus_action_info(action.get(), &is));
  ASSERT_GT(alternative_count(planner), 1u);
  int chosen = 0;
  for (std::size_t i = 0; i < alternative_count(planner); ++i) {
    const tactus_alternative weighed = alternative(planner, i);
    EXPECT_EQ(weighed.struct_size, sizeof weighed);
    if (i > 0) {
      EXPECT_LE(alternative(planner, i - 1).value, weighed.value);
    }
    if (weighed.verdict != TACTUS_VERDICT_CHOSEN) continue;
    ++chosen;
    EXPECT_EQ(weighed.kind, is.kind);
    EXPECT_EQ(weighed.value, is.expected_cost);
    EXPECT_EQ(weighed.contact_probability, is.contact_probability);
  }
  EXPECT_EQ(chosen, 1);
}

TEST(Planner, TellsWhatMayComeOfWhatItWeighed) {
  const shelf::Planner planner = shelf::planner();
  shelf::query(planner, shelf::belief());
  for (std::size_t i = 0; i < alternative_count(planner); ++i) {
    const tactus_alternative weighed = alternative(planner, i);
    const std::vector<double> rows = outcomes(planner, i);
    ASSERT_EQ(rows.size(), 7 * weighed.outcomes);
    double total = 0.0, cost = 0.0, contact = 0.0, goal = 0.0;
    for (auto row = rows.begin(); row != rows.end(); row += 7) {
      total += row[0];
      cost += row[0] * row[1];
      contact += row[0] * row[2];
      goal += row[0] * row[3];
      if (row[2] == 0.0) {
        EXPECT_TRUE(std::equal(row + 4, row + 7, weighed.end)) << "nothing touched: the tool is at the end";
      }
    }
    EXPECT_NEAR(total, 1.0, 1e-9);
    EXPECT_NEAR(cost, weighed.motion_cost, 1e-9);
    EXPECT_NEAR(contact, weighed.contact_probability, 1e-9);
    EXPECT_NEAR(goal, weighed.goal_probability, 1e-9);
  }
}

TEST(Planner, AlternativesOutOfReachAreRefused) {
  const shelf::Planner planner = shelf::planner();
  tactus_alternative made{};
  expect_ok(tactus_alternative_init(&made, sizeof made));
  std::size_t count = 0;
  expect_refused(tactus_planner_alternative(planner.get(), 0, &made), TACTUS_INVALID_ARGUMENT, "index");
  shelf::query(planner, shelf::belief());
  const std::size_t beyond = alternative_count(planner);
  expect_refused(tactus_planner_alternative(planner.get(), beyond, &made), TACTUS_INVALID_ARGUMENT, "index");
  expect_refused(tactus_planner_alternative_outcomes(planner.get(), beyond, nullptr, 0, &count),
                 TACTUS_INVALID_ARGUMENT, "index");
  double row[7];
  expect_refused(tactus_planner_alternative_outcomes(planner.get(), 0, row, 0, &count), TACTUS_BUFFER_TOO_SMALL,
                 "outcomes");
  expect_refused(tactus_planner_alternative_count(nullptr, &count), TACTUS_INVALID_ARGUMENT, "planner");
  made.struct_size = 0;
  expect_refused(tactus_planner_alternative(planner.get(), 0, &made), TACTUS_STRUCT_SIZE, "alternative");
}

TEST(Planner, ABeliefOfAnotherScenarioIsRefused) {
  const shelf::Scenario other = shelf::load();
  tactus_action* action = reinterpret_cast<tactus_action*>(8);
  expect_refused(tactus_planner_query_action(shelf::planner().get(), shelf::belief(other.get()).get(), &action),
                 TACTUS_WRONG_SCENARIO, "belief");
  EXPECT_EQ(action, nullptr);
}

TEST(Planner, EverythingOutlivesTheScenariosHandle) {
  shelf::Scenario scenario = shelf::load();
  const shelf::Belief belief = shelf::belief(scenario.get());
  shelf::Planner planner = shelf::planner(scenario.get());
  const shelf::World world = shelf::world(1, scenario.get());
  scenario.reset();
  const shelf::Action action = shelf::query(planner, belief);
  planner.reset();
  std::vector<double> q(6);
  tactus_observation seen = shelf::observation(q);
  expect_ok(tactus_world_execute(world.get(), action.get(), &seen));
  expect_ok(tactus_belief_step(belief.get(), action.get(), &seen));
}

TEST(Planner, AQueryThatRunsMakesPlannerAndBeliefBusyAndCanBeCancelled) {
  const shelf::Belief belief = shelf::belief();
  const shelf::Planner planner = shelf::planner(shelf::scenario(), UINT64_MAX);  // it would go on for ever
  std::atomic<bool> done{false};
  tactus_status status = TACTUS_INTERNAL;
  tactus_action* action = nullptr;
  std::thread running([&] {
    status = tactus_planner_query_action(planner.get(), belief.get(), &action);
    done = true;
  });
  tactus_statistics ignored{};
  ignored.struct_size = sizeof ignored;
  while (!done && tactus_planner_statistics(planner.get(), &ignored) == TACTUS_OK) std::this_thread::yield();
  int32_t goal = 0;
  tactus_status on_belief = TACTUS_OK;
  while (!done && (on_belief = tactus_belief_is_goal(belief.get(), &goal)) == TACTUS_OK) std::this_thread::yield();
  EXPECT_FALSE(done);
  expect_refused(on_belief, TACTUS_BUSY, "belief");
  while (!done) {
    expect_ok(tactus_planner_cancel(planner.get()));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  running.join();
  tactus_action_destroy(action);
  EXPECT_TRUE(status == TACTUS_OK || status == TACTUS_CANCELLED) << tactus_status_name(status);
}

TEST(Planner, NullIsNamed) {
  tactus_action* action = nullptr;
  expect_refused(tactus_planner_query_action(nullptr, nullptr, &action), TACTUS_INVALID_ARGUMENT, "planner");
  expect_refused(tactus_planner_query_action(shelf::planner().get(), nullptr, &action), TACTUS_INVALID_ARGUMENT,
                 "belief");
  expect_refused(tactus_planner_query_action(nullptr, nullptr, nullptr), TACTUS_INVALID_ARGUMENT, "action");
  expect_refused(tactus_planner_cancel(nullptr), TACTUS_INVALID_ARGUMENT, "planner");
}

TEST(Planner, AHorizonOutOfRangeIsToldTheRange) {
  for (const std::int64_t horizon : {std::int64_t{0}, std::int64_t{1} << 33}) {
    tactus_planner_options given = options();
    given.horizon = horizon;
    tactus_planner* made = nullptr;
    expect_refused(tactus_planner_create(shelf::scenario(), &given, &made), TACTUS_INVALID_ARGUMENT,
                   "options.horizon: found " + std::to_string(horizon) + ", expected 1 to 2147483647");
  }
}

TEST(Planner, ValuesAreOfTheBeliefThatTheLastActionWasFor) {
  const shelf::Planner planner = shelf::planner();
  EXPECT_EQ(statistics(planner).value, 0.0);
  const shelf::Action action = shelf::query(planner, shelf::belief());
  const tactus_statistics after = statistics(planner);
  EXPECT_GT(after.value, 0.0);
  EXPECT_GE(after.value, after.lower_bound);
}

}  // namespace
