// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <limits>
#include <map>
#include <set>

#include "action/insertion.hpp"
#include "belief/plain_world.hpp"
#include "solver/pose_problem.hpp"
#include "solver/voxel_problem.hpp"

/// What holds of every belief as the solver sees it, on voxels with either likelihood and on poses: of its choices,
/// what may come of them, and the beliefs that follow.
namespace tactus::test {
namespace {

using belief::Kind;
using solver::BeliefState;
using solver::BeliefStatePtr;
using solver::Choice;
using solver::Outcome;
using solver::SecondValue;
using support::Rng;

constexpr std::size_t trusted =
    10;  // poses from which the voxels' shares are taken; below, the paper's equations speak
constexpr std::size_t delta = 2400;  // voxels at which poses take over

const std::shared_ptr<const action::Task>& task() {
  static const auto made = small_task();
  return made;
}

std::shared_ptr<const belief::Model> model(Kind kind) {
  return small_model(task(), kind, {.delta = delta, .most_cells = 300});
}

/// A belief of the solver, and the poses that it rests on as the test keeps count of them.
struct Tracked {
  BeliefStatePtr state;
  std::vector<Pose> poses;
  bool on_poses = false;  ///< else on voxels
};

/// A belief after some random actions in a random world.
belief::Belief random_belief(Kind kind, Rng& rng) {
  const PlainWorld world(*task(), task()->scene().prior.sample(rng));
  belief::Belief belief(model(kind), task()->scene().start);
  action::ActionLibrary library(*task());
  for (std::uint64_t i = rng.below(4); i > 0; --i) {
    const action::Action action = random_action(*task(), library, belief.configuration(), rng);
    belief.step(action, world.execute(action));
  }
  return belief;
}

/// Of a belief of cells.
std::vector<Pose> random_poses(Rng& rng) { return belief::poses_of(random_belief(Kind::particles, rng).draw(40, rng)); }

/// So many poses, and a robot that has met something or nothing.
BeliefStatePtr at(const JointVector& q, const std::vector<Pose>& poses, SecondValue second, bool nothing_met = false) {
  return std::make_shared<solver::PoseProblem>(task(), std::make_shared<action::ActionLibrary>(*task()),
                                               std::make_shared<solver::Predictions>(task(), poses), 10.0, 0.035,
                                               second, nothing_met)
      ->start(q);
}

std::vector<Choice> weighed_at_start(const std::vector<Pose>& poses, SecondValue second,
                                     const support::Deadline& deadline, bool nothing_met = false) {
  return at(task()->scene().start, poses, second, nothing_met)->choices(deadline);
}

Tracked on_poses(Rng& rng) {
  const belief::Belief belief = random_belief(Kind::particles, rng);
  const std::vector<Pose> poses = belief::poses_of(belief.draw(40, rng));
  auto problem =
      std::make_shared<solver::PoseProblem>(task(), std::make_shared<action::ActionLibrary>(*task()),
                                            std::make_shared<solver::Predictions>(task(), poses), belief.bits(), 0.035);
  return {problem->start(belief.configuration()), poses, true};
}

Tracked on_voxels(Rng& rng, bool calibrated) {
  for (;;) {
    const belief::Belief belief = random_belief(Kind::hierarchical, rng);
    if (belief.phase() != belief::Phase::voxels) continue;
    const std::vector<Pose> poses = calibrated ? belief::poses_of(belief.draw_feasible(80, rng)) : std::vector<Pose>{};
    auto problem = std::make_shared<solver::VoxelProblem>(
        belief.shared_model(), std::make_shared<action::ActionLibrary>(*task()), poses, 0.035);
    return {problem->start(belief.configuration(), belief.voxels()), poses, false};
  }
}

std::size_t first_contact(const action::Motion& motion, const Pose& pose) {
  return task()->target_contact().first_contact(motion.bodies, pose).value_or(motion.path.size());
}

std::vector<Pose> touched_at(const action::Motion& motion, const std::vector<Pose>& poses, const Outcome& outcome) {
  std::vector<Pose> group;
  for (const Pose& pose : poses)
    if (const std::size_t at = first_contact(motion, pose); at >= outcome.waypoint && at <= outcome.last)
      group.push_back(pose);
  return group;
}

Tracked successor(const Tracked& at, const Choice& choice, const Outcome& outcome) {
  return {at.state->successor(choice, outcome), touched_at(*choice.motion, at.poses, outcome), at.on_poses};
}

/// Calls `visit` for beliefs met on random walks from beliefs of every kind.
template <typename Visit>
void for_random_beliefs(std::uint64_t seed, int episodes, Visit&& visit) {
  Rng rng(seed);
  for (int episode = 0; episode < 3 * episodes; ++episode) {
    Tracked at = episode % 3 == 0 ? on_poses(rng) : on_voxels(rng, episode % 3 == 1);
    for (int depth = 0; depth < 3; ++depth) {
      const std::vector<Choice> choices = at.state->choices(support::Deadline::unlimited());
      ASSERT_TRUE(depth > 0 || !choices.empty());
      ASSERT_NO_FATAL_FAILURE(visit(at, choices, rng));
      if (choices.empty()) break;
      const Choice& choice = choices[rng.below(choices.size())];
      const Outcome& outcome = choice.outcomes[rng.below(choice.outcomes.size())];
      if (outcome.goal) break;
      at = successor(at, choice, outcome);
    }
  }
}

TEST(Choices, OutcomesAreADistributionOverAscendingWaypoints) {
  for_random_beliefs(1, 4, [](const Tracked&, const std::vector<Choice>& choices, Rng&) {
    for (const Choice& choice : choices) {
      double total = 0.0, contact = 0.0, cost = 0.0, bits = 0.0;
      std::size_t last = 0;
      for (const Outcome& outcome : choice.outcomes) {
        ASSERT_GT(outcome.waypoint, last);
        ASSERT_GE(outcome.last, outcome.waypoint);
        ASSERT_LE(outcome.last, choice.motion->path.size());
        ASSERT_TRUE(outcome.last < choice.motion->path.size() || outcome.waypoint == outcome.last);
        ASSERT_GT(outcome.probability, 0.0);
        ASSERT_LE(outcome.probability, 1.0);
        last = outcome.last;
        total += outcome.probability;
        contact += outcome.waypoint < choice.motion->path.size() ? outcome.probability : 0.0;
        cost += outcome.probability * outcome.cost;
        bits += outcome.probability * std::log2(1.0 / outcome.probability);
      }
      ASSERT_NEAR(total, 1.0, 1e-9);
      ASSERT_NEAR(choice.contact_probability(), contact, 1e-12);
      ASSERT_NEAR(choice.expected_cost(), cost, 1e-12);
      ASSERT_NEAR(choice.information(), bits, 1e-12);
    }
  });
}

TEST(Choices, AreTheFirstOfAllOnceSomebodyCancels) {
  const std::atomic<bool> cancelled{true};
  const support::Deadline at_once(std::numeric_limits<double>::infinity(), UINT64_MAX, &cancelled);
  for_random_beliefs(11, 3, [&](const Tracked& at, const std::vector<Choice>& all, Rng&) {
    const std::vector<Choice> some = at.state->choices(at_once);
    ASSERT_EQ(some.empty(), all.empty());
    for (std::size_t i = 0; i < some.size(); ++i) ASSERT_EQ(some[i].motion, all[i].motion);
  });
  Rng rng(12);
  for (const SecondValue second : {SecondValue::greedy, SecondValue::upper_bound})
    EXPECT_EQ(weighed_at_start(random_poses(rng), second, at_once).size(), 1u);
}

/// Three of each.
TEST(Choices, AreSomeOfEveryKindWhereThereIsNoTime) {
  constexpr std::size_t kinds = 3, few = 3;
  const support::Deadline no_time(0.0, UINT64_MAX);
  Rng rng(14);
  for (int i = 0; i < 3; ++i) {
    const std::vector<Pose> poses = random_poses(rng);
    for (const bool nothing_met : {true, false}) {
      const auto counts = [&](SecondValue second, const support::Deadline& deadline) {
        std::array<std::size_t, kinds> of_kind{};
        for (const Choice& choice : weighed_at_start(poses, second, deadline, nothing_met))
          ++of_kind[choice.motion->kind == action::Kind::insertion ? 0 : choice.motion->anchored ? 1 : 2];
        return of_kind;
      };
      const auto all = counts(SecondValue::upper_bound, support::Deadline::unlimited());
      const auto some = counts(SecondValue::upper_bound, no_time);
      for (std::size_t kind = 0; kind < kinds; ++kind) {
        EXPECT_LE(some[kind], all[kind]);
        EXPECT_GE(some[kind], std::min(all[kind], (few + 1) / 2));  // some of those weighed tell nothing
      }
      EXPECT_LE(some[0], few);
      EXPECT_LE(some[1], few);
      EXPECT_GT(all[1], few);
      EXPECT_EQ(counts(SecondValue::greedy, no_time), counts(SecondValue::greedy, support::Deadline::unlimited()));
    }
  }
}

TEST(Choices, CostTheWayToTheirStartAndAlongThem) {
  for_random_beliefs(2, 2, [](const Tracked& at, const std::vector<Choice>& choices, Rng&) {
    const Pose tool = task()->base_from_tool(at.state->configuration());
    for (const Choice& choice : choices) {
      const motion::JointPath& path = choice.motion->path;
      const Pose start = task()->base_from_tool(path.front());
      if (!choice.motion->anchored) {
        ASSERT_EQ(path.front(), at.state->configuration());
      }
      for (const Outcome& outcome : choice.outcomes) {
        const motion::JointPath part(path.begin(),
                                     path.begin() + std::ptrdiff_t(std::min(outcome.waypoint + 1, path.size())));
        const motion::ToolTravel along = motion::tool_travel(*task()->scene().robot, task()->scene().tool_link, part);
        const double straight = (start.translation() - tool.translation()).norm();
        const double least =
            0.005 + along.metres + 0.05 * along.radians + straight + 0.05 * geometry::angle_between(start, tool);
        ASSERT_GE(outcome.cost, least - 1e-9);
        ASSERT_LE(outcome.cost, least + (std::sqrt(2.0) - 1.0) * straight + 1e-9) << "over the plane, no farther";
      }
    }
  });
}

TEST(Choices, AreSplitByWhereEachPoseIsFirstTouched) {
  std::array<int, 2> checked{};
  for_random_beliefs(3, 8, [&](const Tracked& at, const std::vector<Choice>& choices, Rng&) {
    if (!at.on_poses && at.poses.size() < trusted) return;
    for (const Choice& choice : choices) {
      const auto total = static_cast<double>(at.poses.size());
      std::size_t touched = 0;
      for (const Outcome& outcome : choice.outcomes)
        if (outcome.waypoint < choice.motion->path.size())
          touched += touched_at(*choice.motion, at.poses, outcome).size();
      const std::size_t least = at.on_poses ? solver::least_group(touched, 3) : 1;
      for (std::size_t z = 0; z < choice.outcomes.size(); ++z) {
        const Outcome& outcome = choice.outcomes[z];
        const std::size_t held = touched_at(*choice.motion, at.poses, outcome).size();
        ASSERT_NEAR(outcome.probability, static_cast<double>(held) / total, 1e-9) << outcome.waypoint;
        const bool has_next = z + 1 < choice.outcomes.size();
        const bool next_is_untouched = has_next && choice.outcomes[z + 1].last == choice.motion->path.size();
        if (has_next && !next_is_untouched) {
          ASSERT_GE(held, least);
        }
      }
      ++checked[at.on_poses];
    }
  });
  EXPECT_GT(std::min(checked[0], checked[1]), 100);
}

TEST(Choices, FirstContactsAreThoseOfThePlainOracle) {
  const double margin = task()->options().contact_margin;
  const reference::Shape socket_shape{{socket()}, {}};
  std::vector<reference::Part> parts{{task()->scene().tool_link, {tool_pieces(), {}}}};
  const auto& links = task()->scene().robot->links;
  for (std::size_t i = 0; i < links.size(); ++i)
    if (!links[i].shapes.empty()) parts.push_back({static_cast<int>(i), {links[i].shapes, {}}});
  int touched = 0;
  for_random_beliefs(4, 3, [&](const Tracked& at, const std::vector<Choice>& choices, Rng& rng) {
    if (at.poses.empty() || choices.empty()) return;
    for (int i = 0; i < 4; ++i) {
      const action::Motion& motion = *choices[rng.below(choices.size())].motion;
      const reference::Track track = reference::track(*task()->scene().robot, parts, motion.path);
      for (int k = 0; k < 4; ++k) {
        const Pose& pose = at.poses[rng.below(at.poses.size())];
        const auto plain = reference::first_contact(track, {socket_shape, pose}, margin);
        ASSERT_EQ(first_contact(motion, pose), plain.value_or(motion.path.size()));
        touched += plain.has_value();
      }
    }
  });
  EXPECT_GT(touched, 20);
}

/// With bounds, once something was met: what may be met on the way to where a motion begins is an outcome too.
TEST(Choices, AsTheyTurnOutAreSplitByWhereEachPoseIsFirstTouchedOnAllTheWay) {
  const action::ActionLibrary library(*task());
  Rng rng(18);
  int checked = 0, met_on_the_way = 0;
  for (int i = 0; i < 10; ++i) {
    const belief::Belief belief = random_belief(Kind::particles, rng);
    const JointVector& q = belief.configuration();
    const std::vector<Pose> poses = belief::poses_of(belief.draw(40, rng));
    const BeliefStatePtr state = at(q, poses, SecondValue::upper_bound);
    for (const Choice& choice : state->choices(support::Deadline::unlimited())) {
      const auto made = library.realise(q, *choice.motion, support::Deadline::unlimited());
      if (!made || made->lead == 0 || rng.below(3) > 0) continue;
      const Choice whole = state->realised(choice, *made, 0.0, support::Deadline::unlimited());
      ASSERT_EQ(whole.motion->path, made->path);
      ASSERT_EQ(whole.motion->base_from_start.matrix(), choice.motion->base_from_start.matrix());
      double total = 0.0;
      for (const Outcome& outcome : whole.outcomes) {
        const auto held = static_cast<double>(touched_at(*whole.motion, poses, outcome).size());
        ASSERT_NEAR(outcome.probability, held / static_cast<double>(poses.size()), 1e-9);
        const std::size_t reached = std::min(outcome.waypoint, made->path.size() - 1);
        ASSERT_NEAR(outcome.cost, 0.005 + whole.motion->cost_to[reached], 1e-9);
        met_on_the_way += outcome.waypoint <= made->lead;
        total += outcome.probability;
      }
      ASSERT_NEAR(total, 1.0, 1e-9);
      ++checked;
    }
  }
  EXPECT_GT(checked, 20);
  EXPECT_GT(met_on_the_way, 0);
}

/// Before, and by solvers without bounds, it is charged for alone.
TEST(Choices, AsTheyTurnOutCostMoreOfAllOutcomesWhereWaysAreNotWeighed) {
  constexpr double more = 0.25;
  Rng rng(19);
  const std::vector<Pose> poses = random_poses(rng);
  for (const BeliefStatePtr& state : {at(task()->scene().start, poses, SecondValue::greedy),
                                      at(task()->scene().start, poses, SecondValue::upper_bound, true)}) {
    const Choice choice = state->choices(support::Deadline::unlimited()).back();
    action::Action made;
    made.lead = 3;
    const Choice charged = state->realised(choice, made, more, support::Deadline::unlimited());
    ASSERT_EQ(charged.motion, choice.motion);
    ASSERT_EQ(charged.outcomes.size(), choice.outcomes.size());
    for (std::size_t z = 0; z < choice.outcomes.size(); ++z)
      EXPECT_DOUBLE_EQ(charged.outcomes[z].cost, choice.outcomes[z].cost + more);
  }
}

TEST(Successors, HoldEachPoseOnceAndStandAtTheLastFreeWaypoint) {
  for_random_beliefs(5, 4, [](const Tracked& at, const std::vector<Choice>& choices, Rng& rng) {
    for (int i = 0; i < 10 && !choices.empty(); ++i) {
      const Choice& choice = choices[rng.below(choices.size())];
      const motion::JointPath& path = choice.motion->path;
      const std::size_t before = at.state->support_size();
      std::size_t held = 0;
      std::set<std::uint64_t> hashes;
      for (const Outcome& outcome : choice.outcomes) {
        const Tracked next = successor(at, choice, outcome);
        const std::size_t left = next.state->support_size();
        ASSERT_EQ(next.state->configuration(), path[std::min(outcome.waypoint, path.size()) - 1]);
        ASSERT_EQ(next.state->hash(), at.state->successor(choice, outcome)->hash());
        hashes.insert(next.state->hash().low);
        ASSERT_LE(left, before);
        if (!at.on_poses) continue;
        ASSERT_EQ(left, next.poses.size());
        ASSERT_NEAR(static_cast<double>(left), outcome.probability * static_cast<double>(before), 1e-9);
        held += left;
      }
      ASSERT_EQ(held, at.on_poses ? before : 0);
      ASSERT_EQ(hashes.size(), choice.outcomes.size());
    }
  });
}

TEST(Successors, NeedNothingMoreJustWhereTheOutcomeIsTheGoal) {
  std::array<int, 2> goals{};
  for_random_beliefs(16, 20, [&](const Tracked& at, const std::vector<Choice>& choices, Rng&) {
    for (const Choice& choice : choices)
      for (const Outcome& outcome : choice.outcomes) {
        const action::Motion& motion = *choice.motion;
        const bool free = outcome.waypoint == motion.path.size();
        if (outcome.goal) {
          ASSERT_EQ(outcome.heuristic, solver::Values{});
        }
        if (at.on_poses) {
          const std::vector<Pose> left = touched_at(motion, at.poses, outcome);
          const bool seated = std::all_of(left.begin(), left.end(), [&](const Pose& pose) {
            return task()->scene().is_seated(task()->base_from_tool(motion.path.back()), pose);
          });
          ASSERT_EQ(outcome.goal, free && motion.kind == action::Kind::insertion && seated);
        } else if (free) {
          ASSERT_EQ(outcome.goal, at.state->successor(choice, outcome)->support_size() <= delta);
        }
        goals[at.on_poses] += free && outcome.goal;
      }
  });
  EXPECT_GT(goals[0], 0) << "voxels";
  EXPECT_GT(goals[1], 0) << "poses";
}

TEST(Heuristics, AreThoseOfTheSuccessorsAndInOrder) {
  for_random_beliefs(7, 3, [](const Tracked& at, const std::vector<Choice>& choices, Rng& rng) {
    const solver::Values here = at.state->heuristic();
    ASSERT_GE(here[0], 0.0);
    ASSERT_LE(here[0], here[1]);
    for (const Choice& choice : choices)
      for (const Outcome& outcome : choice.outcomes) {
        ASSERT_GE(outcome.heuristic[0], 0.0);
        ASSERT_LE(outcome.heuristic[0], outcome.heuristic[1]);
        if (!at.on_poses || outcome.goal || rng.below(4) > 0) continue;
        const solver::Values there = at.state->successor(choice, outcome)->heuristic();
        ASSERT_NEAR(outcome.heuristic[0], there[0], 1e-9);
        ASSERT_NEAR(outcome.heuristic[1], there[1], 1e-9);
      }
  });
}

TEST(Heuristics, NeverExceedTheMeanCostOfInsertingAtEachPose) {
  action::ActionLibrary library(*task());
  for_random_beliefs(8, 3, [&](const Tracked& at, const std::vector<Choice>&, Rng&) {
    if (at.poses.empty()) return;
    double sum = 0.0;
    for (const Pose& pose : at.poses) {
      const auto motion = action::insertion(*task(), pose, at.state->configuration());
      ASSERT_TRUE(motion);
      const auto action = library.realise(at.state->configuration(), *motion, support::Deadline::unlimited());
      ASSERT_TRUE(action);
      sum += action->full_cost;
    }
    ASSERT_LE(at.state->heuristic()[0], sum / static_cast<double>(at.poses.size()) + 1e-9);
  });
}

/// The seat that counts is the nearest within tolerance, not the exact one.
TEST(Heuristics, AdmissibleIsAtMostTheCostOfAnAttemptThatSeatsEveryPose) {
  Rng rng(3);
  std::vector<Pose> poses;
  for (int i = 0; i < 30; ++i) {
    PoseVector v = task()->scene().prior.centre;
    v[1] += rng.uniform(-1.5e-4, 1.5e-4), v[2] += rng.uniform(-1.5e-4, 1.5e-4), v[3] += rng.uniform(-0.012, 0.012);
    poses.push_back(geometry::pose_from(v));
  }
  auto problem =
      std::make_shared<solver::PoseProblem>(task(), std::make_shared<action::ActionLibrary>(*task()),
                                            std::make_shared<solver::Predictions>(task(), poses), 5.0, 0.035);
  int attempts = 0;
  JointVector q = task()->scene().start;
  for (int round = 0; round < 2; ++round) {
    const auto state = problem->start(q);
    for (const solver::Choice& choice : state->choices(support::Deadline::unlimited())) {
      if (!std::all_of(choice.outcomes.begin(), choice.outcomes.end(), [](const auto& o) { return o.goal; })) continue;
      ++attempts;
      EXPECT_LE(state->heuristic()[0], choice.expected_cost());
      q = choice.motion->path.front();
    }
  }
  EXPECT_GT(attempts, 0);
}

}  // namespace
}  // namespace tactus::test
