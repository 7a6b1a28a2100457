// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "contact/small_arm.hpp"
#include "motion/connect.hpp"

namespace tactus {
namespace {

using geometry::Vector3;
using motion::JointPath;
using motion::Pace;
using motion::PacedSegment;
using robot::JointVector;

const Pace& pace_of(const std::vector<PacedSegment>& segments, std::size_t interval) {
  std::size_t k = 0;
  while (k + 1 < segments.size() && segments[k + 1].first <= interval) ++k;
  return segments[k].pace;
}

// The limits, checked from the mean velocities of the intervals alone. At rest before and after.
class TimedPath {
 public:
  TimedPath(const robot::RobotModel& model, int tool, JointPath path, std::vector<PacedSegment> segments)
      : model_(model),
        tool_(tool),
        path_(std::move(path)),
        segments_(std::move(segments)),
        times_(motion::time_path(model, tool, path_, segments_)) {}

  void expect_lawful() const {
    ASSERT_EQ(times_.size(), path_.size());
    EXPECT_EQ(times_.front(), 0.0);
    for (std::size_t i = 0; i + 1 < path_.size(); ++i) {
      ASSERT_GT(duration(i), 0.0);
      ASSERT_TRUE(std::isfinite(duration(i)));
      expect_slow_enough(i);
      expect_gentle(i);
    }
  }

  double whole() const { return times_.back(); }

 private:
  void expect_slow_enough(std::size_t i) const {
    for (int j = 0; j < model_.dof(); ++j)
      EXPECT_LE(std::abs(joint_velocity(i)[j]), model_.joints[static_cast<std::size_t>(j)].velocity * (1.0 + 1e-9));
    EXPECT_LE(tool_velocity(i).norm(), pace_of(segments_, i).speed * (1.0 + 1e-9));
  }

  // From rest, between the middles of neighbouring intervals, and to rest.
  void expect_gentle(std::size_t i) const {
    constexpr double factor = 1.0 + 1e-6;
    const Pace& pace = pace_of(segments_, i);
    const bool last = i + 2 == path_.size();
    const double to_next = 0.5 * (duration(i) + (last ? 0.0 : duration(i + 1)));
    const double from_rest = 0.5 * duration(i);
    const JointVector next_joints = last ? JointVector::Zero(model_.dof()) : joint_velocity(i + 1);
    const Vector3 next_tool = last ? Vector3(Vector3::Zero()) : tool_velocity(i + 1);
    const Pace& next = pace_of(segments_, last ? i : i + 1);
    const double joint_limit = factor * std::max(pace.joint_acceleration, next.joint_acceleration);
    const double tool_limit = factor * std::max(pace.acceleration, next.acceleration);
    EXPECT_LE((next_joints - joint_velocity(i)).cwiseAbs().maxCoeff() / to_next, joint_limit) << "after interval " << i;
    EXPECT_LE((next_tool - tool_velocity(i)).norm() / to_next, tool_limit) << "after interval " << i;
    if (i == 0) {
      EXPECT_LE(joint_velocity(0).cwiseAbs().maxCoeff() / from_rest, joint_limit);
      EXPECT_LE(tool_velocity(0).norm() / from_rest, tool_limit);
    }
  }

  double duration(std::size_t i) const { return times_[i + 1] - times_[i]; }
  JointVector joint_velocity(std::size_t i) const { return (path_[i + 1] - path_[i]) / duration(i); }
  Vector3 tool_at(std::size_t i) const { return robot::forward(model_, path_[i], tool_).translation(); }
  Vector3 tool_velocity(std::size_t i) const { return (tool_at(i + 1) - tool_at(i)) / duration(i); }

  const robot::RobotModel& model_;
  int tool_;
  JointPath path_;
  std::vector<PacedSegment> segments_;
  std::vector<double> times_;
};

class TimePath : public ::testing::Test {
 protected:
  JointVector random() { return test::random_configuration(*arm, rng); }

  test::Model arm = test::small_arm();
  int plate = arm->find_link("plate");
  support::Rng rng{11};
};

TEST_F(TimePath, IsLawfulOnRandomCoarsePaths) {
  for (int i = 0; i < 200; ++i) {
    JointPath path;
    for (std::uint64_t k = 0; k < 2 + rng.below(12); ++k) path.push_back(random());
    TimedPath(*arm, plate, path, {{0, {}}}).expect_lawful();
  }
}

TEST_F(TimePath, IsLawfulOnDensePathsWithCornersAndAChangeOfPace) {
  const contact::KnownWorld world(arm, {}, {});
  for (int i = 0; i < 30; ++i) {
    const JointPath path = motion::densified(world, {random(), random(), random()}, 0.01);
    const Pace slow{.speed = 0.02, .acceleration = 0.1, .joint_acceleration = 1.0};
    TimedPath(*arm, plate, path, {{0, {}}, {path.size() / 3, slow}, {path.size() / 2, {.speed = 0.3}}}).expect_lawful();
  }
}

TEST_F(TimePath, IsLawfulOnUnevenWaypoints) {
  for (int i = 0; i < 100; ++i) {
    const JointVector from = random(), to = random();
    JointPath path{from};
    for (double fraction = 0.0; fraction < 1.0; fraction += rng.uniform(0.001, 0.2))
      path.push_back(from + (fraction + 1e-4) * (to - from));
    TimedPath(*arm, plate, path, {{0, {}}}).expect_lawful();
  }
}

TEST_F(TimePath, ReachesTheToolSpeedOnALongLine) {
  const contact::KnownWorld world(arm, {}, {});
  const JointVector from = JointVector::Zero(6);
  JointVector to = from;
  to[1] = 1.0;
  const JointPath path = motion::densified(world, {from, to}, 0.004);
  const double metres = motion::tool_travel(*arm, plate, path).metres;
  const TimedPath timed(*arm, plate, path, {{0, {}}});
  timed.expect_lawful();
  EXPECT_GT(timed.whole(), metres / 0.1);
  EXPECT_LT(timed.whole(), metres / 0.1 + 1.0) << "the ramps take 0.4 s each";
}

TEST_F(TimePath, TurnsOfTheLastJointAreLimitedByTheJointAlone) {
  JointVector to = JointVector::Zero(6);
  to[5] = 3.0;
  const TimedPath timed(*arm, plate, {JointVector::Zero(6), to}, {{0, {}}});
  timed.expect_lawful();
  EXPECT_LT(timed.whole(), 4.0);
}

TEST_F(TimePath, RepeatedWaypointsTakeNoTime) {
  const JointVector a = random(), b = random();
  const std::vector<double> times = motion::time_path(*arm, plate, {a, a, b, b}, {});
  EXPECT_EQ(times[0], times[1]);
  EXPECT_LT(times[1], times[2]);
  EXPECT_EQ(times[2], times[3]);
  EXPECT_TRUE(motion::time_path(*arm, plate, {}, {}).empty());
  EXPECT_EQ(motion::time_path(*arm, plate, {a}, {}), std::vector<double>{0.0});
}

TEST_F(TimePath, TravelAddsUp) {
  const JointVector a = random(), b = random(), c = random();
  const auto whole = motion::tool_travel(*arm, plate, {a, b, c});
  const auto first = motion::tool_travel(*arm, plate, {a, b}), second = motion::tool_travel(*arm, plate, {b, c});
  EXPECT_NEAR(whole.metres, first.metres + second.metres, 1e-12);
  EXPECT_NEAR(whole.radians, first.radians + second.radians, 1e-12);
  EXPECT_EQ(motion::tool_travel(*arm, plate, {a}).metres, 0.0);
}

}  // namespace
}  // namespace tactus
