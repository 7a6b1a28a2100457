// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "belief/episode.hpp"
#include "belief/projection.hpp"

/// Poses brought into agreement with what was felt.
namespace tactus::test {
namespace {

using belief::Belief;
using belief::Kind;
using belief::Trace;
using support::Rng;

constexpr SmallTask small{.roll_width = 0.4, .position_width = 0.04, .delta = 0, .most_cells = 100};
constexpr double millimetre = 0.001;

const std::shared_ptr<const belief::Model>& model(Kind kind) {
  static const auto task = small_task(small);
  static const auto voxels = small_model(task, Kind::hierarchical, small),
                    cells = small_model(task, Kind::particles, small);
  return kind == Kind::hierarchical ? voxels : cells;
}

const action::Task& task() { return *model(Kind::particles)->task; }

bool gave(const std::vector<Trace>& history, const Pose& pose) {
  return std::all_of(history.begin(), history.end(),
                     [&](const Trace& trace) { return belief::reproduces(task(), trace, pose); });
}

PoseVector near(const PoseVector& v, double metres, double radians, Rng& rng) {
  PoseVector seed = v;
  for (std::size_t d = 0; d < 6; ++d)
    if (task().scene().prior.width[d] > 0.0) seed[d] += rng.uniform(-1.0, 1.0) * (d < 3 ? metres : radians);
  return seed;
}

std::size_t contacts(const std::vector<Trace>& history) {
  return static_cast<std::size_t>(
      std::count_if(history.begin(), history.end(), [](const Trace& trace) { return trace.contact; }));
}

TEST(Projected, ExactPosesGiveTheWholeHistoryAndAllLieInThePrior) {
  Rng rng(1);
  int exact = 0, found = 0;
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    Episode episode(model(Kind::particles), seed);
    for (int i = 0; i < 6; ++i) {
      episode.step();
      for (int k = 0; k < 20; ++k) {
        const PoseVector from = near(random_pose(task().scene().prior, rng), 0.01, 0.1, rng);
        const auto at = belief::projected(task(), episode.belief.history(), from, millimetre);
        if (!at) continue;
        ASSERT_TRUE(task().scene().prior.contains(at->pose));
        ASSERT_EQ(at->exact(), gave(episode.belief.history(), geometry::pose_from(at->pose)));
        exact += at->exact();
        ++found;
      }
    }
  }
  RecordProperty("exact", exact);
  RecordProperty("near", found - exact);
  EXPECT_GT(exact, 40);
}

TEST(Projected, WhatGivesTheHistoryStaysWhereItIs) {
  for (const std::uint64_t seed : {5u, 6u, 7u}) {
    Episode episode(model(Kind::particles), seed);
    for (int i = 0; i < 6; ++i) {
      episode.step();
      const auto at = belief::projected(task(), episode.belief.history(), episode.truth, 0.0);
      ASSERT_TRUE(at && at->exact());
      for (std::size_t d = 0; d < 6; ++d) EXPECT_NEAR(at->pose[d], episode.truth[d], 1e-12);
    }
  }
}

TEST(Projected, MostSeedsNearTheTruthComeToAgree) {
  Rng rng(2);
  int exact = 0, tried = 0;
  for (const std::uint64_t seed : {11u, 12u, 13u, 14u, 15u, 16u}) {
    Episode episode(model(Kind::particles), seed);
    for (int i = 0; i < 8; ++i) {
      episode.step();
      if (contacts(episode.belief.history()) == 0) continue;
      for (int k = 0; k < 8; ++k, ++tried) {
        const auto at =
            belief::projected(task(), episode.belief.history(), near(episode.truth, millimetre, 0.01, rng), millimetre);
        exact += at && at->exact();
      }
    }
  }
  RecordProperty("exact", std::to_string(exact) + " of " + std::to_string(tried));
  EXPECT_GT(tried, 100);
  EXPECT_GT(2 * exact, tried);
}

/// How deep corners of tool and target lie in each other, and how far apart the two are: plainly, at one waypoint.
struct Plainly {
  Plainly(const JointVector& q, const Pose& base_from_target)
      : target(target_shape(), base_from_target), tool(tool_shape(), task().base_from_tool(q)) {}

  double apart() const {
    if (reference::touch(tool, target, 0.0)) return 0.0;
    double least = 1e300;
    for (const auto& s : tool.triangles)
      for (const auto& t : target.triangles) least = std::min(least, reference::triangle_from_triangle(s, t));
    return least;
  }
  double deep() const { return std::max(corner_depth(tool, target), corner_depth(target, tool)); }

 private:
  static const reference::Shape& target_shape() {
    static const reference::Shape shape{{socket()}, {}};
    return shape;
  }
  static const reference::Shape& tool_shape() {
    static const reference::Shape shape{tool_pieces(), {}};
    return shape;
  }
  static double corner_depth(const reference::Placed& inner, const reference::Placed& outer) {
    double most = 0.0;
    for (const auto& triangle : inner.triangles)
      for (const Vector3& p : triangle)
        if (reference::holds(*outer.shape, outer.pose.inverse() * p))
          most = std::max(most, reference::surface_from_point(outer, p));
    return most;
  }

