// SPDX-License-Identifier: BSD-3-Clause
#include "contact/swept_voxels.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "contact/solid.hpp"

namespace tactus::contact {
namespace {

using kernel::voxels_per_block;

geometry::Box box_at(const Body& body, const Pose& base_from_body) {
  return moved_box(body.tree().box(), base_from_body);
}

kernel::VoxelField view_of(const geometry::DistanceField& field) {
  kernel::VoxelField view{};
  view.samples = field.samples().data();
  view.spacing = static_cast<float>(field.spacing());
  std::int32_t stride = 1;
  for (int d = 0; d < 3; ++d) {
    view.last[d] = static_cast<float>(field.count()[d] - 1);
    view.stride[d] = stride;
    stride *= field.count()[d];
    view.box_low[d] = static_cast<float>((field.tree().box().low[d] - field.origin()[d]) / field.spacing());
    view.box_high[d] = static_cast<float>((field.tree().box().high[d] - field.origin()[d]) / field.spacing());
  }
  return view;
}

/// A grid's voxels in blocks that do not reach beyond a layer; the last of a layer is filled up with voxels that are
/// never open.
class Blocks {
 public:
  explicit Blocks(const VoxelGrid& grid)
      : grid_(grid),
        in_layer_(grid.shape()[0] * grid.shape()[1]),
        per_layer_((in_layer_ + voxels_per_block - 1) / voxels_per_block),
        x_(static_cast<std::size_t>(per_layer_) * voxels_per_block),
        y_(x_.size()),
        open_(static_cast<std::size_t>(per_layer_) * grid.shape()[2], 0xffff) {
    for (std::size_t i = 0; i < x_.size(); ++i) {
      x_[i] = static_cast<float>(i % grid.shape()[0]);
      y_[i] = static_cast<float>(i / grid.shape()[0]);
    }
    const int beyond = per_layer_ * voxels_per_block - in_layer_;
    for (int z = 0; z < grid.shape()[2]; ++z)
      open_[static_cast<std::size_t>(z + 1) * per_layer_ - 1] = static_cast<std::uint16_t>(0xffff >> beyond);
  }

  std::size_t count() const { return open_.size(); }
  kernel::VoxelBlocks view(std::vector<float>& due) {
    return {per_layer_, x_.data(), y_.data(), open_.data(), due.data()};
  }
  void close(std::int32_t block, int lane) { open_[block] &= static_cast<std::uint16_t>(~(1U << lane)); }
  std::size_t voxel(std::int32_t block, int lane) const {
    return static_cast<std::size_t>(block / per_layer_) * in_layer_ +
           static_cast<std::size_t>(block % per_layer_) * voxels_per_block + lane;
  }

  /// The blocks with voxels in a box, in whole rows; none: the range is empty.
  kernel::BlockRange range(const geometry::Box& box) const {
    std::array<int, 3> low, high;
    grid_.range(box, low, high);
    for (int d = 0; d < 3; ++d)
      if (low[d] >= high[d]) return {};
    const int nx = grid_.shape()[0];
    return {low[2], high[2], low[1] * nx / voxels_per_block, (high[1] * nx - 1) / voxels_per_block + 1};
  }

 private:
  const VoxelGrid& grid_;
  std::int32_t in_layer_, per_layer_;
  std::vector<float> x_, y_;
  std::vector<std::uint16_t> open_;
};

/// One motion's sweep: waypoint by waypoint, body by body.
class Sweep {
 public:
  Sweep(const RobotBodies& bodies, const BodyPath& path, const VoxelGrid& grid, const kernel::VoxelKernel& kernel)
      : bodies_(bodies),
        path_(path),
        grid_(grid),
        kernel_(kernel),
        blocks_(grid),
        due_(bodies.size()),
        found_(blocks_.count()) {
    const geometry::Box region = bodies.region().inflated(BodyPath::region_margin);
    region_holds_grid_ = region.contains(grid.box().low) && region.contains(grid.box().high);
    for (std::size_t b = 0; b < bodies.size(); ++b) fields_.push_back(view_of(bodies.body(b).field()));
  }

  SweptVoxels swept() {
    for (std::size_t i = 0; i < path_.size(); ++i) {
      for (std::size_t b = 0; b < bodies_.size(); ++b)
        if (may_enter(i, b)) enter(i, b);
      close_waypoint();
    }
    return std::move(swept_);
  }

 private:
  bool may_enter(std::size_t waypoint, std::size_t body) const {
    const BodyPath::Range& near = path_.near_region(body);
    return !region_holds_grid_ || (near.begin <= waypoint && waypoint < near.end);
  }

  void enter(std::size_t waypoint, std::size_t b) {
    const Body& body = bodies_.body(b);
    const Pose& base_from_body = path_.base_from_body(waypoint, b);
    const kernel::BlockRange range = blocks_.range(box_at(body, base_from_body));
    if (range.low >= range.high) return;
    if (due_[b].empty()) due_[b].assign(blocks_.count() + voxels_per_block, -1.0f);
    const Pose body_from_base = base_from_body.inverse();
    const kernel::GridPlace place = place_of(body.field(), body_from_base, path_.travelled(path_.size() - 1, b));
    const std::int32_t count = kernel_.look(fields_[b], place, blocks_.view(due_[b]), range,
                                            static_cast<float>(path_.travelled(waypoint, b)), found_.data());
    for (std::int32_t k = 0; k < count; ++k) take(found_[k], body, body_from_base);
  }

