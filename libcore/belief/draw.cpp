// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "belief/belief.hpp"

namespace tactus::belief {
namespace {

constexpr std::size_t least_trial = 24;       // projections after which it is asked whether they pay:
constexpr std::size_t pays_from = 3;          // one in so many is exact
constexpr double least_near = 0.001;          // m by which a pose may miss the history and serve for planning
constexpr double near_share = 0.15;           // of a cell's radius by which it may
constexpr std::size_t lots_per_pose = 6;      // of fine parts, most of which may turn out to be empty
constexpr double finest_part = 0.00025;       // m: radius of the parts that poses are drawn from
constexpr double least_step = -6.0;           // log2 of how much of a cell's width
constexpr std::size_t least_share = 3;        // of the poses wanted: so many are made up from others
constexpr std::size_t unproved_share = 8;     // of them anywhere in a cell, for what no other speaks for
constexpr std::size_t samples_per_pose = 40;  // of draws from the prior
constexpr std::size_t tries_per_pose = 2;     // of those that come near, to agree with the history

/// Poses of a belief for planning, by what is cheapest where it works.
class Draw {
 public:
  Draw(const Belief& belief, std::size_t count, support::Rng& rng, const support::Deadline& deadline)
      : belief_(belief),
        cells_(belief.cells()),
        count_(count),
        near_(std::max(least_near, near_share * cells_.coarsest())),
        rng_(rng),
        deadline_(deadline) {}

  std::vector<Pose> poses(const std::vector<Pose>& known) {
    from_cells();
    if (exact_.size() >= count_ / least_share) return chosen(0);
    from_fine_parts();
    if (size() >= count_) return chosen(0);
    bring_back(known);
    from_coarse_parts();
    from_neighbours();
    return chosen(count_ / unproved_share);
  }

 private:
  std::size_t size() const { return exact_.size() + near_poses_.size(); }
  bool lacks(std::size_t wanted) const { return size() < wanted && deadline_.used_fraction() < 0.5; }

  void add(const PoseVector& pose, bool is_exact) { (is_exact ? exact_ : near_poses_).push_back(pose); }
  void add_projected(const PoseVector& from) {
    if (const auto found = projected(belief_.task(), belief_.history(), from, near_)) add(found->pose, found->exact);
  }
  /// A pose from a cell, brought into agreement with the history unless it can't be far from that.
  void add_from(const Cell& cell) {
    const PoseVector pose = cells_.draw_in(cell, rng_);
    if (cells_.radius(cell) > fine_radius) return add_projected(pose);
    add(pose, reproduces(belief_.task(), belief_.history(), geometry::pose_from(pose)));
  }

  void from_cells() {
    for (std::size_t tried = 0; tried < count_ && deadline_.used_fraction() < 0.5; ++tried) {
      if (tried >= least_trial && exact_.size() * pays_from < tried) break;
      add_from(cells_.draw_cell(rng_));
    }
  }

  /// Of parts that may have given the history to a quarter of a millimetre, as many by lot as are wanted.
  void from_fine_parts() {
    std::vector<Cell> parts =
        cells_.draw_parts(belief_.task(), belief_.history(), lots_per_pose * count_, finest_part, rng_, deadline_);
    std::erase_if(parts, [&](const Cell& part) { return cells_.radius(part) > fine_radius; });
    for (std::size_t i = 0; i < parts.size() && size() < count_; ++i) {
      std::swap(parts[i], parts[i + rng_.below(parts.size() - i)]);
      add_from(parts[i]);
    }
  }

  void bring_back(const std::vector<Pose>& known) {
    for (std::size_t i = 0; i < known.size() && lacks(count_ - count_ / least_share); ++i)
      add_projected(geometry::pose_vector(known[i]));
  }

  void from_coarse_parts() {
    if (!lacks(count_)) return;
    for (const Cell& part : cells_.draw_parts(belief_.task(), belief_.history(), count_, part_radius, rng_, deadline_))
      if (lacks(count_)) add_from(part);
  }

  void from_neighbours() {
    for (std::size_t tried = 0; tried < count_ && lacks(count_ / least_share) && size() > 0; ++tried)
      add_projected(beside(any()));
  }

  const PoseVector& any() {
    const std::size_t i = rng_.below(size());
    return i < exact_.size() ? exact_[i] : near_poses_[i - exact_.size()];
  }

  /// A pose up to a cell's width off another, and mostly much less.
  PoseVector beside(const PoseVector& from) {
    const Cell cell = cells_.draw_cell(rng_);
    const PoseVector inside = cells_.draw_in(cell, rng_);
    const double size = std::exp2(rng_.uniform(least_step, 1.0));
    PoseVector seed = from;
    for (int d = 0; d < 6; ++d) seed[d] += size * (inside[d] - cell.centre[d]);
    return seed;
  }

  /// All but `unproved` of those wanted; the rest are anywhere in a cell.
  std::vector<Pose> chosen(std::size_t unproved) {
    std::vector<Pose> poses;
    for (const PoseVector& v : exact_)
      if (poses.size() + unproved < count_) poses.push_back(geometry::pose_from(v));
    for (const PoseVector& v : near_poses_)
      if (const Pose pose = geometry::pose_from(v); poses.size() + unproved < count_ && belief_.contains(pose))
        poses.push_back(pose);
    for (std::size_t i = 0; i < unproved || poses.size() < count_ / least_share; ++i)
      poses.push_back(geometry::pose_from(cells_.draw_in(cells_.draw_cell(rng_), rng_)));
    return poses;
  }

  const Belief& belief_;
  const CellBelief& cells_;
  std::size_t count_;
  double near_;
  support::Rng& rng_;
  const support::Deadline& deadline_;
  std::vector<PoseVector> exact_, near_poses_;
};

}  // namespace

std::vector<Pose> Belief::draw(std::size_t count, support::Rng& rng, const std::vector<Pose>& known,
                               const support::Deadline& deadline) const {
  if (weighed_) return draw_explained(count, rng, deadline);
  return Draw(*this, count, rng, deadline).poses(known);
}

/// Of fine parts drawn by weight: exactly as the explanation of the part has it where that can be had.
std::vector<Pose> Belief::draw_explained(std::size_t count, support::Rng& rng,
                                         const support::Deadline& deadline) const {
  std::vector<Pose> poses;
  const auto parts = weighed_->draw_parts(task(), history_, count, finest_part, rng, deadline);
  for (const WeighedCells::Weighed& part : parts) {
    const std::vector<const Trace*> traces = WeighedCells::explained(history_, part.doubts);
    const auto found = projected(task(), traces, part.cell.centre, least_near);
    poses.push_back(geometry::pose_from(found ? found->pose : part.cell.centre));
  }
  return poses;
}

std::vector<Pose> Belief::draw_feasible(std::size_t count, support::Rng& rng, const support::Deadline& deadline) const {
  std::vector<Pose> poses;
  const double radius = model_->voxels->grid.half_diagonal();
  const auto lacks = [&] { return poses.size() < count && deadline.used_fraction() < 0.5; };
  std::size_t tried = 0;
  for (std::size_t i = 0; i < samples_per_pose * count && tried < tries_per_pose * count && lacks(); ++i) {
    const Pose pose = task().scene().prior.sample(rng);
    if (!may_reproduce(task(), history_, pose, radius)) continue;
    ++tried;
    if (const auto found = projected(task(), history_, geometry::pose_vector(pose), least_near))
      poses.push_back(geometry::pose_from(found->pose));
  }
  return poses;
}

}  // namespace tactus::belief
