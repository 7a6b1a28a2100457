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

std::uint64_t ContactTables::Table::window(int x, int y) const {
  x -= low[0];
  y -= low[1];
  if (y < 0 || y >= count[1] || x >= count[0] || x <= -64) return 0;
  const std::uint64_t* row = words.data() + row_words() * static_cast<std::size_t>(y);
  if (x < 0) return row[0] << -x;
  const int word = x / 64, bit = x % 64;
  return bit == 0 ? row[word] : row[word] >> bit | row[word + 1] << (64 - bit);
}

ContactTables::ContactTables(const TargetContact& contact, Lattice lattice, std::size_t most_bytes)
    : contact_(contact), lattice_(std::move(lattice)), most_bytes_(most_bytes) {}

/// The offsets, low and high, at which the boxes of tool and target overlap.
std::array<std::array<int, 3>, 2> ContactTables::offsets(int tool_turn, int target_turn) const {
  const geometry::Box of_tool =
      turned(contact_.bodies().body(tool).tree().box(), lattice_.tool_turns[tool_turn]).inflated(contact_.margin());
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
    if (contact_.reach(tool, target_from_tool, contact_.margin()).hit) table.fill(x, y, 1, 1);
    return;
  }
  if (!contact_.reach(tool, target_from_tool, contact_.margin() + farthest).hit) return;
  if (contact_.reach(tool, target_from_tool, -farthest).hit) return table.fill(x, y, size_x, size_y);
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

/// The tables along a motion for targets at one turn and z. Where turn and z stay the same, so does the table.
std::vector<ContactTables::TablePtr> ContactTables::tables_along(const LatticeMotion& motion, int target_turn,
                                                                 int z) const {
  std::vector<TablePtr> tables(motion.size());
  for (std::size_t k = 1; k < motion.size(); ++k)
    tables[k] = k > 1 && motion[k].turn == motion[k - 1].turn && motion[k].at[2] == motion[k - 1].at[2]
                    ? tables[k - 1]
                    : table({motion[k].turn, target_turn, z - motion[k].at[2]});
  return tables;
}

FirstContacts ContactTables::first_contacts(const LatticeMotion& motion) const {
  std::vector<std::vector<std::pair<std::uint32_t, std::uint64_t>>> found(motion.size());
  const std::size_t row_words = lattice_.row_words();
  const int in_last_word = lattice_.count[0] % 64;
  const std::uint64_t last_word = in_last_word == 0 ? ~std::uint64_t{0} : (std::uint64_t{1} << in_last_word) - 1;
  std::size_t row = 0;
  for (int turn = 0; turn < static_cast<int>(lattice_.target_turns.size()); ++turn)
    for (int z = 0; z < lattice_.count[2]; ++z) {
      const std::vector<TablePtr> tables = tables_along(motion, turn, z);
      for (int y = 0; y < lattice_.count[1]; ++y, ++row)
        for (std::size_t w = 0; w < row_words; ++w) {
          std::uint64_t left = w + 1 == row_words ? last_word : ~std::uint64_t{0};
          for (std::size_t k = 1; k < motion.size() && left != 0; ++k) {
            const std::uint64_t touched =
                left & tables[k]->window(static_cast<int>(64 * w) - motion[k].at[0], y - motion[k].at[1]);
            if (touched == 0) continue;
            found[k].emplace_back(static_cast<std::uint32_t>(row * row_words + w), touched);
            left &= ~touched;
          }
        }
    }
  FirstContacts result;
  for (const auto& at_waypoint : found) {
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
  hash = mixed(hash, lattice_.pitch);
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
