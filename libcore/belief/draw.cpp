// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "belief/belief.hpp"

namespace tactus::belief {
namespace {

using geometry::Vector3;

constexpr std::size_t least_trial = 24;       // projections after which it is asked whether they pay:
constexpr std::size_t pays_from = 3;          // one in so many serves
constexpr double least_near = 0.001;          // m by which a pose may miss the history and serve for planning
constexpr double near_share = 0.15;           // of a cell's radius by which it may
constexpr std::size_t draws_per_pose = 4;     // from cells, many of which may be ruled out
constexpr std::size_t lots_per_pose = 6;      // of fine parts, most of which may turn out to be empty
constexpr double finest_part = 0.00025;       // m: radius of the parts that poses are drawn from; a pose that misses
                                              // the history by no more serves as well as an exact one
constexpr double least_step = -6.0;           // log2 of how much of a cell's width
constexpr std::size_t least_share = 3;        // of the poses wanted: so many are made up from others
constexpr double latest_unpaid = 0.2;         // of a budget, for bringing poses back that mostly can't be
constexpr std::size_t unproved_share = 8;     // of them anywhere in a cell, for what no other speaks for
constexpr std::size_t far_share = 16;         // of them in cells that are the farthest from any other pose;
constexpr std::size_t most_compared = 30000;  // cells, if there are no more
constexpr std::size_t samples_per_pose = 40;  // of draws from the prior;
constexpr std::size_t longer = 10;            // times as many as long as there are fewer than `fewest`
constexpr std::size_t tries_per_pose = 2;     // of those that come near, to agree with the history
constexpr std::size_t fewest = 10;            // made up from those that only come near

/// A motion that met nothing would have met it. Such a pose is left out: moved out of the way it would be just beside
/// what was swept, as would all others like it, and promise a contact to whatever the robot does next.
bool was_missed(const Task& task, const std::vector<Trace>& history, const Pose& pose) {
  return std::any_of(history.begin(), history.end(), [&](const Trace& trace) {
    return !trace.contact && !trace.doubted && !reproduces(task, trace, pose);
  });
}

Drawn drawn_from(const Projection& found) { return {geometry::pose_from(found.pose), found.miss}; }

/// A pose drawn for an earlier state, brought into agreement with what was felt since; bit for bit the same if it is
/// already. None if a motion that met nothing rules it out, or it misses the history by more than `most`.
std::optional<Drawn> brought_back(const Task& task, const std::vector<Trace>& history, const Drawn& known, double most,
                                  const support::Cancellation& cancellation) {
  if (was_missed(task, history, known.pose)) return std::nullopt;
  const PoseVector from = geometry::pose_vector(known.pose);
  const auto found = projected(task, history, from, most, cancellation);
  if (!found) return std::nullopt;
  return found->pose == from ? Drawn{known.pose, found->miss} : drawn_from(*found);
}

/// Of a target; so that distances are about how far its surface is moved.
struct Place {
  Vector3 translation;
  Eigen::Quaterniond turn;
  explicit Place(const Pose& pose) : translation(pose.translation()), turn(pose.linear()) {}
  double squared_distance(const Place& other, double lever) const {
    return (translation - other.translation).squaredNorm() +
           8.0 * lever * lever * std::max(0.0, 1.0 - std::abs(turn.dot(other.turn)));
  }
};

/// Cells, the farthest from some places first.
class FarthestFirst {
 public:
  FarthestFirst(const CellBelief& cells, double lever) : lever_(lever) {
    cells.for_each([&](const Cell& cell) {
      cells_.push_back(cell);
      places_.emplace_back(geometry::pose_from(cell.centre));
    });
    squared_.assign(cells_.size(), 1e300);
  }
  void add(const Place& place) {
    for (std::size_t i = 0; i < places_.size(); ++i)
      squared_[i] = std::min(squared_[i], places_[i].squared_distance(place, lever_));
  }
  /// The farthest, which counts as one of the places from then on. None if all are nearer than `reach(cell)`.
  template <typename Reach>
  std::optional<Cell> next(Reach&& reach) {
    const auto farthest = std::max_element(squared_.begin(), squared_.end()) - squared_.begin();
    const auto i = static_cast<std::size_t>(farthest);
    const Cell cell = cells_[i];
    if (std::sqrt(squared_[i]) < reach(cell)) return std::nullopt;
    add(Place(places_[i]));
    return cell;
  }

