// SPDX-License-Identifier: BSD-3-Clause
#include "belief/cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

#include "belief/cell_tables.hpp"
#include "support/parallel.hpp"

namespace tactus::belief {
namespace {

constexpr std::size_t shared_out = 256;  // parts of a grid among threads
constexpr double gimbal_lock = 1e-6;     // of the pitch's cosine: roll and yaw show no more than their sum
constexpr double widening = 1.02;        // of cells, until there are few enough

using Counts = std::array<int, 6>;

Counts counts(const scene::Prior& prior, double position, double angle) {
  constexpr double most = 1e9;
  Counts count{};
  for (int d = 0; d < 6; ++d)
    count[d] = static_cast<int>(std::clamp(std::ceil(prior.width[d] / (d < 3 ? position : angle) - 1e-9), 1.0, most));
  return count;
}

double product(const Counts& count) {
  double all = 1.0;
  for (const int n : count) all *= n;
  return all;
}

}  // namespace

std::size_t CellShape::cells() const { return static_cast<std::size_t>(product(count)); }

std::array<int, 6> CellShape::order() const {
  int first = 0;
  const auto in_plane = [this](int d) { return 1.0 * count[d] * count[(d + 1) % 3]; };
  for (int d = 1; d < 3; ++d)
    if (in_plane(d) > in_plane(first)) first = d;
  return {3, 4, 5, (first + 2) % 3, (first + 1) % 3, first};
}

CellShape cell_shape(const scene::Prior& prior, double position, double angle, std::size_t most) {
  CellShape shape;
  shape.count = counts(prior, position, angle);
  while (product(shape.count) > static_cast<double>(most))
    shape.count = counts(prior, position *= widening, angle *= widening);
  for (int d = 0; d < 6; ++d) {
    shape.corner[d] = prior.centre[d] - 0.5 * prior.width[d];
    shape.half[d] = 0.5 * prior.width[d] / shape.count[d];
  }
  return shape;
}

/// Halves boxes until they are decided.
class CellGrid::Sieve {
 public:
  Sieve(CellGrid& grid, const Task& task, const Excludes& excludes)
      : grid_(grid),
        task_(task),
        excludes_(excludes),
        cell_radius_(scene::cell_radius(grid.shape_.half, grid.reach_)) {}

  void sift(Part part) {
    std::vector<Part> open{std::move(part)};
    while (!open.empty()) {
      Part next = std::move(open.back());
      open.pop_back();
      decide(std::move(next), open);
    }
  }

  /// Drops a part or leaves it, as a whole; else its halves, which are still to be decided, join `open`.
  void decide(Part part, std::vector<Part>& open) {
    const Box& box = part.box;
    if (!grid_.any_in(box)) return;
    PoseVector centre, half, to_centres;
    bool is_cell = true;
    for (int d = 0; d < 6; ++d) {
      half[d] = grid_.shape_.half[d] * (box.high[d] - box.low[d]);
      centre[d] = grid_.shape_.corner[d] + grid_.shape_.half[d] * (box.low[d] + box.high[d]);
      to_centres[d] = half[d] - grid_.shape_.half[d];
      is_cell = is_cell && box.high[d] - box.low[d] == 1;
    }
    const Boxes cells{scene::cell_radius(half, grid_.reach_), cell_radius_,
                      scene::cell_radius(to_centres, grid_.reach_)};
    const Pose pose = geometry::pose_from(centre);
    if ((excludes_ && excludes_(pose, cells.radius)) || !agree(part.claims, pose, cells, is_cell))
      return grid_.drop(box);
    if (is_cell || (part.claims.empty() && !excludes_)) return;
    const auto [low, high] = halves(box, half);
    open.push_back({low, part.claims});
    open.push_back({high, std::move(part.claims)});
  }

 private:
  /// Takes out the claims that every cell may meet; false if one is met by none.
  bool agree(std::vector<Claim>& claims, const Pose& pose, const Boxes& cells, bool is_cell) const {
    for (auto claim = claims.begin(); claim != claims.end();) {
      const Fit found = is_cell ? (claim->may_be_met(task_, pose, cells.own) ? Fit::some : Fit::none)
                                : claim->narrow(task_, pose, cells);
      if (found == Fit::none) return false;
      claim = found == Fit::all ? claims.erase(claim) : claim + 1;
    }
    return true;
  }

  /// Along the dimension that moves the target's points most.
  std::array<Box, 2> halves(const Box& box, const PoseVector& half) const {
    int widest = 0;
    double most = -1.0;
    for (int d = 0; d < 6; ++d) {
      const double moves = d < 3 ? half[d] : half[d] * grid_.reach_;
      if (box.high[d] - box.low[d] > 1 && moves > most) most = moves, widest = d;
    }
    std::array<Box, 2> parts{box, box};
    parts[0].high[widest] = parts[1].low[widest] = (box.low[widest] + box.high[widest]) / 2;
    return parts;
  }

