// SPDX-License-Identifier: BSD-3-Clause
#include "solver/predictions.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "belief/small_task.hpp"

/// Poses told apart by where a motion first touches them.
namespace tactus::test {
namespace {

using solver::Group;
using solver::Predictions;
using support::Bitset;
using support::Rng;

constexpr std::size_t poses = 40;

const std::shared_ptr<const action::Task>& task() {
  static const auto made = small_task({.roll_width = 0.4, .position_width = 0.04});
  return made;
}

Predictions random_predictions(Rng& rng, double blur = 0.0) {
  std::vector<Pose> drawn;
  for (std::size_t i = 0; i < poses; ++i) drawn.push_back(task()->scene().prior.sample(rng));
  return {task(), drawn, blur};
}

Bitset random_members(Rng& rng) {
  Bitset members(poses);
  for (std::size_t i = 0; i < poses; ++i)
    if (rng.below(3) > 0) members.set(i);
  members.set(rng.below(poses));
  return members;
}

/// Anchored: none that grazes.
action::MotionPtr motion_of(const action::Action& made, bool anchored = false) {
  action::Motion motion;
  motion.anchored = anchored;
  motion.path = made.path;
  return action::finished(*task(), motion);
}

std::size_t first_contact(const action::Motion& motion, const Pose& pose) {
  return task()->target_contact().first_contact(motion.bodies, pose).value_or(motion.path.size());
}

/// Calls `visit(predictions, motion, members, least, groups)` for random ones.
template <typename Visit>
void for_random_splits(std::uint64_t seed, Visit&& visit) {
  Rng rng(seed);
  action::ActionLibrary library(*task());
  for (int round = 0; round < 5; ++round) {
    Predictions predictions = random_predictions(rng);
    for (int i = 0; i < 12; ++i) {
      const action::MotionPtr motion = motion_of(random_action(*task(), library, task()->scene().start, rng));
      const Bitset members = random_members(rng);
      const std::size_t least = 1 + rng.below(10);
      ASSERT_NO_FATAL_FAILURE(visit(predictions, motion, members, least, predictions.split(motion, members, least)));
    }
  }
}

TEST(Split, PartitionsTheMembersByAscendingFirstContacts) {
  for_random_splits(1, [](const Predictions& predictions, const action::MotionPtr& motion, const Bitset& members,
                          std::size_t, const std::vector<Group>& groups) {
    Bitset seen(poses);
    std::size_t after = 0;
    for (const Group& group : groups) {
      ASSERT_GE(group.first, after);
      ASSERT_GE(group.last, group.first);
      after = group.last + 1;
      ASSERT_TRUE(std::is_sorted(group.poses.begin(), group.poses.end()));
      for (const std::size_t pose : group.poses) {
        const std::size_t at = first_contact(*motion, predictions.poses()[pose]);
        ASSERT_TRUE(at >= group.first && at <= group.last);
        ASSERT_TRUE(members.test(pose) && !seen.test(pose));
        seen.set(pose);
      }
    }
    ASSERT_EQ(seen.count(), members.count());
  });
}

TEST(Split, PutsFewTogetherButNeverWithThoseThatAreNotTouched) {
  int together = 0;
  for_random_splits(2, [&](const Predictions&, const action::MotionPtr& motion, const Bitset&, std::size_t least,
                           const std::vector<Group>& groups) {
    const std::size_t untouched = motion->path.size();
    for (std::size_t i = 0; i < groups.size(); ++i) {
      ASSERT_FALSE(groups[i].poses.empty());
      ASSERT_TRUE(groups[i].last < untouched || groups[i].first == untouched);
      const bool is_last_touched = i + 1 == groups.size() || groups[i + 1].first == untouched;
      if (groups[i].first < untouched && !is_last_touched) {
        ASSERT_GE(groups[i].poses.size(), least);
      }
      together += groups[i].last > groups[i].first;
    }
  });
  EXPECT_GT(together, 20);
}

TEST(Split, IsNoCoarserThanItNeedBe) {
  for_random_splits(3, [](Predictions& predictions, const action::MotionPtr& motion, const Bitset& members,
                          std::size_t least, const std::vector<Group>& groups) {
    for (const Group& group : groups) {
      const Bitset last = predictions.subset(motion, members, group.last, group.last);
      ASSERT_FALSE(last.none());
      ASSERT_TRUE(group.last == group.first || group.poses.size() - last.count() < least);
    }
    for (const Group& group : predictions.split(motion, members)) ASSERT_EQ(group.first, group.last);
  });
}

/// A later call's poses: some of the earlier ones, in another order, some of them off, and others.
Predictions later_predictions(const Predictions& earlier, std::vector<double>& misses, Rng& rng, double blur) {
  std::vector<Pose> drawn;
  for (std::size_t i = poses; i-- > 0;)
    drawn.push_back(i % 3 == 0 ? task()->scene().prior.sample(rng) : earlier.poses()[i]);
  for (std::size_t i = 0; i < poses; ++i) misses.push_back(i % 5 == 0 ? 0.0005 : 0.0);
  return {task(), drawn, blur, misses};
}

TEST(Predictions, AreTheSameWithWhatIsTakenOverFromAnEarlierCall) {
  Rng rng(6);
  action::ActionLibrary library(*task());
  for (const double blur : {0.0, 0.001}) {
    Predictions earlier = random_predictions(rng, blur);
    std::vector<action::MotionPtr> motions;
    for (int i = 0; i < 25; ++i) {
      motions.push_back(motion_of(random_action(*task(), library, task()->scene().start, rng), i % 2 == 0));
      for (std::size_t pose = 0; pose < poses; pose += 1 + rng.below(2)) earlier.first_contact(motions.back(), pose);
      if (i % 3 > 0) earlier.first_nears(motions.back());
    }
    std::vector<double> misses;
    Predictions taking = later_predictions(earlier, misses, rng, blur);
    Predictions afresh(task(), taking.poses(), blur, misses);
    taking.take_over(earlier);
    for (const action::MotionPtr& motion : motions) {
      ASSERT_EQ(taking.first_contacts(motion), afresh.first_contacts(motion));
      ASSERT_EQ(taking.first_nears(motion), afresh.first_nears(motion));
    }
  }
}

TEST(Predictions, AreTheSameWhateverTheNumberOfThreads) {
  Rng rng(13);
  action::ActionLibrary library(*task());
  for (int round = 0; round < 4; ++round) {
    Predictions one = random_predictions(rng, 0.001);
    Predictions three(task(), one.poses(), 0.001, {}, 3);
    for (int i = 0; i < 8; ++i) {
      const bool is_anchored = i % 2 == 0;
      const action::MotionPtr motion =
          motion_of(random_action(*task(), library, task()->scene().start, rng), is_anchored);
      const Bitset members = random_members(rng);
      const std::vector<Group> groups = one.split(motion, members, 3), others = three.split(motion, members, 3);
      ASSERT_EQ(groups.size(), others.size());
      for (std::size_t g = 0; g < groups.size(); ++g) {
        EXPECT_EQ(groups[g].poses, others[g].poses);
        EXPECT_EQ(groups[g].expected, others[g].expected);
      }
      EXPECT_EQ(one.first_contacts(motion), three.first_contacts(motion));
      EXPECT_EQ(one.first_nears(motion), three.first_nears(motion));
    }
  }
}

TEST(Predictions, OfHowAMotionBeginsAreThoseOfTheWhole) {
  Rng rng(7);
  action::ActionLibrary library(*task());
  for (int i = 0; i < 25; ++i) {
    Predictions told = random_predictions(rng, 0.001);
    Predictions afresh(task(), told.poses(), 0.001);
    const action::MotionPtr whole = motion_of(random_action(*task(), library, task()->scene().start, rng), true);
    const action::MotionPtr part = action::truncated(*task(), *whole, 2 + rng.below(whole->path.size() - 1));
    told.first_contacts(whole);
    if (i % 2 == 0) told.first_nears(whole);
    told.begins_as(part, whole);
    ASSERT_EQ(told.first_contacts(part), afresh.first_contacts(part));
    ASSERT_EQ(told.first_nears(part), afresh.first_nears(part));
  }
}

/// Poses that are all about as far away are touched at one waypoint or the next: which one says nothing.
TEST(Split, DoesNotTellApartWhatIsTouchedWithinTheBlur) {
  constexpr double blur = 0.001;
  Rng rng(4);
  action::ActionLibrary library(*task());
  int told_sharply = 0, told = 0;
  for (int i = 0; i < 300; ++i) {
    const action::MotionPtr motion = motion_of(random_action(*task(), library, task()->scene().start, rng));
    const PoseVector about = random_pose(task()->scene().prior, rng);
    std::vector<Pose> close;
    for (std::size_t k = 0; k < poses; ++k) {
      PoseVector pose = about;
      for (const std::size_t d : {1u, 2u}) pose[d] += rng.uniform(-0.0002, 0.0002);
      close.push_back(geometry::pose_from(pose));
    }
    const Bitset all(poses, true);
    Predictions sharp(task(), close), blurred(task(), close, blur);
    const auto contacts = [&](const std::vector<Group>& groups) {
      return std::count_if(groups.begin(), groups.end(),
                           [&](const Group& group) { return group.first < motion->path.size(); });
    };
    told_sharply += contacts(sharp.split(motion, all)) > 1;
    told += contacts(blurred.split(motion, all)) > 1;
  }
  EXPECT_GT(told_sharply, 4);
  EXPECT_LT(3 * told, told_sharply);
}

/// And what mostly is farther away is told apart.
TEST(Split, TellsApartWhatIsTouchedFartherApartThanTheBlur) {
  constexpr double blur = 0.001;
  Rng rng(5);
  action::ActionLibrary library(*task());
  int compared = 0;
  for (int i = 0; i < 60; ++i) {
    const action::MotionPtr motion = motion_of(random_action(*task(), library, task()->scene().start, rng), true);
    Predictions blurred = random_predictions(rng, blur);
    const std::vector<Group> groups = blurred.split(motion, Bitset(poses, true));
    for (std::size_t g = 1; g < groups.size(); ++g) {
      if (groups[g].first == motion->path.size()) continue;
      ++compared;
      int touched = 0, near = 0;
      for (const std::size_t member : groups[g].poses) {
        const Pose& pose = blurred.poses()[member];
        if (first_contact(*motion, pose) != groups[g].first) continue;
        const auto first = task()->target_contact().first_within(motion->bodies, pose, blur);
        ++touched;
        near += first && *first <= groups[g - 1].first;
      }
      EXPECT_LE(2 * near, touched);
    }
  }
  EXPECT_GT(compared, 20);
}

/// Poses that a small motion only grazes may be touched or not: they are in both groups, half in each.
TEST(Split, CountsWhatIsGrazedHalfAsTouchedAndHalfAsNot) {
  constexpr double blur = 0.001;
  Rng rng(6);
  action::ActionLibrary library(*task());
  int grazed = 0;
  for (int i = 0; i < 60; ++i) {
    const action::MotionPtr motion = motion_of(random_action(*task(), library, task()->scene().start, rng));
    const std::size_t untouched = motion->path.size();
    Predictions blurred = random_predictions(rng, blur);
    const Bitset members = random_members(rng);
    std::vector<int> in(poses, 0);
    double expected = 0.0;
    for (const Group& group : blurred.split(motion, members)) {
      expected += group.expected;
      const Bitset subset = blurred.subset(motion, members, group.first, group.last);
      ASSERT_EQ(subset.count(), group.poses.size());
      for (const std::size_t pose : group.poses) {
        ASSERT_TRUE(subset.test(pose));
        ++in[pose];
      }
    }
    EXPECT_NEAR(expected, static_cast<double>(members.count()), 1e-9);
    for (std::size_t pose = 0; pose < poses; ++pose) {
      const contact::TargetContact& target = task()->target_contact();
      const auto within = [&](double reach) {
        return target.first_within(motion->bodies, blurred.poses()[pose], reach, 1).value_or(untouched) < untouched;
      };
      const bool is_grazed = within(blur) && !within(target.margin() - 0.5 * blur);
      ASSERT_EQ(in[pose], members.test(pose) ? 1 + is_grazed : 0);
      grazed += is_grazed;
    }
  }
  EXPECT_GT(grazed, 20);
}

/// A pose that is a little off, and so in touch with the robot where it is, is not touched by whatever comes next.
TEST(FirstContact, CountsWhereTheRobotGoesDeeperThanAPoseIsOff) {
  constexpr double off = 0.002;
  Rng rng(7);
  action::ActionLibrary library(*task());
  int later = 0;
  for (int i = 0; i < 60; ++i) {
    const action::MotionPtr motion = motion_of(random_action(*task(), library, task()->scene().start, rng));
    const std::vector<Pose> drawn = random_predictions(rng).poses();
    Predictions exact(task(), drawn), rough(task(), drawn, 0.0, std::vector<double>(drawn.size(), off));
    for (std::size_t pose = 0; pose < poses; ++pose) {
      ASSERT_EQ(exact.first_contact(motion, pose), first_contact(*motion, drawn[pose]));
      ASSERT_GE(rough.first_contact(motion, pose), exact.first_contact(motion, pose));
      later += rough.first_contact(motion, pose) > exact.first_contact(motion, pose);
    }
  }
  EXPECT_GT(later, 20);
}

TEST(Predictions, AreTheSameAfterATimeLimitThatCutThemShort) {
  Rng rng(33);
  action::ActionLibrary library(*task());
  for (int round = 0; round < 10; ++round) {
    std::vector<Pose> drawn;
    for (std::size_t i = 0; i < poses; ++i) drawn.push_back(task()->scene().prior.sample(rng));
    Predictions limited(task(), drawn), plain(task(), drawn);
    const action::MotionPtr motion = motion_of(random_action(*task(), library, task()->scene().start, rng));
    const std::size_t known = rng.below(poses);
    for (std::size_t pose = 0; pose < known; ++pose) limited.first_contact(motion, pose);
    limited.time_limit().set(support::TimeLimit::Clock::now());
    for (std::size_t pose = 0; pose < known; ++pose)
      EXPECT_EQ(limited.first_contact(motion, pose), plain.first_contact(motion, pose)) << "known already";
    EXPECT_THROW(limited.first_contacts(motion), support::OutOfTime);
    EXPECT_THROW(limited.split(motion, Bitset(poses, true)), support::OutOfTime);
    limited.time_limit().lift();
    EXPECT_EQ(limited.first_contacts(motion), plain.first_contacts(motion));
  }
}

TEST(LeastGroup, IsHalfOfWhatAContactLeavesOfAnEvenLayout) {
  EXPECT_EQ(solver::least_group(100, 2), 5u);
  EXPECT_EQ(solver::least_group(64, 3), 8u);
  EXPECT_EQ(solver::least_group(625, 4), 63u);
  for (std::size_t count = 1; count < 500; ++count) {
    EXPECT_EQ(solver::least_group(count, 0), 1u);
    EXPECT_EQ(solver::least_group(count, 1), 1u);
    for (int dimensions = 1; dimensions < 6; ++dimensions) {
      const std::size_t least = solver::least_group(count, dimensions);
      EXPECT_GE(least, 1u);
      EXPECT_LE(2 * least, count + 1);
      EXPECT_LE(least, solver::least_group(count + 1, dimensions));
      EXPECT_LE(least, solver::least_group(count, dimensions + 1));
    }
  }
}

}  // namespace
}  // namespace tactus::test
