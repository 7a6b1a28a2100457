// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "belief/plain_world.hpp"
#include "support/bytes.hpp"
#include "support/error.hpp"

/// What is saved comes back as it was, and nothing else comes back at all.
namespace tactus::test {
namespace {

using belief::Belief;
using belief::Kind;
using belief::Phase;
using support::Rng;
using support::Status;
using Bytes = std::vector<std::uint8_t>;
using ModelPtr = std::shared_ptr<const belief::Model>;

const std::shared_ptr<const action::Task>& task() {
  static const auto made = small_task({.roll_width = 0.3, .position_width = 0.04});
  return made;
}

ModelPtr model(Kind kind) { return small_model(task(), kind, {.delta = 1300, .most_cells = 200}); }

Belief after_actions(const ModelPtr& model, int actions, std::uint64_t seed) {
  Rng rng(seed);
  action::ActionLibrary library(*task());
  const PlainWorld world(*task(), task()->scene().prior.sample(rng));
  Belief belief(model, task()->scene().start);
  for (int i = 0; i < actions; ++i) {
    const action::Action action = random_action(*task(), library, belief.configuration(), rng);
    belief.step(action, world.execute(action));
  }
  return belief;
}

Belief restored(const ModelPtr& model, const Bytes& bytes) {
  return Belief::restore(model, bytes.data(), bytes.size());
}

std::string error_of(const ModelPtr& model, const Bytes& bytes, Status expected = Status::bad_saved_state) {
  try {
    restored(model, bytes);
  } catch (const support::Error& error) {
    EXPECT_EQ(error.status(), expected) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "restored without an error";
  return {};
}

/// The checksum made to fit what was changed.
Bytes resealed(Bytes bytes) {
  const std::uint64_t sum = support::checksum(bytes.data(), bytes.size() - 8);
  for (std::size_t i = 0; i < 8; ++i) bytes[bytes.size() - 8 + i] = static_cast<std::uint8_t>(sum >> (8 * i));
  return bytes;
}

void expect_same(const Belief& a, const Belief& b) {
  EXPECT_EQ(a.phase(), b.phase());
  EXPECT_EQ(a.health(), b.health());
  EXPECT_EQ(a.configuration(), b.configuration());
  EXPECT_EQ(a.save(), b.save());
  const belief::Summary x = a.summary(), y = b.summary();
  EXPECT_EQ(x.observations, y.observations);
  EXPECT_EQ(x.contacts, y.contacts);
  EXPECT_EQ(x.possibly_occupied, y.possibly_occupied);
  EXPECT_EQ(x.cells, y.cells);
  EXPECT_EQ(x.bits, y.bits);
  EXPECT_EQ(x.mean, y.mean);
  EXPECT_EQ(x.extent, y.extent);
  EXPECT_EQ(x.covariance, y.covariance);
  ASSERT_EQ(a.history().size(), b.history().size());
  for (std::size_t i = 0; i < a.history().size(); ++i) {
    EXPECT_EQ(a.history()[i].action_id, b.history()[i].action_id);
    EXPECT_EQ(a.history()[i].kind, b.history()[i].kind);
    EXPECT_EQ(a.history()[i].outcome, b.history()[i].outcome);
    EXPECT_EQ(a.history()[i].path, b.history()[i].path);
    EXPECT_EQ(a.history()[i].bodies.size(), b.history()[i].bodies.size());
  }
}

/// The same draws from the same numbers, and the same beliefs after the same observations.
void expect_acts_alike(Belief a, Belief b) {
  Rng rng(77);
  action::ActionLibrary library(*task());
  const PlainWorld world(*task(), task()->scene().prior.central_pose());
  for (int i = 0; i < 3; ++i) {
    if (a.phase() == Phase::poses) {
      Rng one(5), two(5);
      const auto of_a = belief::poses_of(a.draw(10, one)), of_b = belief::poses_of(b.draw(10, two));
      ASSERT_EQ(of_a.size(), of_b.size());
      for (std::size_t p = 0; p < of_a.size(); ++p) EXPECT_EQ(of_a[p].matrix(), of_b[p].matrix());
    }
    const action::Action action = random_action(*task(), library, a.configuration(), rng);
    const belief::Observation seen = world.execute(action);
    a.step(action, seen);
    b.step(action, seen);
    expect_same(a, b);
  }
}

TEST(SavedBelief, ComesBackAsItWas) {
  for (const Kind kind : {Kind::hierarchical, Kind::particles})
    for (const int actions : {0, 1, 6}) {
      const ModelPtr m = model(kind);
      const Belief belief = after_actions(m, actions, 20 + static_cast<std::uint64_t>(actions));
      const Belief again = restored(m, belief.save());
      expect_same(belief, again);
      expect_acts_alike(belief, again);
    }
}

TEST(SavedBelief, KeepsItsHealth) {
  const ModelPtr m = model(Kind::particles);
  Belief belief(m, task()->scene().start);
  const action::Action action = action_along(*task(), {joints({0.30, 0, 0, 0, 0, 0}), joints({0.302, 0, 0, 0, 0, 0})});
  belief.step(action, {true, action.path.back()});
  ASSERT_EQ(belief.health(), belief::Health::contradicted);
  EXPECT_EQ(restored(m, belief.save()).health(), belief::Health::contradicted);
}

TEST(SavedBelief, OfAnotherScenarioIsNotTaken) {
  const Bytes bytes = Belief(model(Kind::hierarchical), task()->scene().start).save();
  error_of(model(Kind::particles), bytes, Status::wrong_scenario);
  error_of(small_model(task(), Kind::hierarchical, {.voxel_size = 0.006, .delta = 1300, .most_cells = 200}), bytes,
           Status::wrong_scenario);
  error_of(small_model(task(), Kind::hierarchical, {.delta = 1300, .most_cells = 201}), bytes, Status::wrong_scenario);
  error_of(
      small_model(Kind::hierarchical, {.roll_width = 0.31, .position_width = 0.04, .delta = 1300, .most_cells = 200}),
      bytes, Status::wrong_scenario);
  error_of(small_model(Kind::hierarchical, {.roll_width = 0.3,
                                            .position_width = 0.04,
                                            .delta = 1300,
                                            .most_cells = 200,
                                            .sensing = {.stopping_distance = 0.002}}),
           bytes, Status::wrong_scenario);
  error_of(small_model(Kind::hierarchical,
                       {.roll_width = 0.3, .position_width = 0.04, .delta = 1300, .most_cells = 200, .seats = 2}),
           bytes, Status::wrong_scenario);
  EXPECT_NO_THROW(restored(
      small_model(Kind::hierarchical, {.roll_width = 0.3, .position_width = 0.04, .delta = 1300, .most_cells = 200}),
      bytes));
}

TEST(SavedBelief, AnyFlippedByteIsAnError) {
  Rng rng(8);
  for (const Kind kind : {Kind::hierarchical, Kind::particles}) {
    const ModelPtr m = model(kind);
    const Bytes bytes = after_actions(m, 3, 30).save();
    for (std::size_t at = 0; at < bytes.size(); at += at < 64 ? 1 : 1 + rng.below(bytes.size() / 200)) {
      Bytes broken = bytes;
      broken[at] = static_cast<std::uint8_t>(broken[at] ^ (1 + rng.below(255)));
      error_of(m, broken);
    }
  }
}

TEST(SavedBelief, OfAnyOtherLengthIsAnError) {
  Rng rng(9);
  const ModelPtr m = model(Kind::hierarchical);
  const Bytes bytes = after_actions(m, 3, 31).save();
  for (std::size_t size = 0; size < bytes.size(); size += size < 64 ? 1 : 1 + rng.below(bytes.size() / 100))
    error_of(m, Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)));
  Bytes longer = bytes;
  longer.push_back(0);
  error_of(m, longer);
  EXPECT_THROW(Belief::restore(m, nullptr, 0), support::Error);
}

/// Changed by someone who knows how to write a checksum: restored or refused, never a crash, nor room made for lengths
/// that are not there.
TEST(SavedBelief, AnyBytesUnderAFittingChecksumAreRestoredOrRefused) {
  Rng rng(10);
  for (const Kind kind : {Kind::hierarchical, Kind::particles}) {
    const ModelPtr m = model(kind);
    const Bytes bytes = after_actions(m, 2, 32).save();
    int refused = 0;
    for (int i = 0; i < 400; ++i) {
      Bytes changed = bytes;
      const std::size_t at = 28 + rng.below(i < 200 ? 150 : bytes.size() - 36);
      for (std::size_t k = at; k < std::min(bytes.size() - 8, at + 1 + rng.below(8)); ++k)
        changed[k] = static_cast<std::uint8_t>(rng.below(256));
      try {
        const Belief belief = restored(m, resealed(changed));
        EXPECT_GT(belief.summary().possibly_occupied + belief.summary().cells, 0u);
      } catch (const support::Error& error) {
        ++refused;
        EXPECT_EQ(error.status(), Status::bad_saved_state) << error.what();
      }
    }
    EXPECT_GT(refused, 20);
  }
}

TEST(SavedBelief, ErrorsSayWhatIsWrong) {
  const ModelPtr m = model(Kind::hierarchical);
  const Bytes bytes = Belief(m, task()->scene().start).save();
  Bytes other = bytes, newer = bytes, nan = bytes, many = bytes, flipped = bytes;
  other[0] = 'X';
  newer[8] = 9;
  for (std::size_t i = 28; i < 36; ++i) nan[i] = 0xff;   // the first joint
  for (std::size_t i = 78; i < 86; ++i) many[i] = 0x7f;  // how many observations
  flipped[40] ^= 1;
  EXPECT_NE(error_of(m, other).find("magic"), std::string::npos);
  EXPECT_NE(error_of(m, newer).find("version"), std::string::npos);
  EXPECT_NE(error_of(m, flipped).find("checksum"), std::string::npos);
  EXPECT_NE(error_of(m, resealed(nan)).find("configuration"), std::string::npos);
  EXPECT_NE(error_of(m, resealed(many)).find("observations"), std::string::npos);
  EXPECT_NE(error_of(m, Bytes(5)).find("length"), std::string::npos);
}

TEST(SavedBelief, OfOtherTolerancesIsNotTaken) {
  const Bytes bytes = Belief(model(Kind::particles), task()->scene().start).save();
  scene::Scene scene = task()->scene();
  scene.target.position_tolerance *= 0.01;
  const auto stricter = std::make_shared<const action::Task>(scene, task()->options());
  error_of(small_model(stricter, Kind::particles, {.delta = 1300, .most_cells = 200}), bytes, Status::wrong_scenario);
}

/// Where a saved belief's history begins: header, fingerprint, configuration, health, goal, standstill, count.
constexpr std::size_t first_trace = 20 + 8 + 6 * 8 + 1 + 1 + 4 + 8;

TEST(SavedBelief, AContactBeforeWhichTheRobotWasNowhereIsRefused) {
  const ModelPtr m = model(Kind::particles);
  Belief belief(m, task()->scene().start);
  const auto at = [](double x) { return joints({x, 0.012, 0.01, 0, 0, 0}); };
  const action::Action poke = action_round(*task(), {at(0.40), at(0.4217)});
  belief.step(poke, {true, poke.path.back()});
  Bytes bytes = belief.save();
  const std::size_t touch = first_trace + 8 + 4 + 1 + 1 + 8;
  ASSERT_EQ(bytes[touch], belief.history().front().touch);
  std::fill_n(bytes.begin() + touch, 8, std::uint8_t{0});
  EXPECT_NE(error_of(m, resealed(bytes)).find("touch of an observation"), std::string::npos);
}

TEST(SavedBelief, CellsSplitMoreOftenThanAnyAreAreRefused) {
  const ModelPtr errs =
      small_model(Kind::particles, {.most_cells = 200, .sensing = {.missed_contacts = 0.1, .false_contacts = 0.1}});
  Bytes bytes = Belief(errs, errs->task->scene().start).save();
  const std::size_t first_cell = first_trace + 2 + 4 * 8 + 8;
  std::fill_n(bytes.begin() + first_cell + 6 * 8, 6, std::uint8_t{60});
  EXPECT_NE(error_of(errs, resealed(bytes)).find("cell splits"), std::string::npos);
}

}  // namespace
}  // namespace tactus::test
