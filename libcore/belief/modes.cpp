// SPDX-License-Identifier: BSD-3-Clause
#include "belief/modes.hpp"

#include <cmath>
#include <map>
#include <numbers>

namespace tactus::belief {
namespace {

using Index = std::array<int, 6>;  ///< of a box as large as the coarsest cell

/// Such boxes that hold cells, joined with their neighbours into modes.
class Neighbourhoods {
 public:
  Neighbourhoods(const scene::Prior& prior, const PoseVector& half) : prior_(prior), half_(half) {
    for (int d = 0; d < 6; ++d)
      count_[d] = half[d] > 0.0 ? static_cast<int>(std::lround(prior.width[d] / (2.0 * half[d]))) : 1;
  }

  void add(const Cell& cell) { groups_.try_emplace(index_of(cell), groups_.size()); }

  /// After the last `add`.
  void join() {
    for (std::size_t i = 0; i < groups_.size(); ++i) leader_.push_back(i);
    for (const auto& [index, group] : groups_)
      for (int d = 0; d < 6; ++d)
        if (const auto next = groups_.find(after(index, d)); next != groups_.end())
          leader_[leader_of(group)] = leader_of(next->second);
  }

  std::size_t mode_of(const Cell& cell) { return leader_of(groups_.at(index_of(cell))); }

 private:
  Index index_of(const Cell& cell) const {
    Index index{};
    for (int d = 0; d < 6; ++d)
      if (half_[d] > 0.0)
        index[d] =
            std::min(count_[d] - 1,
                     static_cast<int>((cell.centre[d] - prior_.centre[d] + 0.5 * prior_.width[d]) / (2.0 * half_[d])));
    return index;
  }

  /// The neighbour along a dimension; a full turn's last cell is beside its first.
  Index after(Index index, int d) const {
    const bool closes = d > 2 && prior_.width[d] > 2.0 * std::numbers::pi - 1e-9;
    ++index[d];
    if (closes && index[d] == count_[d]) index[d] = 0;
    return index;
  }

  std::size_t leader_of(std::size_t group) {
    while (leader_[group] != group) group = leader_[group] = leader_[leader_[group]];
    return group;
  }

  const scene::Prior& prior_;
  PoseVector half_;
  Index count_{};
  std::map<Index, std::size_t> groups_;
  std::vector<std::size_t> leader_;
};

/// Sums over the cells of a mode; angles as seen from its first cell.
struct Tally {
  PoseVector first{}, sum{}, low{}, high{};
  double weight = 0.0;

  void add(const Cell& cell, const PoseVector& half, double cell_weight) {
    if (weight == 0.0) first = cell.centre, low.fill(1e300), high.fill(-1e300);
    weight += cell_weight;
    for (int d = 0; d < 6; ++d) {
      const double value = d < 3 ? cell.centre[d] : scene::nearest_angle(cell.centre[d], first[d]);
      sum[d] += cell_weight * value;
      low[d] = std::min(low[d], value - half[d]);
      high[d] = std::max(high[d], value + half[d]);
    }
  }

  Mode mode(double total) const {
    Mode mode;
    mode.mass = weight / total;
    for (int d = 0; d < 6; ++d) {
      mode.mean[d] = d < 3 ? sum[d] / weight : scene::nearest_angle(sum[d] / weight, 0.0);
      mode.extent[d] = high[d] - low[d];
    }
    return mode;
  }
};

}  // namespace

std::vector<Mode> modes_of(const CellBelief& cells, const scene::Prior& prior) {
  PoseVector half{};
  double total = 0.0;
  const auto for_each = [&](const auto& visit) {
    cells.for_each([&](const Cell& cell) {
      if (cell.bits <= negligible_bits) visit(cell, cells.half_width(cell), cells.weight(cell));
    });
  };
  for_each([&](const Cell&, const PoseVector& widths, double weight) {
    for (int d = 0; d < 6; ++d) half[d] = std::max(half[d], widths[d]);
    total += weight;
  });
  Neighbourhoods neighbourhoods(prior, half);
  for_each([&](const Cell& cell, const PoseVector&, double) { neighbourhoods.add(cell); });
  neighbourhoods.join();
  std::map<std::size_t, Tally> tallies;
  for_each([&](const Cell& cell, const PoseVector& widths, double weight) {
    tallies[neighbourhoods.mode_of(cell)].add(cell, widths, weight);
  });
  std::vector<Mode> modes;
  for (const auto& [leader, tally] : tallies) modes.push_back(tally.mode(total));
  std::stable_sort(modes.begin(), modes.end(), [](const Mode& a, const Mode& b) { return a.mass > b.mass; });
  return modes;
}

}  // namespace tactus::belief
