// SPDX-License-Identifier: BSD-3-Clause
#include <numbers>

#include "bench/comparison.hpp"
#include "bench/sheet.hpp"

namespace tactus::bench {
namespace {

constexpr std::size_t usual_n = 20, fine_n = 100;
constexpr double turn = std::numbers::pi / 9.0;

std::vector<Row> straight(const Options& options) {
  std::vector<Row> rows;
  for (const std::size_t n : {usual_n, fine_n})
    rows.push_back(compare("straight", setting(free_flyer(), socket(), 0.0, n, options.pairs, options.seed), options));
  return rows;
}

std::vector<Row> turning(const Options& options) {
  return {compare("turning", setting(free_flyer(), socket(), turn, usual_n, options.pairs, options.seed), options)};
}

std::vector<Row> arm(const Options& options) {
  return {compare("arm", setting(shelf_arm(), socket(), 0.0, usual_n, options.pairs, options.seed), options)};
}

std::vector<Row> concave(const Options& options) {
  std::vector<Row> rows;
  for (const Target& target : {Target{"hook", hook()}, Target{"ring", ring()}, Target{"bracket", bracket()}})
    rows.push_back(
        compare("concave", setting(free_flyer(), target, 0.0, usual_n, options.pairs, options.seed), options));
  return rows;
}

}  // namespace

std::vector<Work> contact_works() {
  std::vector<Work> works{{"straight", straight}, {"turning", turning}, {"arm", arm}, {"concave", concave}};
  for (Work& work : lattice_works()) works.push_back(std::move(work));
  return works;
}

}  // namespace tactus::bench
