// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "contact/contact_cases.hpp"
#include "contact/kernel/sets.hpp"

/// Every kernel that the machine has gives the bits of the portable one, and bounds that hold.
namespace tactus::test {
namespace {

namespace kernel = contact::kernel;

std::vector<const kernel::Kernel*> supported_kernels() {
  std::vector<const kernel::Kernel*> found;
  for (const kernel::Kernel* const* k = kernel::kernels(); *k != nullptr; ++k)
    if ((*k)->supported()) found.push_back(*k);
  return found;
}

/// A tree of balls, the field of a target, and placements of the one about the other.
class KernelLaw : public testing::TestWithParam<const kernel::Kernel*> {
 protected:
  const kernel::Kernel& kernel() const { return *GetParam(); }
  Pose random_placement() {
    Pose pose = random_pose(rng, 0.12);
    if (rng.below(10) == 0) pose.translation() += 3.0 * random_direction(rng);
    return pose;
  }

  Rng rng{7};
  geometry::DistanceField distance{pairings()[1].target.mesh(), 0.001, 0.01};
  contact::TargetField field{distance};
  contact::BallTree tree{pairings()[2].tool.mesh(), 0.003};
  contact::Facets facets{distance.tree(), 0.004};
};

TEST_P(KernelLaw, BoundsHoldAndAreThePortableOnes) {
  for (int i = 0; i < 300; ++i) {
    const Pose pose = random_placement();
    const kernel::Placement placement = contact::placement(pose);
    const kernel::Block& block = tree.blocks()[rng.below(tree.blocks().size())];
    float lower[2][kernel::lanes], upper[2][kernel::lanes];
    kernel().measure(block, field.view(), placement, lower[0], upper[0]);
    kernel::portable.measure(block, field.view(), placement, lower[1], upper[1]);
    EXPECT_EQ(std::memcmp(lower[0], lower[1], sizeof lower[0]), 0);
    EXPECT_EQ(std::memcmp(upper[0], upper[1], sizeof upper[0]), 0);
    for (int lane = 0; lane < kernel::lanes; ++lane) {
      const double exact =
          distance.exact(pose * Vector3(block.centre[0][lane], block.centre[1][lane], block.centre[2][lane]));
      EXPECT_LE(lower[0][lane], exact);
      EXPECT_GE(upper[0][lane], exact);
    }
  }
}

TEST_P(KernelLaw, WalksAreThePortableOnes) {
  int hits = 0, undecided = 0, free = 0;
  for (int i = 0; i < 2000; ++i) {
    const kernel::Placement placement = contact::placement(random_placement());
    const auto threshold = static_cast<float>(rng.below(2) == 0 ? 1e-5 : rng.uniform(-0.01, 0.02));
    const kernel::Question question{threshold, rng.below(2) == 0 ? 0.0f : 0.4f * std::abs(threshold),
                                    rng.below(2) == 0};
    kernel::Walk ours, theirs;
    ours.start(tree.root());
    theirs.start(tree.root());
    do {
      const auto verdict = kernel().walk(tree.blocks().data(), field.view(), placement, question, ours);
      ASSERT_EQ(verdict, kernel::portable.walk(tree.blocks().data(), field.view(), placement, question, theirs));
      ++(verdict == kernel::Verdict::hit ? hits : verdict == kernel::Verdict::free ? free : undecided);
      if (verdict == kernel::Verdict::hit) break;
      ASSERT_EQ(ours.depth, theirs.depth);
      ASSERT_EQ(ours.piece_count, theirs.piece_count);
      ASSERT_EQ(std::memcmp(ours.pieces, theirs.pieces, sizeof(std::int32_t) * ours.piece_count), 0);
      ASSERT_EQ(std::memcmp(&ours.clearance, &theirs.clearance, sizeof ours.clearance), 0);
    } while (ours.depth > 0);
  }
  EXPECT_GT(hits, 50);
  EXPECT_GT(free, 50);
  EXPECT_GT(undecided, 50);
}

TEST_P(KernelLaw, WhatIsNotNearIsFartherThanTheReach) {
  const kernel::Extent body{{0.01f, -0.02f, 0.03f}, {0.05f, 0.02f, 0.03f}},
      target{{0, 0, 0.01f}, {0.03f, 0.04f, 0.02f}};
  int far = 0;
  for (int i = 0; i < 300; ++i) {
    kernel::PoseBlock poses;
    std::array<Pose, kernel::lanes> placed;
    for (int lane = 0; lane < kernel::lanes; ++lane) {
      placed[lane] = random_pose(rng, 0.2);
      const kernel::Placement p = contact::placement(placed[lane]);
      for (int k = 0; k < 9; ++k) poses.rotation[k][lane] = p.rotation[k];
      for (int k = 0; k < 3; ++k) poses.translation[k][lane] = p.translation[k];
    }
    const Pose target_from_base = random_pose(rng, 0.1);
    const auto reach = static_cast<float>(rng.uniform(0.0, 0.05));
    const std::uint32_t near = kernel().near(poses, body, contact::placement(target_from_base), target, reach);
    EXPECT_EQ(near, kernel::portable.near(poses, body, contact::placement(target_from_base), target, reach));
    for (int lane = 0; lane < kernel::lanes; ++lane) {
      if ((near >> lane & 1u) != 0) continue;
      ++far;
      const geometry::Box box{Vector3(-0.03, -0.04, -0.01), Vector3(0.03, 0.04, 0.03)};
      for (int k = 0; k < 50; ++k) {
        const Vector3 p(0.01 + rng.uniform(-0.05, 0.05), -0.02 + rng.uniform(-0.02, 0.02),
                        0.03 + rng.uniform(-0.03, 0.03));
        EXPECT_GT(box.distance(target_from_base * (placed[lane] * p)), static_cast<double>(reach) - 1e-6);
      }
    }
  }
  EXPECT_GT(far, 500);
}

/// The planes that part sixteen facets from one are those of the portable kernel, and part none that is within reach.
TEST_P(KernelLaw, FacetsThatAPlanePartsAreFartherThanTheReach) {
  int parted = 0, close = 0;
  for (int i = 0; i < 2000; ++i) {
    const Pose pose = random_pose(rng, 0.05);
    const contact::Piece& piece = tree.pieces()[rng.below(tree.pieces().size())];
    const Vector3 centre = pose * piece.centre;
    const double reach = rng.below(2) == 0 ? 0.0 : rng.uniform(0.0, 0.003);
    const geometry::Corners corners = geometry::transformed(piece.corners, pose);
    const contact::Facets::Near beside = facets.near(centre);
    for (std::size_t k = 0; k < beside.blocks.size(); ++k) {
      const auto ask = [&](const kernel::Kernel& asked) {
        return asked.facets_near(piece.facet, contact::placement(pose), beside.blocks[k],
                                 static_cast<float>(reach + 2e-6));
      };
      const std::uint32_t near = ask(kernel());
      ASSERT_EQ(near, ask(kernel::portable));
      for (std::size_t lane = 0; lane < kernel::lanes; ++lane) {
        const int face = beside.faces[k * kernel::lanes + lane];
        const bool stays = (near >> lane & 1u) != 0;
        if (face < 0) {
          EXPECT_FALSE(stays);
          continue;
        }
        const bool within = distance.tree().within(corners, face, reach);
        EXPECT_TRUE(stays || !within);
        parted += !stays;
        close += within;
      }
    }
  }
  EXPECT_GT(parted, 1000);
  EXPECT_GT(close, 50);
}

/// The lists of a point hold every triangle within the reach.
TEST(Facets, TheListOfAPointHoldsEveryTriangleWithinReach) {
  Rng rng(11);
  const geometry::TriangleTree tree(pairings()[1].target.mesh());
  const contact::Facets facets(tree, 0.004);
  int found = 0;
  for (int i = 0; i < 3000; ++i) {
    const geometry::Box box = tree.box().inflated(0.01);
    const Vector3 p =
        box.low + Vector3(rng.uniform(0, 1), rng.uniform(0, 1), rng.uniform(0, 1)).cwiseProduct(box.size());
    const contact::Facets::Near near = facets.near(p);
    const std::vector<int> listed(near.faces, near.faces + near.blocks.size() * kernel::lanes);
    for (const int face : tree.faces_near(p, facets.reach())) {
      ++found;
      EXPECT_EQ(std::count(listed.begin(), listed.end(), face), 1);
    }
  }
  EXPECT_GT(found, 100);
}

/// A block's parts hold the balls that their cores say.
TEST(BallTree, ACoreIsADepthInTheSolidOrADistanceToTheSurface) {
  const Mesh mesh = pairings()[2].tool.mesh();
  const contact::BallTree tree(mesh, 0.003);
  const geometry::TriangleTree surface(mesh);
  for (const kernel::Block& block : tree.blocks())
    for (int lane = 0; lane < kernel::lanes; ++lane) {
      if (block.half[0][lane] == kernel::no_part) {
        EXPECT_EQ(block.core[lane], kernel::no_part);
        continue;
      }
      const Vector3 centre(block.centre[0][lane], block.centre[1][lane], block.centre[2][lane]);
      const double depth = surface.distance(centre) * (surface.contains(centre) ? 1.0 : -1.0);
      EXPECT_LE(block.core[lane], depth + (block.next[lane] < 0 ? 1e-7 : 0.0));
    }
}

/// What a belief does ends by what its answers took: on no machine sooner than on another.
TEST_P(KernelLaw, AnswersTakeTheEffortOfThePortableOnes) {
  const Scene& scene = scene_of(0);
  const auto bodies = std::make_shared<contact::RobotBodies>(scene.arm.model, scene.arm.tip, pairings()[0].tool.mesh());
  const auto contact_by = [&](const kernel::Kernel& asked) {
    return TargetContact(bodies, scene.target.mesh(), scene.margin, asked);
  };
  const TargetContact ours = contact_by(kernel()), portable = contact_by(kernel::portable);
  std::uint64_t looks = 0;
  for (int m = 0; m < 40; ++m) {
    const Motion motion(scene, random_waypoints(rng));
    const Pose pose = m % 2 == 0 ? pose_near_touching(scene, motion, rng) : pose_anywhere(scene, motion, rng);
    for (const double radius : {0.0005, 0.003}) {
      contact::Effort effort, theirs;
      EXPECT_EQ(ours.first_within(motion.path, pose, radius, 1, &effort),
                portable.first_within(motion.path, pose, radius, 1, &theirs));
      EXPECT_EQ(ours.first_certain_contact(motion.path, pose, radius, 1, &effort),
                portable.first_certain_contact(motion.path, pose, radius, 1, &theirs));
      EXPECT_EQ(effort.looks, theirs.looks);
      looks += effort.looks;
    }
  }
  EXPECT_GT(looks, 500u);
}

INSTANTIATE_TEST_SUITE_P(, KernelLaw, testing::ValuesIn(supported_kernels()),
                         [](const auto& kernel) { return std::string(kernel.param->name); });

TEST(Kernels, TheFastestIsTheFirstThatTheMachineHas) {
  EXPECT_EQ(&kernel::fastest(), supported_kernels().front());
  EXPECT_EQ(supported_kernels().back(), &kernel::portable);
}

TEST(SetKernels, TakeTheMembersWhoseBitIsSet) {
  Rng rng(12);
  const auto random_words = [&rng](std::size_t count) {
    std::vector<std::uint64_t> words(count);
    for (std::uint64_t& word : words) word = rng.next() & rng.next();
    return words;
  };
  for (int round = 0; round < 200; ++round) {
    const std::size_t rows = rng.below(40);
    const int shift = static_cast<int>(rng.below(64));
    const std::vector<std::uint64_t> low = random_words(rows), high = random_words(rows), members = random_words(rows);
    std::vector<std::uint64_t> plain(rows);
    std::uint64_t plain_any = 0;
    for (std::size_t row = 0; row < rows; ++row)
      for (int bit = 0; bit < 64; ++bit) {
        const int from = bit + shift;
        const bool is_set = ((from < 64 ? low[row] >> from : high[row] >> (from - 64)) & 1) != 0;
        if (is_set && (members[row] >> bit & 1) != 0) plain[row] |= std::uint64_t{1} << bit;
        plain_any |= plain[row];
      }
    for (const contact::kernel::SetKernel* const* kernel = contact::kernel::set_kernels(); *kernel; ++kernel) {
      if (!(*kernel)->supported()) continue;
      std::vector<std::uint64_t> left = members, taken(rows);
      ASSERT_EQ((*kernel)->take(low.data(), high.data(), shift, rows, left.data(), taken.data()), plain_any);
      ASSERT_EQ(taken, plain) << (*kernel)->name;
      for (std::size_t row = 0; row < rows; ++row) ASSERT_EQ(left[row], members[row] & ~plain[row]) << (*kernel)->name;
    }
  }
}

}  // namespace
}  // namespace tactus::test