  reference::Placed target, tool;
};

/// To a millimetre: touched at the stop, and nowhere deep in the target before.
bool comes_near(const Trace& trace, const Pose& pose) {
  if (trace.contact && Plainly(trace.path.back(), pose).apart() > 1.05 * millimetre) return false;
  for (std::size_t i = 0; i < trace.touch; ++i)
    if (Plainly(trace.path[i], pose).deep() > 1.05 * millimetre) return false;
  return true;
}

TEST(Feasible, PosesComeWithinAMillimetreOfTheHistoryOrSayByHowMuchTheyMissItAndLieInThePrior) {
  Rng rng(3);
  int exact = 0, drawn = 0, coarse = 0;
  for (const std::uint64_t seed : {21u, 23u, 25u}) {
    Episode episode(model(Kind::hierarchical), seed);
    for (int i = 0; i < 7; ++i) {
      episode.step();
      for (const auto& [pose, miss] : episode.belief.draw_feasible(8, rng)) {
        ASSERT_TRUE(task().scene().prior.contains(pose));
        exact += gave(episode.belief.history(), pose);
        ++drawn;
        if (miss > millimetre) {
          EXPECT_TRUE(belief::may_reproduce(task(), episode.belief.history(), pose, miss));
          ++coarse;
          continue;
        }
        for (const Trace& trace : episode.belief.history())
          EXPECT_TRUE(comes_near(trace, pose)) << "seed " << seed << ", action " << i;
      }
    }
  }
  EXPECT_LT(coarse, drawn / 2);
  RecordProperty("exact", std::to_string(exact) + " of " + std::to_string(drawn));
  EXPECT_GT(drawn, 60);
}

/// However rare those are that agree with the history to a millimetre.
TEST(Feasible, PosesAreTenAtLeast) {
  Rng rng(8);
  int asked = 0, rare = 0;
  for (const std::uint64_t seed : {61u, 62u, 63u, 64u}) {
    Episode episode(model(Kind::hierarchical), seed);
    for (int i = 0; i < 7; ++i) {
      episode.step();
      if (episode.belief.phase() != belief::Phase::voxels) continue;
      const std::vector<belief::Drawn> poses = episode.belief.draw_feasible(30, rng);
      EXPECT_GE(poses.size(), 10u) << "seed " << seed << ", action " << i;
      ++asked;
      rare += std::any_of(poses.begin(), poses.end(), [](const belief::Drawn& one) { return one.miss > millimetre; });
    }
  }
  EXPECT_GT(asked, 5);
  EXPECT_GT(rare, 0);
}

/// Bit for bit, so that what was found of it holds.
TEST(Drawn, WhatAgreesWithWhatWasFeltSinceStaysAsItIs) {
  Rng rng(5);
  for (const Kind kind : {Kind::hierarchical, Kind::particles}) {
    int kept = 0, gone = 0;
    Episode episode(model(kind), 41);
    std::vector<belief::Drawn> known;
    for (int i = 0; i < 6; ++i) {
      episode.step();
      const bool on_voxels = episode.belief.phase() == belief::Phase::voxels;
      const auto drawn = on_voxels ? episode.belief.draw_feasible(30, rng, known) : episode.belief.draw(30, rng, known);
      for (const belief::Drawn& old : known) {
        const bool is_there = std::any_of(drawn.begin(), drawn.end(), [&](const belief::Drawn& one) {
          return one.pose.matrix() == old.pose.matrix();
        });
        if (is_there) {
          ++kept;
        } else if (!gave(episode.belief.history(), old.pose)) {
          ++gone;
        }
      }
      known = drawn;
    }
    EXPECT_GT(kept, 10);
    EXPECT_GT(gone, 10);
  }
}

/// Of the belief's cells, and mostly such as no motion that met nothing would have met.
TEST(Drawn, AreThereThoughThereIsNoTime) {
  constexpr std::size_t wanted = 30;
  Rng rng(6);
  std::size_t drawn = 0, ruled_out = 0, asked = 0;
  for (const std::uint64_t seed : {51u, 52u, 53u, 54u}) {
    Episode episode(model(Kind::particles), seed);
    for (int i = 0; i < 6; ++i) {
      episode.step();
      const support::Deadline over(1e-9, UINT64_MAX);
      const std::vector<belief::Drawn> poses = episode.belief.draw(wanted, rng, {}, over);
      ++asked;
      drawn += poses.size();
      for (const belief::Drawn& one : poses) {
        EXPECT_TRUE(one.miss == 0.0 || episode.belief.contains(one.pose));
        ruled_out += std::any_of(
            episode.belief.history().begin(), episode.belief.history().end(),
            [&](const Trace& trace) { return !trace.contact && !belief::reproduces(task(), trace, one.pose); });
      }
    }
  }
  EXPECT_GT(drawn, asked * wanted * 2 / 3);
  EXPECT_LT(ruled_out, drawn / 5);
}

TEST(Feasible, PosesAreDrawnNearTheTruthToo) {
  Rng rng(4);
  int episodes = 0;
  for (std::uint64_t seed = 31; episodes < 5; ++seed) {
    Episode episode(model(Kind::hierarchical), seed);
    while (episode.belief.history().size() < 5 && contacts(episode.belief.history()) == 0) episode.step();
    if (contacts(episode.belief.history()) != 1) continue;
    ++episodes;
    const std::vector<Pose> poses = belief::poses_of(episode.belief.draw_feasible(200, rng));
    const Pose truth = geometry::pose_from(episode.truth);
    EXPECT_TRUE(std::any_of(poses.begin(), poses.end(),
                            [&](const Pose& pose) {
                              return (pose.translation() - truth.translation()).norm() < 0.005 &&
                                     geometry::angle_between(pose, truth) < 0.1;
                            }))
        << "seed " << seed << ", " << poses.size() << " poses";
  }
}

}  // namespace
}  // namespace tactus::test
