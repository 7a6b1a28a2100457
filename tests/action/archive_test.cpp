// SPDX-License-Identifier: BSD-3-Clause
#include "action/archive.hpp"

#include <gtest/gtest.h>

#include "belief/small_task.hpp"
#include "support/error.hpp"

/// An action comes back as it was saved, or not at all.
namespace tactus::test {
namespace {

using action::Action;
using support::Rng;
using support::Status;
using Bytes = std::vector<std::uint8_t>;

const action::Task& task() {
  static const auto made = small_task();
  return *made;
}

Action some_action(std::uint64_t seed) {
  Rng rng(seed);
  action::ActionLibrary library(task());
  Action action = random_action(task(), library, task().scene().start, rng);
  action.expected_cost = 0.25;
  action.contact_probability = 0.75;
  action.sensing = {0.002, 0.0001, 0.02, 0.03};
  return action;
}

Status status_of(const Bytes& bytes) {
  try {
    action::restore(task(), bytes.data(), bytes.size());
  } catch (const support::Error& error) {
    return error.status();
  }
  return Status::ok;
}

Bytes resealed(Bytes bytes) {
  const std::uint64_t sum = support::checksum(bytes.data(), bytes.size() - 8);
  for (std::size_t i = 0; i < 8; ++i) bytes[bytes.size() - 8 + i] = static_cast<std::uint8_t>(sum >> (8 * i));
  return bytes;
}

TEST(SavedAction, ComesBackAsItWas) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Action action = some_action(seed);
    const Bytes bytes = action::save(task(), action);
    const Action again = action::restore(task(), bytes.data(), bytes.size());
    EXPECT_EQ(again.id, action.id);
    EXPECT_EQ(again.kind, action.kind);
    EXPECT_EQ(again.path, action.path);
    EXPECT_EQ(again.times, action.times);
    EXPECT_EQ(again.lead, action.lead);
    EXPECT_EQ(again.length, action.length);
    EXPECT_EQ(again.full_cost, action.full_cost);
    EXPECT_EQ(again.expected_cost, action.expected_cost);
    EXPECT_EQ(again.contact_probability, action.contact_probability);
    EXPECT_EQ(again.sensing, action.sensing);
    EXPECT_EQ(again.supposed_target.matrix(), action.supposed_target.matrix());
    ASSERT_EQ(again.bodies.size(), action.bodies.size());
    for (std::size_t i = 0; i < action.bodies.size(); ++i) {
      EXPECT_EQ(again.bodies.base_from_body(i, 0).matrix(), action.bodies.base_from_body(i, 0).matrix());
      EXPECT_EQ(again.bodies.travelled(i, 0), action.bodies.travelled(i, 0));
    }
    EXPECT_EQ(action::save(task(), again), bytes);
  }
}

TEST(SavedAction, AnyFlippedByteIsAnError) {
  Rng rng(1);
  const Bytes bytes = action::save(task(), some_action(1));
  for (std::size_t at = 0; at < bytes.size(); at += at < 64 ? 1 : 1 + rng.below(20)) {
    Bytes broken = bytes;
    broken[at] = static_cast<std::uint8_t>(broken[at] ^ (1 + rng.below(255)));
    EXPECT_EQ(status_of(broken), Status::bad_saved_state) << at;
  }
}

TEST(SavedAction, OfAnyOtherLengthIsAnError) {
  const Bytes bytes = action::save(task(), some_action(2));
  for (std::size_t size = 0; size < bytes.size(); size += 7)
    EXPECT_EQ(status_of(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size))),
              Status::bad_saved_state);
  Bytes longer = bytes;
  longer.push_back(0);
  EXPECT_EQ(status_of(longer), Status::bad_saved_state);
}

TEST(SavedAction, AnyBytesUnderAFittingChecksumAreRestoredOrRefused) {
  Rng rng(3);
  const Bytes bytes = action::save(task(), some_action(3));
  int refused = 0;
  for (int i = 0; i < 1000; ++i) {
    Bytes changed = bytes;
    const std::size_t at = 20 + rng.below(i < 400 ? 24 : bytes.size() - 28);
    for (std::size_t k = at; k < std::min(bytes.size() - 8, at + 1 + rng.below(8)); ++k)
      changed[k] = static_cast<std::uint8_t>(rng.below(256));
    const Status status = status_of(resealed(changed));
    refused += status != Status::ok;
    EXPECT_TRUE(status == Status::ok || status == Status::bad_saved_state || status == Status::wrong_scenario)
        << static_cast<int>(status);
  }
  EXPECT_GT(refused, 200);
}

TEST(SavedAction, WithAnotherFingerprintIsOfAnotherScenario) {
  Bytes bytes = action::save(task(), some_action(4));
  bytes[20] = 7;
  EXPECT_EQ(status_of(resealed(bytes)), Status::wrong_scenario);
}

TEST(SavedAction, AndASavedBeliefAreNotTakenForOneAnother) {
  const auto model = small_model(belief::Kind::particles, {.position_width = 0.02});
  const Bytes belief = belief::Belief(model, task().scene().start).save(),
              action = action::save(task(), some_action(5));
  EXPECT_EQ(status_of(belief), Status::bad_saved_state);
  EXPECT_THROW(belief::Belief::restore(model, action.data(), action.size()), support::Error);
}

Status status_in(const scene::Scene& scene, const Bytes& bytes) {
  const action::Task other(scene, task().options());
  try {
    action::restore(other, bytes.data(), bytes.size());
  } catch (const support::Error& error) {
    return error.status();
  }
  return Status::ok;
}

TEST(SavedAction, OfAnotherSceneIsNotTaken) {
  const Bytes bytes = action::save(task(), some_action(3));
  EXPECT_EQ(status_in(task().scene(), bytes), Status::ok);
  scene::Scene walled = task().scene(), smaller = walled, elsewhere = walled;
  walled.world.push_back({"wall", geometry::box_mesh({0.1, 1.0, 1.0})});
  for (Vector3& v : walled.world.back().mesh.vertices) v.x() += 2.0;
  smaller.tool = geometry::transformed(smaller.tool, geometry::pose_from({0.001, 0, 0, 0, 0, 0}));
  elsewhere.target.target_from_seated.front().translation().x() += 0.001;
  for (const scene::Scene& scene : {walled, smaller, elsewhere})
    EXPECT_EQ(status_in(scene, bytes), Status::wrong_scenario);
}

TEST(SavedAction, WithAJumpIsRefused) {
  Action action = some_action(4);
  action.path.back()[5] += 1e5;
  EXPECT_EQ(status_of(action::save(task(), action)), Status::bad_saved_state);
}

}  // namespace
}  // namespace tactus::test
