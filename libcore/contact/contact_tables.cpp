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

constexpr support::Seal seal{{'t', 'a', 'c', 't', 'u', 's', 'L', 'T'}, 2};
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
  const kernel::SetKernel& kernel = kernel::fastest_set_kernel();
  std::vector<std::size_t> counts(waypoints() + 1);
  std::size_t touched = 0;
  for (std::size_t k = 0; k < waypoints(); ++k) {
    const Words& at = touched_[k];
    const auto end = static_cast<std::uint32_t>(at.filled);
    std::uint32_t count = 0;
    kernel.count({at.word.data(), at.cells.data()}, &end, 1, possible.words().data(), &count);
    counts[k] = count;
    touched += count;
  }
  counts.back() = possible.count() - touched;
  return counts;
}

Bitset FirstContacts::after_contact(const Bitset& possible, std::size_t waypoint) const {
  Bitset left(possible.size());
  const Words& at = touched_[waypoint];
  for (std::size_t i = 0; i < at.filled; ++i) left.set_word(at.word[i], possible.words()[at.word[i]] & at.cells[i]);
  return left;
}

Bitset FirstContacts::after_none(const Bitset& possible) const {
  Bitset left = possible;
  for_each_touched([&](std::size_t word, std::uint64_t cells) { left.set_word(word, left.words()[word] & ~cells); });
  return left;
}

/// Adds those of some words that are not zero; the first is number `first`, and each next `step` farther.
void FirstContacts::Words::add(std::size_t first, std::size_t step, const std::vector<std::uint64_t>& added,
                               std::size_t count) {
  if (word.size() < filled + count) {
    word.resize(2 * filled + count);
    cells.resize(word.size());
  }
  for (std::size_t i = 0; i < count; ++i) {
    word[filled] = static_cast<std::uint32_t>(first + step * i);
    cells[filled] = added[i];
    filled += added[i] != 0;
  }
}

void FirstContacts::Words::trim() {
  word.resize(filled);
  cells.resize(filled);
}

void ContactTables::Table::fill(int x, int y, int size_x, int size_y) {
  const auto rows = static_cast<std::size_t>(count[1]);
  for (int column = x; column < x + size_x; ++column) {
    std::uint64_t* const word = words.data() + rows * (static_cast<std::size_t>(column) / 64 + 1);
    for (int row = y; row < y + size_y; ++row) word[row] |= std::uint64_t{1} << column % 64;
  }
}

/// The words of all rows in which the offset x stands; x >= -64 and less than there are.
const std::uint64_t* ContactTables::Table::column(int x) const {
  return words.data() + static_cast<std::size_t>(count[1]) * static_cast<std::size_t>((x + 64) / 64);
}

ContactTables::ContactTables(const TargetContact& contact, Lattice lattice, double threshold, std::size_t most_bytes)
    : contact_(contact), lattice_(std::move(lattice)), threshold_(threshold), most_bytes_(most_bytes) {}

/// The offsets, low and high, at which the boxes of tool and target overlap.
std::array<std::array<int, 3>, 2> ContactTables::offsets(int way, int target_turn) const {
  geometry::Box of_tool = turned(contact_.bodies().body(tool).tree().box(), lattice_.tool_turns[lattice_.turn_of(way)])
                              .inflated(std::max(0.0, threshold_));
  of_tool.low += lattice_.past(way);
  of_tool.high += lattice_.past(way);
  const geometry::Box of_target = turned(contact_.field().tree().box(), lattice_.target_turns[target_turn]);
  std::array<std::array<int, 3>, 2> range;
  for (int d = 0; d < 3; ++d) {
    range[0][d] = static_cast<int>(std::floor((of_tool.low[d] - of_target.high[d]) / lattice_.pitch[d]));
    range[1][d] = static_cast<int>(std::ceil((of_tool.high[d] - of_target.low[d]) / lattice_.pitch[d]));
  }
  return range;
}

