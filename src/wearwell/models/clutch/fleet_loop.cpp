#include "wearwell/models/clutch/fleet_loop.h"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <array>
#include <chrono>
#include <cmath>
#include <deque>
#include <map>
#include <mutex>
#include <unordered_map>

#include "wearwell/base/error.h"
#include "wearwell/models/clutch/fixed_sum.h"

namespace wearwell::clutch {
namespace {

/// Rows in progress at once; at most 4096, so that runs of them fit into 64 bits.
constexpr std::size_t batch_rows = 4096;
constexpr std::size_t batches_in_flight = 6;
constexpr std::size_t stripes = 64;
constexpr double largest_cycle = 9e15;

/// The state of a unit within its cycles, and its sums.
struct UnitPlace {
  std::string name;
  std::int64_t after = 0, last = 0;  ///< cycles counted before; the last one
  Wide energy = 0;
  std::int64_t repeated = 0;
  std::array<std::int64_t, fixed_counts> counts{};
  std::unique_ptr<Wide[]> sums = {};
  std::size_t stripe = 0;
};

/// The results of an earlier run.
struct KnownUnit {
  std::int64_t last = 0;
  Wide energy = 0;
};

struct Batch {
  FixedCycles cycles;
  std::vector<UnitPlace*> units;  ///< by segment
};

class Loop {
 public:
  Loop(fleet::ColumnEngine& columns, const WearModel& model, bool replicates,
       const std::map<std::string, KnownUnit>& known, long long total, std::size_t most_units,
       const Monitor& monitor)
      : columns_(columns),
        sum_(model, replicates),
        known_(known),
        total_(total),
        monitor_(monitor),
        most_units_(most_units) {
    if (most_units_ > 0) return;
    const double bytes = 0x1p20 * static_cast<double>(columns.memory()) / 4;
    most_units_ = static_cast<std::size_t>(
        std::max(1000.0, bytes / static_cast<double>(sum_.sums() * sizeof(Wide))));
  }

  /// False if the cycles of a unit do not ascend, which `sorted` rows must.
  bool run(const std::string& query, bool sorted, fleet::ColumnEngine::Appender& appender);
  LoopFindings found;

 private:
  std::unique_ptr<Batch> next();
  bool take_chunk(Batch& batch);
  UnitPlace* place(std::size_t row);
  UnitPlace& add_unit(std::string name);
  bool valid(std::size_t row, double cycle) const;
  void publish(const Batch& batch, FixedSum::Workspace& workspace);
  void flush(fleet::ColumnEngine::Appender& appender);
  void tell();

  fleet::ColumnEngine& columns_;
  FixedSum sum_;
  const std::map<std::string, KnownUnit>& known_;
  const long long total_;
  const Monitor& monitor_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point reported_ = start_;
  std::size_t most_units_;

