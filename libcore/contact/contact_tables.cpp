// SPDX-License-Identifier: BSD-3-Clause
#include "contact/contact_tables.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "contact/solid.hpp"
#include "support/error.hpp"
#include "support/rng.hpp"

namespace tactus::contact {
namespace {

constexpr support::Seal seal{{'t', 'a', 'c', 't', 'u', 's', 'L', 'T'}, 1};
constexpr std::size_t tool = 0;  // the body that the tables are of

std::uint64_t mixed(std::uint64_t hash, double value) {
  return support::mix(hash ^ std::bit_cast<std::uint64_t>(value));
}

std::uint64_t mixed(std::uint64_t hash, const Mesh& mesh) {
  for (const Vector3& v : mesh.vertices)
    for (const double value : v) hash = mixed(hash, value);
  for (const geometry::Triangle& t : mesh.triangles)
    for (const auto corner : t) hash = support::mix(hash ^ static_cast<std::uint64_t>(corner));
  return hash;
}

geometry::Box turned(const geometry::Box& box, const Eigen::Matrix3d& turn) {
  return moved_box(box, Pose(Eigen::Isometry3d(turn)));
}

}  // namespace

std::vector<std::size_t> FirstContacts::split(const Bitset& possible) const {
  std::vector<std::size_t> counts(waypoints() + 1);
  std::size_t touched = 0;
  for (std::size_t k = 0; k < waypoints(); ++k) {
    for (std::size_t i = begin_[k]; i < begin_[k + 1]; ++i)
      counts[k] += static_cast<std::size_t>(std::popcount(possible.words()[word_[i]] & cells_[i]));
    touched += counts[k];
  }
  counts.back() = possible.count() - touched;
  return counts;
}

Bitset FirstContacts::after_contact(const Bitset& possible, std::size_t waypoint) const {
  Bitset left(possible.size());
  for (std::size_t i = begin_[waypoint]; i < begin_[waypoint + 1]; ++i)
    left.set_word(word_[i], possible.words()[word_[i]] & cells_[i]);
  return left;
}

Bitset FirstContacts::after_none(const Bitset& possible) const {
  Bitset left = possible;
  for (std::size_t i = 0; i < word_.size(); ++i) left.set_word(word_[i], left.words()[word_[i]] & ~cells_[i]);
  return left;
}

void ContactTables::Table::fill(int x, int y, int size_x, int size_y) {
  for (int row = y; row < y + size_y; ++row)
    for (int column = x; column < x + size_x; ++column)
      words[row_words() * static_cast<std::size_t>(row) + static_cast<std::size_t>(column) / 64] |= std::uint64_t{1}
                                                                                                    << column % 64;
}

/// The bits of a row from offset x on; x > -64 and less than there are.
std::uint64_t ContactTables::Table::window(std::size_t row, int x) const {
  const std::uint64_t* first = words.data() + row_words() * row;
  if (x < 0) return first[0] << -x;
  const int word = x / 64, bit = x % 64;
  return bit == 0 ? first[word] : first[word] >> bit | first[word + 1] << (64 - bit);
}

ContactTables::ContactTables(const TargetContact& contact, Lattice lattice, double threshold, std::size_t most_bytes)
    : contact_(contact), lattice_(std::move(lattice)), threshold_(threshold), most_bytes_(most_bytes) {}

/// The offsets, low and high, at which the boxes of tool and target overlap.
std::array<std::array<int, 3>, 2> ContactTables::offsets(int tool_turn, int target_turn) const {
  const geometry::Box of_tool = turned(contact_.bodies().body(tool).tree().box(), lattice_.tool_turns[tool_turn])
                                    .inflated(std::max(0.0, threshold_));
  const geometry::Box of_target = turned(contact_.field().tree().box(), lattice_.target_turns[target_turn]);
  std::array<std::array<int, 3>, 2> range;
  for (int d = 0; d < 3; ++d) {
    range[0][d] = static_cast<int>(std::floor((of_tool.low[d] - of_target.high[d]) / lattice_.pitch));
    range[1][d] = static_cast<int>(std::ceil((of_tool.high[d] - of_target.low[d]) / lattice_.pitch));
  }
  return range;
}

/// Decides all offsets of a rectangle at once where its middle allows it, else by halves.
void ContactTables::decide(const Key& key, int x, int y, int size_x, int size_y, Table& table) const {
  const int middle_x = x + size_x / 2, middle_y = y + size_y / 2;
  const Pose target_from_tool =
      lattice_.target_from_tool({table.low[0] + middle_x, table.low[1] + middle_y, key[2]}, key[1], key[0]);
  const double farthest = lattice_.pitch * std::hypot(std::max(middle_x - x, x + size_x - 1 - middle_x),
                                                      std::max(middle_y - y, y + size_y - 1 - middle_y));
  if (farthest == 0.0) {
    if (contact_.reach(tool, target_from_tool, threshold_).hit) table.fill(x, y, 1, 1);
    return;
  }
  if (!contact_.reach(tool, target_from_tool, threshold_ + farthest).hit) return;
  if (contact_.reach(tool, target_from_tool, std::min(0.0, threshold_) - farthest).hit)
    return table.fill(x, y, size_x, size_y);
  if (size_x >= size_y) {
    decide(key, x, y, size_x / 2, size_y, table);
    decide(key, x + size_x / 2, y, size_x - size_x / 2, size_y, table);
  } else {
    decide(key, x, y, size_x, size_y / 2, table);
    decide(key, x, y + size_y / 2, size_x, size_y - size_y / 2, table);
  }
}

/// Nothing touches yet. Without rows where z is out of reach.
ContactTables::Table ContactTables::blank(const Key& key) const {
  const auto [low, high] = offsets(key[0], key[1]);
  Table table;
  if (key[2] < low[2] || key[2] > high[2]) return table;
  for (int d = 0; d < 2; ++d) {
    table.low[d] = low[d];
    table.count[d] = high[d] - low[d] + 1;
  }
  table.words.assign(table.row_words() * static_cast<std::size_t>(table.count[1]), 0);
  return table;
}

ContactTables::Table ContactTables::make(const Key& key) const {
  Table table = blank(key);
  if (!table.words.empty()) decide(key, 0, 0, table.count[0], table.count[1], table);
  return table;
}

ContactTables::TablePtr ContactTables::table(const Key& key) const {
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = tables_.find(key); found != tables_.end()) return found->second;
  }
  auto made = std::make_shared<const Table>(make(key));
  const std::size_t size = sizeof(Table) + made->words.size() * sizeof(std::uint64_t);
  const std::lock_guard lock(mutex_);
  if (bytes_ + size > most_bytes_) {
    tables_.clear();
    bytes_ = 0;
  }
  const auto [entry, is_new] = tables_.try_emplace(key, std::move(made));
  if (is_new) bytes_ += size;
  return entry->second;
}

