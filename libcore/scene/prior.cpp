// SPDX-License-Identifier: BSD-3-Clause
#include "scene/prior.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::scene {
namespace {

/// Brings an angle into a cell, by whole turns first.
double brought_into(double angle, double centre, double half) {
  return std::clamp(nearest_angle(angle, centre), centre - half, centre + half);
}

/// Descriptions of the pose's rotation of which one lies in the cell if any does: the usual one, the one turned over,
/// and where a pitch of a quarter turn shows no more than the difference (or the sum) of roll and yaw, the one nearest
/// to the cell's centre.
std::array<PoseVector, 3> descriptions(const Pose& pose, const PoseVector& centre, const PoseVector& half) {
  constexpr double pi = std::numbers::pi;
  const PoseVector v = geometry::pose_vector(pose);
  PoseVector over = v, shared = v;
  over[3] += pi, over[4] = pi - v[4], over[5] += pi;
  const double sign = v[4] > 0.0 ? 1.0 : -1.0, shown = v[5] - sign * v[3];
  shared[5] = brought_into(shown + sign * centre[3], centre[5], half[5]);
  shared[3] = sign * (shared[5] - shown);
  return {v, over, shared};
}

/// Of the free dimensions.
double volume(const Prior& prior) {
  double product = 1.0;
  for (const double width : prior.width) product *= width > 0.0 ? width : 1.0;
  return product;
}

PoseVector draw_anywhere(const Prior& prior, support::Rng& rng) {
  PoseVector v = prior.centre;
  for (int d = 0; d < 6; ++d) v[d] += prior.width[d] * (rng.uniform() - 0.5);
  return v;
}

/// Uniformly, kept by the density, which is nowhere more than `most`.
std::optional<PoseVector> draw_from_the_box(const Prior& prior, double most, support::Rng& rng) {
  const PoseVector v = draw_anywhere(prior, rng);
  return most * rng.uniform() < prior.density(v) ? std::optional(v) : std::nullopt;
}

/// From a guess, unless it falls outside the box, or from the uniform part.
std::optional<PoseVector> draw_from_a_part(const Prior& prior, support::Rng& rng) {
  double left = rng.uniform();
  for (const Guess& guess : prior.guesses) {
    if ((left -= guess.share) >= 0.0) continue;
    std::optional<PoseVector> v = guess.normal.draw(rng);
    if (!v) return v;
    for (int d = 0; d < 6; ++d)
      if (prior.width[d] <= 0.0) (*v)[d] = prior.centre[d];
    return prior.contains(*v, 0.0) ? v : std::nullopt;
  }
  return draw_anywhere(prior, rng);
}

}  // namespace

double Prior::density(const PoseVector& pose) const {
  double uniform = 1.0, guessed = 0.0;
  for (const Guess& guess : guesses) {
    uniform -= guess.share;
    guessed += guess.share * guess.normal.density(pose);
  }
  return uniform + volume(*this) * guessed;
}

PriorOverBoxes::PriorOverBoxes(const Prior& prior, const PoseVector& half) : volume_(volume(prior)) {
  for (const Guess& guess : prior.guesses) {
    uniform_ -= guess.share;
    guesses_.push_back({NormalOverBoxes(guess.normal, half, prior.width), guess.share});
  }
}

double PriorOverBoxes::density(const PoseVector& centre) const {
  double guessed = 0.0;
  for (const Share& guess : guesses_) guessed += guess.share * guess.normal.mean_density(centre);
  return uniform_ + volume_ * guessed;
}

/// Of the two ways to reject, the box keeps more where the density is nowhere above 1.
Pose Prior::sample(support::Rng& rng) const {
  if (guesses.empty()) return geometry::pose_from(draw_anywhere(*this, rng));
  double most = 1.0;
  for (const Guess& guess : guesses)
    most += guess.share * (volume(*this) * guess.normal.density(guess.normal.mean()) - 1.0);
  for (;;)
    if (const auto v = most < 1.0 ? draw_from_the_box(*this, most, rng) : draw_from_a_part(*this, rng))
      return geometry::pose_from(*v);
}

bool Prior::contains(const PoseVector& pose, double tolerance) const {
  for (int d = 0; d < 6; ++d) {
    const double value = d < 3 ? pose[d] : nearest_angle(pose[d], centre[d]);
    if (!(std::abs(value - centre[d]) <= 0.5 * width[d] + tolerance)) return false;
  }
  return true;
}

bool Prior::contains(const Pose& base_from_target, double tolerance) const {
  PoseVector half = width;
  for (double& value : half) value *= 0.5;
  return box_holds(centre, half, base_from_target, tolerance);
}

/// The pose's descriptions are brought into the box, and compared as poses.
bool box_holds(const PoseVector& centre, const PoseVector& half, const Pose& pose, double tolerance) {
  if (!pose.matrix().allFinite()) return false;
  for (int d = 0; d < 3; ++d)
    if (!(std::abs(pose.translation()[d] - centre[d]) <= half[d] + tolerance)) return false;
  for (PoseVector v : descriptions(pose, centre, half)) {
    for (int d = 3; d < 6; ++d) v[d] = brought_into(v[d], centre[d], half[d]);
    if ((geometry::pose_from(v).linear() - pose.linear()).cwiseAbs().maxCoeff() <= tolerance) return true;
  }
  return false;
}

double nearest_angle(double angle, double to) {
  constexpr double turn = 2.0 * std::numbers::pi;
  return angle - turn * std::round((angle - to) / turn);
}

double cell_radius(const PoseVector& half, double reach) {
  double radius = std::sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
  for (int d = 3; d < 6; ++d) radius += 2.0 * std::sin(0.5 * std::min(half[d], std::numbers::pi)) * reach;
  return radius;
}

}  // namespace tactus::scene