  kernel::GridPlace place_of(const geometry::DistanceField& field, const Pose& body_from_base,
                             double longest_travel) const {
    const double per_metre = 1.0 / field.spacing();
    const Vector3 first = (body_from_base * grid_.centre(0, 0, 0) - field.origin()) * per_metre;
    const Eigen::Matrix3d step = body_from_base.linear() * (grid_.pitch() * per_metre);
    kernel::GridPlace place{};
    for (int d = 0; d < 3; ++d) {
      place.first[d] = static_cast<float>(first[d]);
      place.along_x[d] = static_cast<float>(step(d, 0));
      place.along_y[d] = static_cast<float>(step(d, 1));
      place.along_z[d] = static_cast<float>(step(d, 2));
    }
    const double farthest = first.norm() * field.spacing() + grid_.box().size().sum() + longest_travel;
    place.slack = static_cast<float>(rounding * (1.0 + farthest));
    return place;
  }

  void take(const kernel::BlockFound& found, const Body& body, const Pose& body_from_base) {
    std::uint32_t inside = found.inside;
    for (std::uint32_t rest = found.undecided; rest != 0; rest &= rest - 1) {
      const int lane = std::countr_zero(rest);
      if (!body.tree().contains(body_from_base * grid_.centre(blocks_.voxel(found.block, lane)))) continue;
      blocks_.close(found.block, lane);
      inside |= 1U << lane;
    }
    for (; inside != 0; inside &= inside - 1) add(blocks_.voxel(found.block, std::countr_zero(inside)));
  }

  void add(std::size_t voxel) {
    swept_.voxels.push_back(static_cast<std::uint32_t>(voxel));
    const auto word = static_cast<std::uint32_t>(voxel / 64);
    if (swept_.word.size() == words_before_ || swept_.word.back() != word) {
      swept_.word.push_back(word);
      swept_.mask.push_back(0);
    }
    swept_.mask.back() |= std::uint64_t{1} << (voxel % 64);
  }

  void close_waypoint() {
    words_before_ = swept_.word.size();
    swept_.entered.push_back(static_cast<std::uint32_t>(swept_.voxels.size()));
    swept_.words_by.push_back(static_cast<std::uint32_t>(words_before_));
  }

  static constexpr double rounding = 4e-6;  // of single precision, relative to the distances that it deals with

  const RobotBodies& bodies_;
  const BodyPath& path_;
  const VoxelGrid& grid_;
  const kernel::VoxelKernel& kernel_;
  Blocks blocks_;
  std::vector<kernel::VoxelField> fields_;
  std::vector<std::vector<float>> due_;  ///< by body: of all blocks, once it may enter the grid
  std::vector<kernel::BlockFound> found_;
  bool region_holds_grid_ = false;
  SweptVoxels swept_;
  std::size_t words_before_ = 0;  ///< this waypoint
};

}  // namespace

SweptVoxels swept_voxels(const RobotBodies& bodies, const BodyPath& path, const VoxelGrid& grid,
                         const kernel::VoxelKernel& kernel) {
  return Sweep(bodies, path, grid, kernel).swept();
}

std::vector<std::uint32_t> entered_of(const SweptVoxels& swept, const Bitset& set, const kernel::SetKernel& kernel) {
  std::vector<std::uint32_t> counts(swept.words_by.size());
  kernel.count({swept.word.data(), swept.mask.data()}, swept.words_by.data(), counts.size(), set.words().data(),
               counts.data());
  return counts;
}

Bitset voxels_deep_inside(const RobotBodies& bodies, const BodyPath& path, std::size_t waypoints, const VoxelGrid& grid,
                          double depth) {
  Bitset deep(grid.size());
  for (std::size_t waypoint = 0; waypoint < waypoints; ++waypoint)
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const Body& body = bodies.body(b);
      const Pose body_from_base = path.base_from_body(waypoint, b).inverse();
      grid.for_each_in(box_at(body, path.base_from_body(waypoint, b)), [&](std::size_t voxel, const Vector3& centre) {
        if (body.field().bounds(body_from_base * centre).upper < -depth) deep.set(voxel);
      });
    }
  return deep;
}

Bitset contact_candidates(const RobotBodies& bodies, const BodyPath& path, std::size_t stop, const VoxelGrid& grid,
                          double slack) {
  Bitset candidates(grid.size());
  const double near = grid.half_diagonal() + slack;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Body& body = bodies.body(b);
    const Pose body_from_base = path.base_from_body(stop, b).inverse();
    const Pose before_from_base = path.base_from_body(stop == 0 ? 0 : stop - 1, b).inverse();
    grid.for_each_in(box_at(body, path.base_from_body(stop, b)).inflated(near),
                     [&](std::size_t voxel, const Vector3& centre) {
                       const geometry::DistanceBounds at_stop = body.field().bounds(body_from_base * centre);
                       if (at_stop.lower > near || at_stop.upper < -near) return;
                       if (body.field().bounds(before_from_base * centre).upper < -near) return;
                       candidates.set(voxel);
                     });
  }
  return candidates;
}

}  // namespace tactus::contact