  CellGrid& grid_;
  const Task& task_;
  const Excludes& excludes_;
  double cell_radius_;
};

CellGrid::CellGrid(const CellShape& shape, double reach)
    : shape_(shape), order_(shape.order()), reach_(reach), members_(shape.cells(), true), left_(shape.cells()) {}

void CellGrid::assign(Bitset members) {
  members_ = std::move(members);
  left_ = members_.count();
}

PoseVector CellGrid::centre(std::size_t member) const {
  PoseVector v;
  for (int i = 5; i >= 0; --i) {
    const int d = order_[i];
    const auto n = static_cast<std::size_t>(shape_.count[d]);
    v[d] = shape_.corner[d] + shape_.half[d] * (2.0 * static_cast<double>(member % n) + 1.0);
    member /= n;
  }
  return v;
}

/// Calls `row(begin, end)` for each row of a box, until it returns false.
template <typename Row>
void CellGrid::for_each_row(const Box& box, Row&& row) const {
  int along = 5;
  while (along > 0 && shape_.count[order_[along]] == 1) --along;
  std::array<int, 6> at = box.low;
  for (;;) {
    std::size_t begin = 0;
    for (const int d : order_)
      begin = begin * static_cast<std::size_t>(shape_.count[d]) + static_cast<std::size_t>(at[d]);
    if (!row(begin, begin + static_cast<std::size_t>(box.high[order_[along]] - box.low[order_[along]]))) return;
    int i = along - 1;
    while (i >= 0 && ++at[order_[i]] == box.high[order_[i]]) at[order_[i]] = box.low[order_[i]], --i;
    if (i < 0) return;
  }
}

bool CellGrid::any_in(const Box& box) const {
  bool any = false;
  for_each_row(box, [&](std::size_t begin, std::size_t end) {
    any = members_.any_in(begin, end);
    return !any;
  });
  return any;
}

/// The numbers as they are: no other turns are tried.
bool CellGrid::any_near(const PoseVector& v, double tolerance) const {
  Box box;
  for (int d = 0; d < 6; ++d) {
    const double off = v[d] - shape_.corner[d], width = 2.0 * shape_.half[d];
    if (width <= 0.0) {
      if (std::abs(off) > tolerance) return false;
      box.high[d] = 1;
      continue;
    }
    box.low[d] = static_cast<int>(std::clamp(std::floor((off - tolerance) / width), 0.0, 1.0 * shape_.count[d]));
    box.high[d] = static_cast<int>(std::clamp(std::floor((off + tolerance) / width) + 1.0, 0.0, 1.0 * shape_.count[d]));
    if (box.low[d] >= box.high[d]) return false;
  }
  return any_in(box);
}

bool CellGrid::holds(const Pose& base_from_target, double tolerance) const {
  constexpr double turn = 2.0 * std::numbers::pi;
  PoseVector usual = geometry::pose_vector(base_from_target);
  if (std::abs(std::cos(usual[4])) < gimbal_lock)
    return !members_.all_of([&](std::size_t member) {
      return !scene::box_holds(centre(member), shape_.half, base_from_target, tolerance);
    });
  PoseVector over = usual;
  over[3] += std::numbers::pi, over[4] = std::numbers::pi - usual[4], over[5] += std::numbers::pi;
  for (PoseVector v : {usual, over}) {
    for (int d = 3; d < 6; ++d) v[d] = scene::nearest_angle(v[d], shape_.corner[d] + shape_.half[d] * shape_.count[d]);
    for (int turns = 0; turns < 27; ++turns) {
      PoseVector turned = v;
      turned[3] += turn * (turns % 3 - 1), turned[4] += turn * (turns / 3 % 3 - 1), turned[5] += turn * (turns / 9 - 1);
      if (any_near(turned, tolerance)) return true;
    }
  }
  return false;
}

void CellGrid::drop(const Box& box) {
  for_each_row(box, [&](std::size_t begin, std::size_t end) {
    members_.reset_in(begin, end);
    return true;
  });
}

void CellGrid::sift(const Task& task, const std::vector<const Trace*>& traces, const Excludes& excludes,
                    const CellTables* tables, int threads) {
  std::vector<Trace> rests;
  rests.reserve(traces.size());
  std::vector<Claim> claims;
  for (const Trace* trace : traces) {
    if (tables != nullptr && tables->serves(*trace)) {
      tables->sift(*trace, members_);
      rests.push_back(tables->rest(*trace));
      trace = &rests.back();
    }
    if (!trace->path.empty()) claims.emplace_back(*trace);
  }
  std::stable_partition(claims.begin(), claims.end(), std::mem_fn(&Claim::of_contact));
  if (!claims.empty() || excludes) sift(task, {{{}, shape_.count}, std::move(claims)}, excludes, threads);
  left_ = members_.count();
}

/// Level by level until there are enough parts to share out; each thread drops cells of its own copy.
void CellGrid::sift(const Task& task, Part whole, const Excludes& excludes, int threads) {
  Sieve sieve(*this, task, excludes);
  std::vector<Part> parts{std::move(whole)};
  while (!parts.empty() && parts.size() < shared_out) {
    std::vector<Part> halves;
    for (Part& part : parts) sieve.decide(std::move(part), halves);
    parts = std::move(halves);
  }
  const CellGrid before = *this;
  std::mutex mutex;
  support::for_ranges(parts.size(), threads, [&](std::size_t begin, std::size_t end) {
    CellGrid own = before;
    Sieve own_sieve(own, task, excludes);
    for (std::size_t i = begin; i < end; ++i) own_sieve.sift(std::move(parts[i]));
    const std::lock_guard lock(mutex);
    members_ &= own.members_;
  });
}

}  // namespace tactus::belief
