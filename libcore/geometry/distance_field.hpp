// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_tree.hpp"

namespace tactus::geometry {

/// Bounds of a signed distance (m): negative inside the solid.
struct DistanceBounds {
  double lower = 0.0;
  double upper = 0.0;
};

/// The signed distance to a mesh: exact from its triangles, and bounded from a lattice of samples at the cost of one
/// look-up.
///
/// The distance is 1-Lipschitz, so a sample s at distance e bounds it by s - e and s + e: the bounds are sound whatever
/// the spacing. Where shells overlap, the depth inside is at least what is given (inner surfaces count as surface). An
/// open mesh has distances >= 0. Const after construction, shared by any number of threads.
class DistanceField {
 public:
  /// Samples at `spacing` metres over the mesh's box inflated by `border`; the spacing grows until there are at most
  /// `max_samples`. Cost: about 1 us a sample.
  DistanceField(const Mesh& mesh, double spacing, double border, std::size_t max_samples = 4'000'000);

  /// Bounds at any point, some tens of ns. Inside the lattice they are at most 1.74 spacings apart.
  DistanceBounds bounds(const Vector3& p) const;

  /// Bounds from the eight samples about a point, 0.7 spacings apart or so; as `bounds` outside the lattice.
  DistanceBounds narrow_bounds(const Vector3& p) const;

  /// The signed distance interpolated between samples, without a bound on its error; clamped to the lattice.
  double estimate(const Vector3& p) const;

  /// The gradient of `estimate`.
  Vector3 gradient(const Vector3& p) const;

  /// The exact signed distance, about 1 us.
  double exact(const Vector3& p) const;

  const TriangleTree& tree() const { return tree_; }
  double spacing() const { return spacing_; }
  const Vector3& origin() const { return origin_; }           ///< of the first sample
  const std::array<int, 3>& count() const { return count_; }  ///< of samples along x, y, z
  float sample(const std::array<int, 3>& i) const {
    return samples_[i[0] + count_[0] * (i[1] + std::size_t(1) * count_[1] * i[2])];
  }
  const std::vector<float>& samples() const { return samples_; }  ///< x fastest
  std::size_t bytes() const { return samples_.size() * sizeof(float); }

 private:
  /// The samples about a point.
  struct Cell {
    std::array<double, 3> part{};  ///< of a spacing beyond the lowest of them; in [0, 1] inside the lattice
    std::size_t lowest = 0;
    std::array<std::size_t, 3> step{};

    bool holds_point() const;
    std::size_t corner(unsigned bits) const;  ///< bit d: the higher one along d
  };

  Cell cell(const Vector3& p) const;
  void fill();

  TriangleTree tree_;
  double spacing_;
  Vector3 origin_;
  std::array<int, 3> count_{};
  double inverse_spacing_ = 0.0;
  std::array<double, 3> last_{};  ///< of the indices
  std::vector<float> samples_;    ///< x fastest
};

}  // namespace tactus::geometry
