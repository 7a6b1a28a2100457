// SPDX-License-Identifier: BSD-3-Clause
#include "contact/contact_tables.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "contact/contact_cases.hpp"
#include "support/error.hpp"

/// What the tables of a lattice say is what the general path says of every cell, and the plain oracle of some.
namespace tactus::test {
namespace {

using contact::ContactTables;
using contact::FirstContacts;
using contact::Lattice;
using contact::LatticeMotion;
using contact::LatticePose;
using contact::TargetContact;
using robot::JointKind;
using support::Bitset;

/// A tool without an arm: what moves it is a list of poses.
std::shared_ptr<const robot::RobotModel> flyer() {
  robot::RobotModel model;
  robot::Link link;
  link.name = "tool";
  model.links.push_back(link);
  return std::make_shared<const robot::RobotModel>(model);
}

struct LatticeCase {
  Shape tool, target;
  Lattice lattice;
  TargetContact contact;
  ContactTables tables;

  LatticeCase(Shape its_tool, Shape its_target, Lattice its_lattice)
      : tool(std::move(its_tool)),
        target(std::move(its_target)),
        lattice(std::move(its_lattice)),
        contact(std::make_shared<contact::RobotBodies>(flyer(), 0, tool.mesh()), target.mesh(), 1e-5),
        tables(contact, lattice) {}
};

Lattice random_lattice(Rng& rng) {
  Lattice lattice;
  lattice.base_from_lattice = random_pose(rng, 0.5);
  for (double& pitch : lattice.pitch) pitch = rng.uniform(0.003, 0.006);
  lattice.parts = 1 + static_cast<int>(rng.below(3));
  lattice.count = {10 + static_cast<int>(rng.below(80)), 5 + static_cast<int>(rng.below(8)),
                   1 + static_cast<int>(rng.below(3))};
  const Eigen::Matrix3d first = random_pose(rng, 0.0).linear();
  lattice.target_turns.clear();
  for (int turn = 0; turn < 3; ++turn)
    lattice.target_turns.push_back(Eigen::AngleAxisd(0.4 * turn, Vector3::UnitZ()).toRotationMatrix() * first);
  lattice.tool_turns.push_back(random_pose(rng, 0.0).linear());
  return lattice;
}

/// Along an axis or a diagonal through the lattice, perhaps turning on the way.
LatticeMotion random_motion(const Lattice& lattice, Rng& rng) {
  LatticePose pose;
  std::array<int, 3> step{};
  for (std::size_t d = 0; d < 3; ++d) {
    pose.at[d] = lattice.parts * (static_cast<int>(rng.below(static_cast<std::uint64_t>(lattice.count[d]))) - 4);
    step[d] = static_cast<int>(rng.below(5)) - 2;
  }
  LatticeMotion motion;
  for (int k = 0; k < 12; ++k) {
    if (k == 6) pose.turn = static_cast<int>(rng.below(2));
    motion.push_back(pose);
    for (std::size_t d = 0; d < 3; ++d) pose.at[d] += step[d];
  }
  return motion;
}

Bitset random_cells(const Lattice& lattice, Rng& rng) {
  Bitset set = lattice.all();
  Bitset some(set.size());
  set.for_each([&](std::size_t i) {
    if (rng.below(3) == 0) some.set(i);
  });
  return some;
}

/// The first waypoint at which the general path finds contact; the motion's size without one.
std::size_t plain_first(const LatticeCase& c, const LatticeMotion& motion, const LatticePose& target) {
  const Pose target_from_base = c.lattice.base_from_target(target).inverse();
  std::size_t k = 1;
  while (k < motion.size() &&
         !c.contact.reach(0, target_from_base * c.lattice.base_from_tool(motion[k]), c.contact.margin()).hit)
    ++k;
  return k;
}

void expect_general_answers(const LatticeCase& c, Rng& rng) {
  for (int m = 0; m < 4; ++m) {
    const LatticeMotion motion = random_motion(c.lattice, rng);
    const FirstContacts found = c.tables.first_contacts(motion);
    const Bitset possible = random_cells(c.lattice, rng);
    std::vector<std::size_t> counts(motion.size() + 1);
    std::vector<Bitset> groups(motion.size() + 1, Bitset(possible.size()));
    possible.for_each([&](std::size_t i) {
      const std::size_t first = plain_first(c, motion, c.lattice.cell(i));
      ++counts[first];
      groups[first].set(i);
    });
    ASSERT_EQ(found.split(possible), counts);
    for (std::size_t k = 1; k < motion.size(); ++k) ASSERT_EQ(found.after_contact(possible, k), groups[k]);
    ASSERT_EQ(found.after_none(possible), groups.back());
  }
}

TEST(Lattice, CellsAndIndicesAreOneToOne) {
  Rng rng(1);
  const Lattice lattice = random_lattice(rng);
  const Bitset all = lattice.all();
  EXPECT_EQ(all.count(), lattice.cells());
  all.for_each([&](std::size_t i) { ASSERT_EQ(lattice.index(lattice.cell(i)), i); });
}

TEST(Lattice, OffsetsAreWhatTheToolIsSeenAt) {
  Rng rng(2);
  const Lattice lattice = random_lattice(rng);
  for (int i = 0; i < 100; ++i) {
    const LatticePose tool = random_motion(lattice, rng).back();
    const LatticePose target = lattice.cell(lattice.index({{3, 2, 0}, static_cast<int>(rng.below(3))}));
    const Lattice::Stand stand = lattice.stand(tool);
    const Pose seen = lattice.target_from_tool(
        {target.at[0] - stand.at[0], target.at[1] - stand.at[1], target.at[2] - stand.at[2]}, target.turn, stand.way);
    EXPECT_TRUE(seen.isApprox(lattice.base_from_target(target).inverse() * lattice.base_from_tool(tool), 1e-9));
  }
}

TEST(ContactTables, SayWhatTheGeneralPathSays) {
  Rng rng(3);
  const std::vector<Pairing>& all = pairings();
  for (const std::size_t pairing : {0, 1, 2, 5, 6})
    expect_general_answers({all[pairing].tool, all[pairing].target, random_lattice(rng)}, rng);
}

TEST(ContactTables, SayWhatEveryPairOfTrianglesSays) {
  Rng rng(4);
  const LatticeCase c(pairings()[1].tool, pairings()[1].target, random_lattice(rng));
  int touched = 0;
  for (int m = 0; m < 6; ++m) {
    const LatticeMotion motion = random_motion(c.lattice, rng);
    const FirstContacts found = c.tables.first_contacts(motion);
    for (int i = 0; i < 60; ++i) {
      LatticePose cell;
      for (std::size_t d = 0; d < 3; ++d)
        cell.at[d] = static_cast<int>(rng.below(static_cast<std::uint64_t>(c.lattice.count[d])));
      cell.turn = static_cast<int>(rng.below(3));
      Bitset one(c.lattice.bits());
      one.set(c.lattice.index(cell));
      std::size_t first = 1;
      while (first < motion.size() &&
             !reference::touch(Placed(c.tool, c.lattice.base_from_tool(motion[first])),
                               Placed(c.target, c.lattice.base_from_target(cell)), c.contact.margin()))
        ++first;
      EXPECT_EQ(found.split(one)[first], 1u);
      touched += first < motion.size();
    }
  }
  EXPECT_GT(touched, 20);
}

TEST(ContactTables, RestoredOnesAnswerAsTheSavedOnesAndOthersAreRefused) {
  Rng rng(5);
  const LatticeCase saved(pairings()[0].tool, pairings()[0].target, random_lattice(rng));
  const LatticeMotion motion = random_motion(saved.lattice, rng);
  const auto counts = saved.tables.first_contacts(motion).split(saved.lattice.all());
  std::vector<std::uint8_t> bytes = saved.tables.save();
  ContactTables restored(saved.contact, saved.lattice);
  restored.restore(bytes.data(), bytes.size());
  EXPECT_EQ(restored.bytes(), saved.tables.bytes());
  EXPECT_EQ(restored.first_contacts(motion).split(saved.lattice.all()), counts);
  EXPECT_EQ(restored.save(), bytes);

  Lattice finer = saved.lattice;
  finer.pitch *= 0.5;
  ContactTables other(saved.contact, finer);
  EXPECT_THROW(other.restore(bytes.data(), bytes.size()), support::Error);
  for (int i = 0; i < 200; ++i) {
    std::vector<std::uint8_t> spoilt = bytes;
    spoilt[rng.below(spoilt.size())] ^= static_cast<std::uint8_t>(1 + rng.below(255));
    EXPECT_THROW(restored.restore(spoilt.data(), spoilt.size()), support::Error);
  }
  EXPECT_EQ(restored.save(), bytes) << "nothing has changed after the errors";
}

/// Every pose that a cell stands for is first touched no earlier than the wide tables say, and no later than the deep
/// ones.
TEST(ContactTables, OfAReachAndADepthGiveAnIntervalForEveryPoseOfACell) {
  Rng rng(9);
  int touched = 0, surely = 0;
  for (const double radius : {0.0015, 0.004}) {
    const LatticeCase c(pairings()[1].tool, pairings()[1].target, random_lattice(rng));
    const std::size_t room = std::size_t{64} << 20;
    const ContactTables wide(c.contact, c.lattice, c.contact.margin() + radius, room);
    const ContactTables deep(c.contact, c.lattice, -radius, room);
    for (int m = 0; m < 4; ++m) {
      const LatticeMotion motion = random_motion(c.lattice, rng);
      const FirstContacts earliest = wide.first_contacts(motion), latest = deep.first_contacts(motion);
      random_cells(c.lattice, rng).for_each([&](std::size_t i) {
        if (rng.below(10) != 0) return;
        Bitset cell(c.lattice.bits());
        cell.set(i);
        const auto waypoint = [&cell](const FirstContacts& found) {
          const std::vector<std::size_t> counts = found.split(cell);
          return static_cast<std::size_t>(std::find(counts.begin(), counts.end(), 1u) - counts.begin());
        };
        Pose base_from_target = c.lattice.base_from_target(c.lattice.cell(i));
        base_from_target.translation() += radius * rng.uniform() * random_direction(rng);
        std::size_t first = 1;
        while (first < motion.size() &&
               !c.contact
                    .reach(0, base_from_target.inverse() * c.lattice.base_from_tool(motion[first]), c.contact.margin())
                    .hit)
          ++first;
        EXPECT_LE(waypoint(earliest), first);
        EXPECT_GE(waypoint(latest), first);
        touched += first < motion.size();
        surely += waypoint(latest) < motion.size();
      });
    }
  }
  EXPECT_GT(touched, 50);
  EXPECT_GT(surely, 20);
}

TEST(ContactTables, AMotionOfNoWaypointsOrOneTouchesNothing) {
  Rng rng(8);
  const LatticeCase c(pairings()[0].tool, pairings()[0].target, random_lattice(rng));
  EXPECT_EQ(c.tables.first_contacts({}).split(c.lattice.all()), std::vector<std::size_t>{c.lattice.cells()});
  EXPECT_EQ(c.tables.first_contacts({LatticePose{}}).split(c.lattice.all()),
            (std::vector<std::size_t>{0, c.lattice.cells()}));
}

TEST(ContactTables, KeepWithinTheirRoomAndAnswerAllTheSame) {
  Rng rng(6);
  const LatticeCase c(pairings()[0].tool, pairings()[0].target, random_lattice(rng));
  const std::size_t room = 6000;
  const ContactTables tight(c.contact, c.lattice, room);
  for (int m = 0; m < 5; ++m) {
    const LatticeMotion motion = random_motion(c.lattice, rng);
    EXPECT_EQ(tight.first_contacts(motion).split(c.lattice.all()),
              c.tables.first_contacts(motion).split(c.lattice.all()));
    EXPECT_LE(tight.bytes(), room);
  }
}

TEST(ContactTables, AnswerManyThreadsAsOne) {
  Rng rng(7);
  const LatticeCase c(pairings()[0].tool, pairings()[0].target, random_lattice(rng));
  std::vector<LatticeMotion> motions;
  for (int m = 0; m < 8; ++m) motions.push_back(random_motion(c.lattice, rng));
  const ContactTables shared(c.contact, c.lattice);
  std::vector<std::vector<std::size_t>> found(motions.size());
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (std::size_t m = t; m < motions.size(); m += 4)
        found[m] = shared.first_contacts(motions[m]).split(c.lattice.all());
    });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t m = 0; m < motions.size(); ++m)
    EXPECT_EQ(found[m], c.tables.first_contacts(motions[m]).split(c.lattice.all()));
}

}  // namespace
}  // namespace tactus::test