 private:
  double lever_;
  std::vector<Cell> cells_;
  std::vector<Place> places_;
  std::vector<double> squared_;
};

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
    from_far_cells();
    from_cells();
    if (close_.size() >= count_ / least_share) return chosen(0);
    from_fine_parts();
    if (size() >= count_) return chosen(0);
    from_coarse_parts();
    from_neighbours();
    return chosen(count_ / unproved_share);
  }

 private:
  std::size_t size() const { return close_.size() + near_poses_.size(); }
  bool lacks(std::size_t wanted) const { return size() < wanted && deadline_.used_fraction() < latest_draw; }

  void add(const Drawn& found) { (found.miss <= finest_part ? close_ : near_poses_).push_back(found); }
  void add_projected(const PoseVector& from) {
    if (const auto found = projected(belief_.task(), belief_.history(), from, near_, deadline_.cancellation()))
      add(drawn_from(*found));
  }
  /// A pose from a cell, brought into agreement with the contacts unless it can't be far from that. False if a motion
  /// that met nothing rules it out.
  bool add_from(const Cell& cell) {
    deadline_.cancellation().check();
    const PoseVector v = cells_.draw_in(cell, rng_);
    const Pose pose = geometry::pose_from(v);
    const double radius = cells_.radius(cell);
    if (was_missed(belief_.task(), belief_.history(), pose)) return false;
    if (radius > fine_radius)
      add_projected(v);
    else
      add({pose, reproduces(belief_.task(), belief_.history(), pose) ? 0.0 : radius});
    return true;
  }

  void add_anywhere_in(const Cell& cell) {
    const Pose pose = geometry::pose_from(cells_.draw_in(cell, rng_));
    if (!was_missed(belief_.task(), belief_.history(), pose)) near_poses_.push_back({pose, cells_.radius(cell)});
  }

  void from_cells() {
    const std::size_t before = close_.size();
    std::size_t tried = 0;
    for (std::size_t drawn = 0; drawn < draws_per_pose * count_ && tried < count_ && lacks(count_); ++drawn) {
      if (tried >= least_trial && (close_.size() - before) * pays_from < tried) break;
      tried += add_from(cells_.draw_cell(rng_));
    }
  }

  /// Of parts that may have given the history to a quarter of a millimetre, as many by lot as are wanted. When time is
  /// up, those of fine parts are not asked for all of the history again, which takes milliseconds each where the tool
  /// is nearly seated; others are anywhere in a part that no motion swept through.
  void from_fine_parts() {
    std::vector<Cell> parts =
        cells_.draw_parts(belief_.task(), belief_.history(), lots_per_pose * count_, finest_part, rng_, deadline_);
    for (std::size_t i = 0; i < parts.size() && size() < count_ && (i < count_ || lacks(count_)); ++i) {
      std::swap(parts[i], parts[i + rng_.below(parts.size() - i)]);
      if (lacks(count_))
        add_from(parts[i]);
      else if (cells_.radius(parts[i]) <= fine_radius)
        add({geometry::pose_from(cells_.draw_in(parts[i], rng_)), cells_.radius(parts[i])});
      else
        add_anywhere_in(parts[i]);
    }
  }

  /// Those of an earlier state, as far as they agree with what was felt since; a part of those wanted is drawn afresh.
  void bring_back(const std::vector<Drawn>& known) {
    for (std::size_t tried = 0; tried < known.size() && lacks(count_ - count_ / least_share); ++tried) {
      if (size() * pays_from < tried && deadline_.used_fraction() >= latest_unpaid) return;
      if (const auto still =
              brought_back(belief_.task(), belief_.history(), known[tried], near_, deadline_.cancellation()))
        add(*still);
    }
  }

