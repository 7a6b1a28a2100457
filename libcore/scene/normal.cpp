// SPDX-License-Identifier: BSD-3-Clause
#include "scene/normal.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "scene/prior.hpp"

namespace tactus::scene {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double least_eigenvalue = 1e-9;  // of the correlations

/// The matrix with dimensions of no width independent of the others, and of variance 1.
Matrix6 with_fixed_apart(Matrix6 matrix, const PoseVector& width) {
  for (int d = 0; d < 6; ++d) {
    if (width[d] > 0.0) continue;
    matrix.row(d).setZero();
    matrix.col(d).setZero();
    matrix(d, d) = 1.0;
  }
  return matrix;
}

}  // namespace

Normal::Normal(const PoseVector& mean, const Matrix6& covariance, const PoseVector& width)
    : mean_(mean), covariance_(covariance) {
  factor_ = with_fixed_apart(covariance, width).llt().matrixL();
  whitening_ = factor_.triangularView<Eigen::Lower>().solve(Matrix6::Identity());
  for (int d = 0; d < 6; ++d) {
    if (width[d] > 0.0)
      peak_ /= std::sqrt(2.0 * std::numbers::pi) * factor_(d, d);
    else
      factor_(d, d) = whitening_(d, d) = 0.0;
  }
}

bool Normal::is_covariance(const Matrix6& matrix, const PoseVector& width) {
  const Matrix6 free = with_fixed_apart(matrix, width);
  const Vector6 deviation = free.diagonal().cwiseSqrt(), scale = deviation.cwiseInverse();
  if (!free.allFinite() || !(deviation.array() >= least_deviation && deviation.array() <= greatest_deviation).all())
    return false;
  const Matrix6 correlations = scale.asDiagonal() * free * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Matrix6>(correlations, Eigen::EigenvaluesOnly).eigenvalues()[0] >=
         least_eigenvalue;
}

double Normal::density(const PoseVector& pose) const {
  Vector6 off;
  for (int d = 0; d < 6; ++d) off[d] = (d < 3 ? pose[d] : nearest_angle(pose[d], mean_[d])) - mean_[d];
  return peak_ * std::exp(-0.5 * (whitening_ * off).squaredNorm());
}

std::optional<PoseVector> Normal::draw(support::Rng& rng) const {
  Vector6 unit;
  for (double& value : unit) value = rng.normal();
  const Vector6 off = factor_ * unit;
  if (off.tail<3>().cwiseAbs().maxCoeff() > std::numbers::pi) return std::nullopt;
  PoseVector pose = mean_;
  for (int d = 0; d < 6; ++d) pose[d] += off[d];
  return pose;
}

}  // namespace tactus::scene
