// SPDX-License-Identifier: BSD-3-Clause
#include "scene/prior.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>

namespace tactus::scene {
namespace {

using geometry::Vector3;
using support::Rng;

constexpr double pi = std::numbers::pi;

const Prior prior{{0.5, 0.1, -0.2, 0.3, 0.0, 3.0}, {0.0, 0.2, 0.1, 2.0 * pi, 0.4, 1.0}};

TEST(Prior, HoldsItsSamplesAndFillsItsRanges) {
  Rng rng(1);
  Vector3 low = Vector3::Constant(1e300), high = -low;
  for (int i = 0; i < 5000; ++i) {
    const Pose pose = prior.sample(rng);
    ASSERT_TRUE(prior.contains(geometry::pose_vector(pose)));
    low = low.cwiseMin(pose.translation());
    high = high.cwiseMax(pose.translation());
  }
  EXPECT_LT((low - Vector3(0.5, 0.0, -0.25)).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT((high - Vector3(0.5, 0.2, -0.15)).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Prior, EndsWhereItsWidthsSay) {
  for (std::size_t d = 0; d < 6; ++d)
    for (const double sign : {-1.0, 1.0}) {
      PoseVector v = prior.centre;
      v[d] += sign * 0.5 * prior.width[d];
      EXPECT_TRUE(prior.contains(v)) << d;
      v[d] += sign * 1e-6;
      EXPECT_EQ(prior.contains(v), d == 3) << d;  // a whole turn has no end
      EXPECT_TRUE(prior.contains(v, 1e-5));
    }
}

TEST(Prior, TakesAnglesModuloWholeTurns) {
  PoseVector v = prior.centre;
  v[5] -= 2.0 * pi;
  v[4] += 4.0 * pi;
  EXPECT_TRUE(prior.contains(v));
  v[0] += 2.0 * pi;
  EXPECT_FALSE(prior.contains(v));
}

TEST(Prior, HoldsNoPoseThatIsNotFinite) {
  for (std::size_t d = 0; d < 6; ++d)
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      PoseVector v = prior.centre;
      v[d] = bad;
      EXPECT_FALSE(prior.contains(v)) << d;
    }
}

TEST(Prior, CentralPoseIsThatOfItsCentre) {
  EXPECT_TRUE(prior.central_pose().isApprox(geometry::pose_from(prior.centre)));
}

/// The same numbers for the same seed as ever: trials are named by their seeds.
TEST(Prior, WithoutGuessesIsUniformAndDrawsOneNumberADimension) {
  Rng rng(4), same(4);
  for (int i = 0; i < 100; ++i) {
    PoseVector v = prior.centre;
    for (std::size_t d = 0; d < 6; ++d) v[d] += prior.width[d] * (same.uniform() - 0.5);
    ASSERT_EQ(prior.sample(rng).matrix(), geometry::pose_from(v).matrix());
    ASSERT_EQ(prior.density(v), 1.0);
  }
}

Matrix6 random_covariance(const PoseVector& deviation, Rng& rng) {
  Matrix6 mixed;
  for (double& value : mixed.reshaped()) value = rng.uniform(-1.0, 1.0);
  mixed += 1.5 * Matrix6::Identity();
  mixed.rowwise().normalize();
  const Eigen::Map<const Eigen::Matrix<double, 6, 1>> scale(deviation.data());
  return scale.asDiagonal() * (mixed * mixed.transpose()) * scale.asDiagonal();
}

/// A box with some dimensions free, a whole turn of roll at times, and guesses in it from narrow to wide.
Prior random_prior(Rng& rng) {
  Prior random;
  PoseVector deviation{};
  const bool narrow = rng.below(2) == 0;
  for (std::size_t d = 0; d < 6; ++d) {
    random.centre[d] = d == 4 ? rng.uniform(-0.5, 0.5) : rng.uniform(-3.0, 3.0);
    if (rng.below(2) == 0)
      random.width[d] = d == 3 && rng.below(2) == 0 ? 2.0 * pi : rng.uniform(0.05, d < 3 ? 0.3 : 1.5);
    deviation[d] =
        random.width[d] > 0.0 ? random.width[d] * (narrow ? rng.uniform(0.1, 0.4) : rng.uniform(0.6, 2.0)) : 1.0;
  }
  const std::size_t guesses = 1 + rng.below(3);
  for (std::size_t g = 0; g < guesses; ++g) {
    PoseVector mean = random.centre;
    for (std::size_t d = 0; d < 6; ++d) mean[d] += random.width[d] * rng.uniform(-0.5, 0.5);
    mean[3] += 2.0 * pi * static_cast<double>(rng.below(3));
    random.guesses.push_back(
        {Normal(mean, random_covariance(deviation, rng), random.width), 0.9 / static_cast<double>(guesses)});
  }
  return random;
}

/// In which of 3 x 3 .. bins over the free dimensions.
std::size_t bin_of(const Prior& box, const PoseVector& v) {
  std::size_t bin = 0;
  for (std::size_t d = 0; d < 6; ++d) {
    if (box.width[d] <= 0.0) continue;
    const double share = (v[d] - box.centre[d]) / box.width[d] + 0.5;
    bin = 3 * bin + std::min<std::size_t>(2, static_cast<std::size_t>(3.0 * share));
  }
  return bin;
}

/// The numbers of the box that describe the pose, its pitch being between quarter turns.
PoseVector numbers_of(const Prior& box, const Pose& pose) {
  PoseVector v = geometry::pose_vector(pose);
  for (std::size_t d = 3; d < 6; ++d) v[d] = nearest_angle(v[d], box.centre[d]);
  return v;
}

/// Chi-square in bins of draws against ten times as many uniform ones that count by the density.
TEST(Prior, DrawsByItsDensity) {
  constexpr int draws = 30000;
  Rng rng(5);
  int from_the_box = 0;
  for (int i = 0; i < 30; ++i) {
    const Prior random = random_prior(rng);
    const Prior box{random.centre, random.width};
    std::vector<double> drawn(729), expected(729), variance(729);
    double total = 0.0, highest = 0.0;
    for (int k = 0; k < draws; ++k) {
      const Pose pose = random.sample(rng);
      ASSERT_TRUE(box.contains(pose, 1e-7));
      ++drawn[bin_of(box, numbers_of(box, pose))];
    }
    for (int k = 0; k < 10 * draws; ++k) {
      PoseVector v = box.centre;
      for (std::size_t d = 0; d < 6; ++d) v[d] += box.width[d] * rng.uniform(-0.5, 0.5);
      const double density = random.density(v);
      expected[bin_of(box, v)] += density;
      variance[bin_of(box, v)] += density * density;
      total += density;
      highest = std::max(highest, density);
    }
    EXPECT_LE(total, 10.0 * draws * 1.05);
    from_the_box += highest < 1.0;
    double chi_square = 0.0;
    int bins = 0;
    for (std::size_t b = 0; b < drawn.size(); ++b) {
      const double mean = draws * expected[b] / total;
      if (mean < 10.0) continue;
      const double scale = draws / total;
      chi_square += (drawn[b] - mean) * (drawn[b] - mean) / (mean + scale * scale * variance[b]);
      ++bins;
    }
    EXPECT_LT(chi_square, bins + 5.0 * std::sqrt(2.0 * bins)) << i;
  }
  EXPECT_GT(from_the_box, 2);
  EXPECT_LT(from_the_box, 28);
}

/// One dimension and another way round the turn: with the mean at one end of the box half of it lies at the other.
TEST(Prior, GuessesGoRoundTheWholeTurn) {
  Prior round{{0, 0, 0, 0, 0, 1.0}, {0, 0, 0, 0, 0, 2.0 * pi}};
  round.guesses.push_back({Normal({0, 0, 0, 0, 0, 1.0 - pi}, 0.04 * Matrix6::Identity(), round.width), 0.9});
  EXPECT_NEAR(round.density({0, 0, 0, 0, 0, 1.1 - pi}), round.density({0, 0, 0, 0, 0, 0.9 + pi}), 1e-9);
  EXPECT_NEAR(round.density({0, 0, 0, 0, 0, 1.0 + pi}), 0.1 + 0.9 * 2.0 * pi / (0.2 * std::sqrt(2.0 * pi)), 1e-9);
  Rng rng(6);
  int low = 0, high = 0;
  for (int i = 0; i < 4000; ++i) {
    const double yaw = numbers_of(round, round.sample(rng))[5];
    low += yaw < 1.6 - pi;
    high += yaw > 0.4 + pi;
  }
  EXPECT_NEAR(low, 1800 + 38, 150);
  EXPECT_NEAR(high, 1800 + 38, 150);
}

/// A guess at another height than the known one, and sure of it.
TEST(Prior, GuessesSayNothingOfAKnownDimension) {
  Rng rng(7);
  Prior flat{{0.5, 0.0, 0.2, 0, 0, 0}, {0.1, 0.1, 0, 0, 0, 0}};
  Prior same = flat;
  Matrix6 covariance = 1e-4 * Matrix6::Identity(), other = covariance;
  other(2, 2) = -1.0;
  other(0, 2) = other(2, 0) = 5.0;
  EXPECT_TRUE(Normal::is_covariance(other, flat.width));
  flat.guesses.push_back({Normal({0.51, 0.01, 0.2, 0, 0, 0}, covariance, flat.width), 0.9});
  same.guesses.push_back({Normal({0.51, 0.01, 0.3, 0, 0, 1}, other, flat.width), 0.9});
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(same.sample(rng).translation().z(), 0.2);
    const PoseVector v{rng.uniform(0.45, 0.55), rng.uniform(-0.05, 0.05), 0.2, 0, 0, 0};
    EXPECT_DOUBLE_EQ(flat.density(v), same.density(v));
  }
}

TEST(Normal, TellsCovariancesFromOtherMatrices) {
  Rng rng(8);
  const PoseVector all{1, 1, 1, 1, 1, 1};
  for (int i = 0; i < 100; ++i) {
    Matrix6 matrix = random_covariance({1e-4, 1e-3, 1.0, 0.1, 2.0, 1e-3}, rng);
    EXPECT_TRUE(Normal::is_covariance(matrix, all));
    const int d = static_cast<int>(rng.below(6)), other = (d + 1) % 6;
    Matrix6 bad = matrix;
    bad(d, d) = -bad(d, d);
    EXPECT_FALSE(Normal::is_covariance(bad, all));
    bad = matrix;
    bad(d, other) = bad(other, d) = 1.01 * std::sqrt(bad(d, d) * bad(other, other));
    EXPECT_FALSE(Normal::is_covariance(bad, all));
    bad = matrix;
    bad.row(d).setZero();
    bad.col(d).setZero();
    EXPECT_FALSE(Normal::is_covariance(bad, all));
  }
  EXPECT_FALSE(Normal::is_covariance(Matrix6::Constant(std::numeric_limits<double>::quiet_NaN()), all));
}

TEST(NearestAngle, IsTheSameAngleNoMoreThanHalfATurnAway) {
  Rng rng(2);
  for (int i = 0; i < 1000; ++i) {
    const double angle = rng.uniform(-30.0, 30.0), to = rng.uniform(-30.0, 30.0), nearest = nearest_angle(angle, to);
    EXPECT_LE(std::abs(nearest - to), pi + 1e-12);
    EXPECT_NEAR(std::cos(nearest), std::cos(angle), 1e-12);
    EXPECT_NEAR(std::sin(nearest), std::sin(angle), 1e-12);
  }
}

TEST(CellRadius, BoundsTheWayOfEveryPointOfABall) {
  Rng rng(3);
  for (int i = 0; i < 300; ++i) {
    PoseVector centre{}, half{};
    for (std::size_t d = 0; d < 6; ++d) {
      centre[d] = rng.uniform(-3.0, 3.0);
      half[d] = rng.below(3) == 0 ? 0.0 : rng.uniform(0.0, d < 3 ? 0.02 : rng.below(4) == 0 ? 3.2 : 0.3);
    }
    const double reach = rng.uniform(0.0, 0.2), radius = cell_radius(half, reach);
    const Pose about = geometry::pose_from(centre);
    for (int k = 0; k < 50; ++k) {
      PoseVector v = centre;
      for (std::size_t d = 0; d < 6; ++d)
        v[d] += half[d] * (rng.below(2) == 0 ? rng.uniform(-1.0, 1.0) : rng.below(2) == 0 ? -1.0 : 1.0);
      const Vector3 p = reach * Vector3(rng.normal(), rng.normal(), rng.normal()).normalized();
      ASSERT_LE((geometry::pose_from(v) * p - about * p).norm(), radius + 1e-12);
    }
  }
}

TEST(CellRadius, OfAPureShiftIsHalfItsDiagonal) {
  EXPECT_DOUBLE_EQ(cell_radius({0.03, 0.04, 0.0, 0.0, 0.0, 0.0}, 1.0), 0.05);
}

TEST(Prior, HoldsItsCentralPoseAtAQuarterTurnOfPitch) {
  for (const double pitch : {0.5 * pi, -0.5 * pi})
    for (const double yaw : {0.0, 0.3, 0.7, 1.0, -2.0})
      for (const double roll : {0.0, 0.2, -0.4}) {
        const Prior steep{{0.0, 0.0, 0.0, roll, pitch, yaw}, {0.1, 0.1, 0.1, 0.2, 0.2, 0.2}};
        EXPECT_TRUE(steep.contains(steep.central_pose())) << pitch << " " << yaw << " " << roll;
      }
}

/// Boxes that fill the prior: as many to a side.
template <typename Visit>
void for_boxes(const Prior& box, int to_a_side, Visit visit) {
  PoseVector half{}, centre;
  std::size_t count = 1;
  for (std::size_t d = 0; d < 6; ++d)
    if (box.width[d] > 0.0) half[d] = 0.5 * box.width[d] / to_a_side, count *= static_cast<std::size_t>(to_a_side);
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t rest = i;
    for (std::size_t d = 0; d < 6; ++d) {
      centre[d] = box.centre[d];
      if (box.width[d] <= 0.0) continue;
      centre[d] += half[d] * (2.0 * static_cast<double>(rest % static_cast<std::size_t>(to_a_side)) + 1.0 - to_a_side);
      rest /= static_cast<std::size_t>(to_a_side);
    }
    visit(centre, half);
  }
}

Prior guessed(Rng& rng, double deviation, double correlation) {
  Prior made{{0.5, 0.1, -0.2, 0.3, 0.0, 3.0}, {0.0, 0.2, 0.1, 0.8, 0.0, 0.0}};
  Matrix6 covariance = Matrix6::Identity();
  PoseVector mean = made.centre, off{1.0, 0.1 * deviation, 0.1 * deviation, deviation, 1.0, 1.0};
  for (int d = 0; d < 6; ++d) covariance(d, d) = off[static_cast<std::size_t>(d)] * off[static_cast<std::size_t>(d)];
  covariance(1, 3) = covariance(3, 1) = correlation * off[1] * off[3];
  for (const std::size_t d : {1u, 2u, 3u}) mean[d] += rng.uniform(-0.25, 0.25) * made.width[d];
  made.guesses = {{Normal(mean, covariance, made.width), 0.9}};
  return made;
}

/// However wide they are beside the guess, and wherever it lies in its box.
TEST(PriorOverBoxes, GiveAllOfAGuessToTheBoxesInWhichItLies) {
  Rng rng(21);
  for (int i = 0; i < 40; ++i)
    for (const double deviation : {0.1, 0.02, 0.004, 0.0005})
      for (const int to_a_side : {1, 2, 5, 16}) {
        const Prior known = guessed(rng, deviation, 0.0);
        double mean = 0.0, boxes = 0.0;
        for_boxes(known, to_a_side, [&](const PoseVector& centre, const PoseVector& half) {
          mean += PriorOverBoxes(known, half).density(centre);
          boxes += 1.0;
        });
        const double inside = deviation < 0.05 ? 1e-6 : 0.15;  // a wide guess is cut off at the ends
        EXPECT_NEAR(mean / boxes, 1.0, inside) << deviation << " " << to_a_side;
      }
}

TEST(PriorOverBoxes, AreTheDensityWhereBoxesAreSmallAndTheMeanOfSmallBoxesWhereTheyAreNot) {
  Rng rng(22);
  for (int i = 0; i < 30; ++i) {
    const double correlation = i % 2 == 0 ? 0.0 : rng.uniform(-0.9, 0.9), deviation = rng.uniform(0.08, 0.2);
    const Prior known = guessed(rng, deviation, correlation);
    PoseVector half{0.0, 1e-4, 1e-4, 1e-3, 0.0, 0.0}, at = known.centre;
    for (const std::size_t d : {1u, 2u, 3u}) at[d] += rng.uniform(-0.4, 0.4) * known.width[d];
    const double density = known.density(at);
    EXPECT_NEAR(PriorOverBoxes(known, half).density(at), density, 0.03 * density);
    double off = 0.0, all = 0.0;
    const int to_a_side = 4, parts = 6;
    for_boxes(known, to_a_side, [&](const PoseVector& centre, const PoseVector& wide) {
      Prior box{centre, {}};
      for (std::size_t d = 0; d < 6; ++d) box.width[d] = 2.0 * wide[d];
      double fine = 0.0;
      for_boxes(box, parts,
                [&](const PoseVector& c, const PoseVector&) { fine += known.density(c) / (parts * parts * parts); });
      const double said = PriorOverBoxes(known, wide).density(centre);
      off += std::abs(said - fine);
      all += fine;
    });
    EXPECT_LT(off, (correlation == 0.0 ? 0.02 : 0.35) * all) << deviation << " " << correlation;
  }
}

}  // namespace
}  // namespace tactus::scene