  /// However little they weigh: a planner that does not know of them takes for done what is not.
  void from_far_cells() {
    if (cells_.size() > most_compared) return;
    FarthestFirst cells(cells_, 0.5 * belief_.task().target_diameter());
    for (const std::vector<Drawn>* found : {&close_, &near_poses_})
      for (const Drawn& drawn : *found) {
        deadline_.cancellation().check();
        cells.add(Place(drawn.pose));
      }
    for (std::size_t tried = 0; tried < count_ / far_share && lacks(count_); ++tried) {
      const auto cell = cells.next([&](const Cell& one) { return 2.0 * cells_.radius(one); });
      if (!cell) return;
      add_projected(cells_.draw_in(*cell, rng_));
    }
  }

  void from_coarse_parts() {
    if (!lacks(count_)) return;
    for (const Cell& part : cells_.draw_parts(belief_.task(), belief_.history(), count_, part_radius, rng_, deadline_))
      if (lacks(count_)) add_from(part);
  }

  void from_neighbours() {
    for (std::size_t tried = 0; tried < count_ && lacks(count_ / least_share) && size() > 0; ++tried)
      add_projected(beside(geometry::pose_vector(any().pose)));
  }

  const Drawn& any() {
    const std::size_t i = rng_.below(size());
    return i < close_.size() ? close_[i] : near_poses_[i - close_.size()];
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
    for (const std::vector<Drawn>* found : {&close_, &near_poses_})
      for (const Drawn& drawn : *found) {
        deadline_.cancellation().check();
        if (poses.size() + unproved < count_ && (drawn.miss == 0.0 || belief_.contains(drawn.pose)))
          poses.push_back(drawn);
      }
    for (std::size_t i = 0; i < unproved || poses.size() < std::max<std::size_t>(1, count_ / least_share); ++i) {
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
  std::vector<Drawn> close_, near_poses_;
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

/// Of fine parts drawn by weight: exactly as the explanation of the part has it where that can be had. Of whole cells
/// if no part of those drawn is possible, as where a fault that never happens is all that explains the history.
std::vector<Drawn> Belief::draw_explained(std::size_t count, support::Rng& rng,
                                          const support::Deadline& deadline) const {
  std::vector<Drawn> poses;
  auto parts = weighed_->draw_parts(task(), history_, count, finest_part, rng, deadline);
  if (parts.empty())
    parts = weighed_->draw_parts(task(), history_, count, std::numeric_limits<double>::infinity(), rng, deadline);
  for (const WeighedCells::Weighed& part : parts) {
    const std::vector<const Trace*> traces = WeighedCells::explained(history_, part.doubts);
    const auto found = projected(task(), traces, part.cell.centre, least_near, deadline.cancellation());
    poses.push_back({geometry::pose_from(found ? found->pose : part.cell.centre), found ? found->miss : least_near});
  }
  return poses;
}

std::vector<Drawn> Belief::draw_feasible(std::size_t count, support::Rng& rng, const std::vector<Drawn>& known,
                                         const support::Deadline& deadline) const {
  std::vector<Drawn> poses, coarse;
  const double radius = model_->voxels->grid.half_diagonal();
  const auto lacks = [&](std::size_t wanted) {
    return poses.size() < wanted && deadline.used_fraction() < latest_draw;
  };
  for (std::size_t i = 0; i < known.size() && lacks(count - count / least_share); ++i)
    if (const auto still = brought_back(task(), history_, known[i], least_near, deadline.cancellation()))
      poses.push_back(*still);
  std::size_t tried = 0;
  const auto samples = [&] { return (poses.size() + coarse.size() < fewest ? longer : 1) * samples_per_pose * count; };
  for (std::size_t i = 0; i < samples() && tried < tries_per_pose * count && lacks(count); ++i) {
    deadline.cancellation().check();
    const Pose pose = task().scene().prior.sample(rng);
    if (!may_reproduce(task(), history_, pose, radius) || was_missed(task(), history_, pose)) continue;
    ++tried;
    const auto found = projected(task(), history_, geometry::pose_vector(pose), least_near, deadline.cancellation());
    found ? poses.push_back(drawn_from(*found)) : coarse.push_back({pose, radius});
  }
  for (std::size_t i = 0; i < coarse.size() && poses.size() < std::min(count, fewest); ++i) poses.push_back(coarse[i]);
  return poses;
}

}  // namespace tactus::belief