std::size_t ContactTables::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

/// The tables at the waypoints of a motion for targets at one turn, and at one z after the other. A look into the map
/// for each offset in z that is met first, not for each waypoint.
class ContactTables::Along {
 public:
  Along(const ContactTables& tables, const LatticeMotion& motion, int target_turn)
      : tables_(tables), motion_(motion), target_turn_(target_turn) {
    const auto [low, high] = std::minmax_element(
        motion.begin(), motion.end(), [](const LatticePose& a, const LatticePose& b) { return a.at[2] < b.at[2]; });
    lowest_ = -high->at[2];
    offsets_ = static_cast<std::size_t>(tables.lattice_.count[2] + high->at[2] - low->at[2]);
    met_.resize(offsets_ * tables.lattice_.tool_turns.size());
  }

  const Table& at(std::size_t waypoint, int z) {
    const int offset = z - motion_[waypoint].at[2];
    TablePtr& table =
        met_[static_cast<std::size_t>(motion_[waypoint].turn) * offsets_ + static_cast<std::size_t>(offset - lowest_)];
    if (!table) table = tables_.table({motion_[waypoint].turn, target_turn_, offset});
    return *table;
  }

 private:
  const ContactTables& tables_;
  const LatticeMotion& motion_;
  int target_turn_;
  int lowest_ = 0;
  std::size_t offsets_ = 0;
  std::vector<TablePtr> met_;
};

/// Takes those cells of one turn and z that a tool at `tool` touches out of `left`.
void ContactTables::take_touched(const Table& table, const LatticePose& tool, std::size_t first_word,
                                 std::vector<std::uint64_t>& left, Touched& touched) const {
  if (table.words.empty()) return;
  const int row_words = static_cast<int>(lattice_.row_words());
  const int low_y = tool.at[1] + table.low[1];
  const int begin = std::max(0, low_y), end = std::min(lattice_.count[1], low_y + table.count[1]);
  for (int w = 0; w < row_words; ++w) {
    const int x = 64 * w - tool.at[0] - table.low[0];
    if (x <= -64 || x >= table.count[0]) continue;
    for (int y = begin; y < end; ++y) {
      const auto word = static_cast<std::size_t>(y * row_words + w);
      const std::uint64_t cells = left[word] & table.window(static_cast<std::size_t>(y - low_y), x);
      if (cells == 0) continue;
      touched.emplace_back(static_cast<std::uint32_t>(first_word + word), cells);
      left[word] &= ~cells;
    }
  }
}