  bool sorted_ = false, ordered_ = true, more_ = true;
  std::unique_ptr<fleet::ColumnScan> scan_;
  fleet::ColumnChunk chunk_;
  UnitPlace* current_ = nullptr;
  std::int64_t current_number_ = 0;
  std::deque<UnitPlace> units_;
  std::unordered_map<std::int64_t, UnitPlace*> by_number_;
  std::unordered_map<std::string_view, UnitPlace*> by_name_;  ///< names are stored in units_
  std::array<std::mutex, stripes> mutexes_;
  std::atomic<std::size_t> held_ = 0;  ///< units with sums in memory
};

UnitPlace& Loop::add_unit(std::string name) {
  units_.emplace_back();
  UnitPlace& made = units_.back();
  made.name = std::move(name);
  made.stripe = units_.size() % stripes;
  const auto before = known_.find(made.name);
  if (before != known_.end()) {
    made.after = made.last = before->second.last;
    made.energy = before->second.energy;
  }
  return made;
}

/// The unit of a row, usually that of the previous row.
UnitPlace* Loop::place(std::size_t row) {
  if (chunk_.has_words) {
    const std::string_view word = chunk_.words[row];
    if (current_ && current_->name == word) return current_;
    const auto at = by_name_.find(word);
    if (at != by_name_.end()) return current_ = at->second;
    current_ = &add_unit(std::string(word));
    by_name_[current_->name] = current_;
    return current_;
  }
  const std::int64_t number = chunk_.numbers[row];
  if (current_ && current_number_ == number) return current_;
  current_number_ = number;
  UnitPlace*& at = by_number_[number];
  if (!at) at = &add_unit(std::to_string(number));
  return current_ = at;
}

/// As SqlWriter::valid.
bool Loop::valid(std::size_t row, double cycle) const {
  const auto positive = [&](std::size_t c) {
    const double x = chunk_.values[c][row];
    return (x > 0) & (x < 1e300);
  };
  const double temperature = chunk_.values[3][row];
  return (cycle >= 1) & (cycle <= largest_cycle) & (cycle == std::floor(cycle)) & positive(1) &
         positive(2) & positive(4) & positive(5) & (temperature >= -273.15) & (temperature < 1e300);
}

/// False if the rows need sorting.
bool Loop::take_chunk(Batch& batch) {
  FixedCycles& to = batch.cycles;
  const double scale = 1 / sum_.units().energy;
  for (std::size_t i = 0; i < chunk_.rows; ++i) {
    const double cycle = chunk_.values[0][i];
    if (!chunk_.named[i] || !valid(i, cycle)) {
      ++(chunk_.named[i] ? found.refused : found.nameless);
      continue;
    }
    UnitPlace& unit = *place(i);
    const auto number = static_cast<std::int64_t>(cycle);
    found.outliers.look_at(unit.name, number, chunk_.values[5][i],
                           closing_energy({chunk_.values[1][i], chunk_.values[2][i],
                                           chunk_.values[3][i], chunk_.values[4][i]}));
    if (number <= unit.after) continue;
    if (number <= unit.last) {
      if (!sorted_) return false;
      ++unit.repeated;
    }
    unit.last = number;
    const double energy = chunk_.values[5][i] * scale;
    if (!(energy < 9.2e18)) throw InputError("the energy of a cycle is out of range of the sums");
    const std::int64_t fixed = std::llrint(energy);
    if (batch.units.empty() || batch.units.back() != &unit) {
      if (!batch.units.empty()) to.ends.push_back(to.size());
      batch.units.push_back(&unit);
    }
    std::int64_t cell = 0;
    double at = 0;
    sum_.place(unit.energy, cell, at);
    to.cell.push_back(cell);
    to.at.push_back(at);
    to.energy.push_back(fixed);
    to.slip_speed.push_back(chunk_.values[1][i]);
    to.torque.push_back(chunk_.values[2][i]);
    to.temperature.push_back(chunk_.values[3][i]);
    to.closing_time.push_back(chunk_.values[4][i]);
    unit.energy += fixed;
  }
  found.rows += static_cast<double>(chunk_.rows);
  return true;
}

void Loop::tell() {
  if (monitor_.stop.stop_requested()) throw Cancelled();
  const auto now = std::chrono::steady_clock::now();
  if (!monitor_.progress || now - reported_ < std::chrono::milliseconds(100)) return;
  reported_ = now;
  monitor_.progress({"cycles", static_cast<long long>(found.rows), total_,
                     std::chrono::duration<double>(now - start_).count()});
}

/// Empty after the last row, if the rows need sorting, or if sums must be flushed first.
std::unique_ptr<Batch> Loop::next() {
  if (!ordered_ || !more_ || held_ > most_units_) return nullptr;
  auto batch = std::make_unique<Batch>();
  while (batch->cycles.size() + 2048 <= batch_rows) {
    tell();
    more_ = scan_->next(chunk_);
    if (!more_) break;
    ordered_ = take_chunk(*batch);
    if (!ordered_) return nullptr;
  }
  if (!batch->units.empty()) batch->cycles.ends.push_back(batch->cycles.size());
  return batch;
}

void Loop::publish(const Batch& batch, FixedSum::Workspace& workspace) {
  sum_.add(batch.cycles, workspace, [&](std::size_t segment, const FixedTotals& totals) {
    UnitPlace& unit = *batch.units[segment];
    const std::lock_guard lock(mutexes_[unit.stripe]);
    if (!unit.sums) {
      unit.sums = std::make_unique<Wide[]>(totals.sums.size());
      ++held_;
    }
    for (std::size_t c = 0; c < unit.counts.size(); ++c) unit.counts[c] += totals.counts[c];
    for (std::size_t s = 0; s < totals.sums.size(); ++s) {
      if (__builtin_add_overflow(unit.sums[s], totals.sums[s], &unit.sums[s]))
        throw InputError("the wear of a unit is out of range of the sums");
    }
  });
}

void Loop::flush(fleet::ColumnEngine::Appender& appender) {
  std::vector<std::int64_t> small;
  std::vector<Wide> large;
  for (UnitPlace& unit : units_) {
    if (!unit.sums) continue;
    unit.counts[repeated] = unit.repeated;
    unit.repeated = 0;
    small = {unit.after, unit.last};
    small.insert(small.end(), unit.counts.begin(), unit.counts.end());
    large.assign(unit.sums.get(), unit.sums.get() + sum_.sums());
    appender.add({unit.name, small, large});
    unit.counts = {};
    unit.sums.reset();
  }
  held_ = 0;
}

bool Loop::run(const std::string& query, bool sorted, fleet::ColumnEngine::Appender& appender) {
  sorted_ = sorted;
  scan_ = columns_.scan(query);
  std::mutex mutex;
  std::vector<std::shared_ptr<FixedSum::Workspace>> spare;
  const auto work = [&](const Batch& batch) {
    std::shared_ptr<FixedSum::Workspace> mine;
    {
      const std::lock_guard lock(mutex);
      if (!spare.empty()) {
        mine = std::move(spare.back());
        spare.pop_back();
      }
    }
    if (!mine) mine = sum_.workspace();
    publish(batch, *mine);
    const std::lock_guard lock(mutex);
    spare.push_back(std::move(mine));
  };
  tbb::task_arena arena(monitor_.threads > 0 ? monitor_.threads : tbb::task_arena::automatic);
  while (more_ && ordered_) {
    arena.execute([&] {
      tbb::parallel_pipeline(
          batches_in_flight,
          tbb::make_filter<void, std::shared_ptr<Batch>>(
              tbb::filter_mode::serial_in_order,
              [&](tbb::flow_control& control) -> std::shared_ptr<Batch> {
                std::shared_ptr<Batch> batch = next();
                if (!batch) control.stop();
                return batch;
              }) &
              tbb::make_filter<std::shared_ptr<Batch>, void>(
                  tbb::filter_mode::parallel, [&](const std::shared_ptr<Batch>& batch) {
                    if (!batch->units.empty()) work(*batch);
                  }));
    });
    if (ordered_) flush(appender);
  }
  return ordered_;
}

std::map<std::string, KnownUnit> known_units(fleet::Engine& engine, const ClutchSql& sql) {
  std::map<std::string, KnownUnit> known;
  engine.rows(sql.known, 1, [&](const fleet::Row& row) {
    constexpr int half = 32;
    known[row.texts.front()] = {
        static_cast<std::int64_t>(row.numbers[0]),
        (static_cast<Wide>(row.numbers[1]) << half) + static_cast<Wide>(row.numbers[2])};
  });
  return known;
}

}  // namespace

LoopFindings sum_by_loop(fleet::Engine& engine, fleet::ColumnEngine& columns, const ClutchSql& sql,
                         const WearModel& model, const LoopSettings& settings,
                         const Monitor& monitor) {
  const std::map<std::string, KnownUnit> known =
      settings.first ? std::map<std::string, KnownUnit>() : known_units(engine, sql);
  const long long total = columns.known_rows();
  for (const bool sorted : {false, true}) {
    engine.run(sql.fresh, {}, "", 0);
    const auto appender = columns.append(fresh_table);
    Loop loop(columns, model, settings.replicates, known, total, settings.units_in_memory, monitor);
    if (!loop.run(sorted ? sql.sorted : sql.stream, sorted, *appender)) continue;
    appender->finish();
    if (settings.skip_bad || loop.found.refused + loop.found.nameless == 0)
      engine.run(sql.gather, monitor, "units", 0);
    return loop.found;
  }
  throw InputError("the cycles cannot be sorted");
}

}  // namespace wearwell::clutch
