// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "belief/belief.hpp"

namespace tactus::belief {
namespace {

constexpr std::size_t least_trial = 24;       // projections after which it is asked whether they pay:
constexpr std::size_t pays_from = 3;          // one in so many misses the history by no more than `finest_part`
constexpr double least_near = 0.001;          // m by which a pose may miss the history and serve for planning
constexpr double near_share = 0.15;           // of a cell's radius by which it may
constexpr std::size_t draws_per_pose = 4;     // from cells, many of which may be ruled out
constexpr std::size_t lots_per_pose = 6;      // of fine parts, most of which may turn out to be empty
constexpr double finest_part = 0.00025;       // m: radius of the parts that poses are drawn from; a pose that misses
                                              // the history by no more serves as well as an exact one
constexpr double least_step = -6.0;           // log2 of how much of a cell's width
constexpr std::size_t least_share = 3;        // of the poses wanted: so many are made up from others
constexpr std::size_t unproved_share = 8;     // of them anywhere in a cell, for what no other speaks for
constexpr std::size_t samples_per_pose = 40;  // of draws from the prior
constexpr std::size_t tries_per_pose = 2;     // of those that come near, to agree with the history

/// A motion that met nothing would have met it. Such a pose is left out: moved out of the way it would be just beside
/// what was swept, as would all others like it, and promise a contact to whatever the robot does next.
bool was_missed(const Task& task, const std::vector<Trace>& history, const Pose& pose) {
  return std::any_of(history.begin(), history.end(), [&](const Trace& trace) {
    return !trace.contact && !trace.doubted && !reproduces(task, trace, pose);
  });
}

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

  std::vector<Drawn> poses(const std::vector<Drawn>& known) {
    bring_back(known);
    from_cells();
    if (close_.size() >= count_ / least_share) return chosen(0);
    from_fine_parts();
    if (size() >= count_) return chosen(0);
    from_coarse_parts();
    from_neighbours();
    return chosen(count_ / unproved_share);
  }

 private:
  bool was_missed(const PoseVector& v) const {
    return belief::was_missed(belief_.task(), belief_.history(), geometry::pose_from(v));
  }
  std::size_t size() const { return close_.size() + near_poses_.size(); }
  bool lacks(std::size_t wanted) const { return size() < wanted && deadline_.used_fraction() < 0.5; }

  void add(const Projection& found) { (found.miss <= finest_part ? close_ : near_poses_).push_back(found); }
  void add_projected(const PoseVector& from) {
    if (const auto found = projected(belief_.task(), belief_.history(), from, near_)) add(*found);
  }
  /// A pose from a cell, brought into agreement with the contacts unless it can't be far from that. False if a motion
  /// that met nothing rules it out.
  bool add_from(const Cell& cell) {
    const PoseVector pose = cells_.draw_in(cell, rng_);
    const double radius = cells_.radius(cell);
    if (was_missed(pose)) return false;
    if (radius > fine_radius)
      add_projected(pose);
    else
      add({pose, reproduces(belief_.task(), belief_.history(), geometry::pose_from(pose)) ? 0.0 : radius});
    return true;
  }

  void from_cells() {
    const std::size_t before = close_.size();
    std::size_t tried = 0;
    for (std::size_t drawn = 0; drawn < draws_per_pose * count_ && tried < count_ && lacks(count_); ++drawn) {
      if (tried >= least_trial && (close_.size() - before) * pays_from < tried) break;
      tried += add_from(cells_.draw_cell(rng_));
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

  /// Those of an earlier state, as far as they agree with what was felt since; a part of those wanted is drawn afresh.
  void bring_back(const std::vector<Drawn>& known) {
    for (std::size_t i = 0; i < known.size() && lacks(count_ - count_ / least_share); ++i)
      if (const PoseVector pose = geometry::pose_vector(known[i].pose); !was_missed(pose)) add_projected(pose);
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
    return i < close_.size() ? close_[i].pose : near_poses_[i - close_.size()].pose;
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
  std::vector<Drawn> chosen(std::size_t unproved) {
    std::vector<Drawn> poses;
    for (const std::vector<Projection>* found : {&close_, &near_poses_})
      for (const auto& [v, miss] : *found)
        if (const Pose pose = geometry::pose_from(v);
            poses.size() + unproved < count_ && (miss == 0.0 || belief_.contains(pose)))
          poses.push_back({pose, miss});
    for (std::size_t i = 0; i < unproved || poses.size() < count_ / least_share; ++i) {
      const Cell cell = cells_.draw_cell(rng_);
      poses.push_back({geometry::pose_from(cells_.draw_in(cell, rng_)), cells_.radius(cell)});
    }
    return poses;
  }

  const Belief& belief_;
  const CellBelief& cells_;
  std::size_t count_;
  double near_;
  support::Rng& rng_;
  const support::Deadline& deadline_;
  std::vector<Projection> close_, near_poses_;
};

}  // namespace

std::vector<Pose> poses_of(const std::vector<Drawn>& drawn) {
  std::vector<Pose> poses;
  for (const Drawn& one : drawn) poses.push_back(one.pose);
  return poses;
}

std::vector<Drawn> Belief::draw(std::size_t count, support::Rng& rng, const std::vector<Drawn>& known,
                                const support::Deadline& deadline) const {
  if (weighed_) return draw_explained(count, rng, deadline);
  return Draw(*this, count, rng, deadline).poses(known);
}

/// Of fine parts drawn by weight: exactly as the explanation of the part has it where that can be had.
std::vector<Drawn> Belief::draw_explained(std::size_t count, support::Rng& rng,
                                          const support::Deadline& deadline) const {
  std::vector<Drawn> poses;
  const auto parts = weighed_->draw_parts(task(), history_, count, finest_part, rng, deadline);
  for (const WeighedCells::Weighed& part : parts) {
    const std::vector<const Trace*> traces = WeighedCells::explained(history_, part.doubts);
    const auto found = projected(task(), traces, part.cell.centre, least_near);
    poses.push_back({geometry::pose_from(found ? found->pose : part.cell.centre), found ? found->miss : least_near});
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
    if (!may_reproduce(task(), history_, pose, radius) || was_missed(task(), history_, pose)) continue;
    ++tried;
    if (const auto found = projected(task(), history_, geometry::pose_vector(pose), least_near))
      poses.push_back(geometry::pose_from(found->pose));
  }
  return poses;
}

}  // namespace tactus::belief