FirstContacts ContactTables::first_contacts(const LatticeMotion& motion) const {
  std::vector<Touched> touched(motion.size());
  const std::size_t row_words = lattice_.row_words(), rows = static_cast<std::size_t>(lattice_.count[1]);
  std::vector<std::uint64_t> all(row_words * rows, ~std::uint64_t{0}), left;
  if (const int rest = lattice_.count[0] % 64; rest != 0)
    for (std::size_t y = 0; y < rows; ++y) all[(y + 1) * row_words - 1] = (std::uint64_t{1} << rest) - 1;
  std::size_t first_word = 0;
  for (int turn = 0; turn < static_cast<int>(lattice_.target_turns.size()) && motion.size() > 1; ++turn) {
    Along tables(*this, motion, turn);
    for (int z = 0; z < lattice_.count[2]; ++z, first_word += row_words * rows) {
      left = all;
      for (std::size_t k = 1; k < motion.size(); ++k)
        take_touched(tables.at(k, z), motion[k], first_word, left, touched[k]);
    }
  }
  FirstContacts result;
  for (const Touched& at_waypoint : touched) {
    for (const auto& [word, cells] : at_waypoint) {
      result.word_.push_back(word);
      result.cells_.push_back(cells);
    }
    result.begin_.push_back(result.word_.size());
  }
  return result;
}

std::uint64_t ContactTables::fingerprint() const {
  std::uint64_t hash =
      mixed(mixed(mixed(1, contact_.target()), contact_.bodies().body(tool).mesh()), contact_.margin());
  hash = mixed(mixed(hash, threshold_), lattice_.pitch);
  for (const auto* turns : {&lattice_.target_turns, &lattice_.tool_turns})
    for (const Eigen::Matrix3d& turn : *turns)
      for (const double value : turn.reshaped()) hash = mixed(hash, value);
  return hash;
}

std::vector<std::uint8_t> ContactTables::save() const {
  support::ByteWriter out(seal);
  out.u64(fingerprint());
  const std::lock_guard lock(mutex_);
  out.u64(tables_.size());
  for (const auto& [key, table] : tables_) {
    for (const int part : key) out.u32(static_cast<std::uint32_t>(part));
    for (const int part : table->low) out.u32(static_cast<std::uint32_t>(part));
    for (const int part : table->count) out.u32(static_cast<std::uint32_t>(part));
    out.u64(table->words.size());
    for (const std::uint64_t word : table->words) out.u64(word);
  }
  return out.sealed();
}

/// A restored table must have the shape that a fresh one would have.
void ContactTables::check(const support::ByteReader& in, const Key& key, const Table& table) const {
  if (key[0] < 0 || key[0] >= static_cast<int>(lattice_.tool_turns.size()) || key[1] < 0 ||
      key[1] >= static_cast<int>(lattice_.target_turns.size()))
    in.fail("key", "turns " + std::to_string(key[0]) + " and " + std::to_string(key[1]), "turns of the lattice");
  const Table fresh = blank(key);
  if (table.low != fresh.low || table.count != fresh.count || table.words.size() != fresh.words.size())
    in.fail("words", std::to_string(table.words.size()) + " words", std::to_string(fresh.words.size()));
}

void ContactTables::restore(const std::uint8_t* bytes, std::size_t size) {
  support::ByteReader in(seal, "saved contact tables", bytes, size);
  if (in.u64("fingerprint") != fingerprint())
    throw support::Error(support::Status::wrong_scenario,
                         "saved contact tables: found tables of other shapes, margin or lattice, expected this "
                         "scenario's; make them anew");
  std::map<Key, TablePtr> tables;
  std::size_t kept = 0;
  for (std::size_t left = in.count(36, "tables"); left > 0; --left) {
    Key key;
    Table table;
    for (int& part : key) part = static_cast<int>(in.u32("key"));
    for (int& part : table.low) part = static_cast<int>(in.u32("low"));
    for (int& part : table.count) part = static_cast<int>(in.u32("count"));
    table.words.resize(in.count(8, "words"));
    for (std::uint64_t& word : table.words) word = in.u64("words");
    check(in, key, table);
    kept += sizeof(Table) + table.words.size() * sizeof(std::uint64_t);
    tables.emplace(key, std::make_shared<const Table>(std::move(table)));
  }
  in.finish();
  const std::lock_guard lock(mutex_);
  tables_ = std::move(tables);
  bytes_ = kept;
}

}  // namespace tactus::contact