/// Decides all offsets of a rectangle at once where its middle allows it, else by halves.
void ContactTables::decide(const Key& key, int x, int y, int size_x, int size_y, Table& table) const {
  const int middle_x = x + size_x / 2, middle_y = y + size_y / 2;
  const Pose target_from_tool =
      lattice_.target_from_tool({table.low[0] + middle_x, table.low[1] + middle_y, key[2]}, key[1], key[0]);
  const double farthest = std::hypot(lattice_.pitch.x() * std::max(middle_x - x, x + size_x - 1 - middle_x),
                                     lattice_.pitch.y() * std::max(middle_y - y, y + size_y - 1 - middle_y));
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
  table.words.assign(table.columns() * static_cast<std::size_t>(table.count[1]), 0);
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
  Along(const ContactTables& tables, const LatticeMotion& motion) : tables_(tables) {
    for (const LatticePose& pose : motion) stands_.push_back(tables.lattice_.stand(pose));
    std::vector<int> ways;
    int low = stands_.front().at[2], high = low;
    for (const Lattice::Stand& stand : stands_) {
      low = std::min(low, stand.at[2]), high = std::max(high, stand.at[2]);
      const auto met = std::find(ways.begin(), ways.end(), stand.way);
      way_.push_back(static_cast<std::size_t>(met - ways.begin()));
      if (met == ways.end()) ways.push_back(stand.way);
    }
    lowest_ = -high;
    offsets_ = static_cast<std::size_t>(tables.lattice_.count[2] + high - low);
    met_.resize(offsets_ * ways.size());
  }

  void start(int target_turn) {
    target_turn_ = target_turn;
    std::fill(met_.begin(), met_.end(), nullptr);
  }

  const std::array<int, 3>& stand(std::size_t waypoint) const { return stands_[waypoint].at; }

  const Table& at(std::size_t waypoint, int z) {
    const int offset = z - stands_[waypoint].at[2];
    TablePtr& table = met_[way_[waypoint] * offsets_ + static_cast<std::size_t>(offset - lowest_)];
    if (!table) table = tables_.table({stands_[waypoint].way, target_turn_, offset});
    return *table;
  }

 private:
  const ContactTables& tables_;
  std::vector<Lattice::Stand> stands_;
  std::vector<std::size_t> way_;  ///< by waypoint: of those met
  int target_turn_ = 0;
  int lowest_ = 0;
  std::size_t offsets_ = 0;
  std::vector<TablePtr> met_;
};

/// The cells of one turn and z that have not been touched: a word's rows stand side by side.
struct ContactTables::Layer {
  explicit Layer(const Lattice& lattice)
      : rows(static_cast<std::size_t>(lattice.count[1])), columns(lattice.row_words()), taken(rows) {
    all.assign(rows * columns, ~std::uint64_t{0});
    if (const int rest = lattice.count[0] % 64; rest != 0)
      std::fill(all.end() - static_cast<std::ptrdiff_t>(rows), all.end(), (std::uint64_t{1} << rest) - 1);
  }
  void start(std::size_t word) {
    first_word = word;
    left = all;
  }

  std::size_t rows, columns;
  std::size_t first_word = 0;
  std::vector<std::uint64_t> all, left, taken;
};

/// Takes those cells that a tool which stands at `tool` touches out of a layer.
void ContactTables::take_touched(const Table& table, const std::array<int, 3>& tool, Layer& layer,
                                 FirstContacts::Words& touched) const {
  const int low_y = tool[1] + table.low[1];
  const int begin = std::max(0, low_y), end = std::min(lattice_.count[1], low_y + table.count[1]);
  if (begin >= end || table.words.empty()) return;
  const auto rows = static_cast<std::size_t>(end - begin);
  for (std::size_t w = 0; w < layer.columns; ++w) {
    const int x = 64 * static_cast<int>(w) - tool[0] - table.low[0];
    if (x <= -64 || x >= table.count[0]) continue;
    const std::uint64_t* const low = table.column(x) + (begin - low_y);
    std::uint64_t* const left = layer.left.data() + layer.rows * w + begin;
    if (kernel_.take(low, low + table.count[1], (x + 64) % 64, rows, left, layer.taken.data()) == 0) continue;
    touched.add(layer.first_word + layer.columns * static_cast<std::size_t>(begin) + w, layer.columns, layer.taken,
                rows);
  }
}

FirstContacts ContactTables::first_contacts(const LatticeMotion& motion) const {
  FirstContacts result(motion.size());
  if (motion.size() < 2) return result;
  Along tables(*this, motion);
  Layer layer(lattice_);
  std::size_t word = 0;
  for (int turn = 0; turn < static_cast<int>(lattice_.target_turns.size()); ++turn) {
    tables.start(turn);
    for (int z = 0; z < lattice_.count[2]; ++z, word += layer.rows * layer.columns) {
      layer.start(word);
      for (std::size_t k = 1; k < motion.size(); ++k)
        take_touched(tables.at(k, z), tables.stand(k), layer, result.touched_[k]);
    }
  }
  for (FirstContacts::Words& words : result.touched_) words.trim();
  return result;
}

std::uint64_t ContactTables::fingerprint() const {
  std::uint64_t hash =
      mixed(mixed(mixed(1, contact_.target()), contact_.bodies().body(tool).mesh()), contact_.margin());
  hash = mixed(mixed(hash, threshold_), lattice_.parts);
  for (const double pitch : lattice_.pitch) hash = mixed(hash, pitch);
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
  if (key[0] < 0 || key[0] >= lattice_.ways() || key[1] < 0 || key[1] >= static_cast<int>(lattice_.target_turns.size()))
    in.fail("key", "way " + std::to_string(key[0]) + " and turn " + std::to_string(key[1]), "those of the lattice");
  const Table fresh = blank(key);
  if (table.low != fresh.low || table.count != fresh.count || table.words.size() != fresh.words.size())
    in.fail("words", std::to_string(table.words.size()) + " words", std::to_string(fresh.words.size()));
}

void ContactTables::restore(const std::uint8_t* bytes, std::size_t size) const {
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
