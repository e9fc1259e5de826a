#include "wearwell/models/clutch/fleet_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/workers.h"
#include "wearwell/models/clutch/clutch_sql.h"
#include "wearwell/models/clutch/fleet_check.h"
#include "wearwell/models/clutch/fleet_columns.h"
#include "wearwell/models/clutch/fleet_days.h"
#include "wearwell/models/clutch/fleet_loop.h"
#include "wearwell/models/clutch/kept_sums.h"

namespace wearwell::clutch {
namespace {

void refuse_repeated(const fleet::Engine& engine, const UnitSums& sums) {
  if (sums.repeated > 0)
    throw InputError(fmt::format("{}: unit {} has {:.0f} cycles with a repeated number",
                                 engine.source(), printable(sums.unit), sums.repeated));
}

/// Now, and after fractions of the mean number of cycles so far, in round numbers.
std::vector<double> horizons_of(double mean_cycles) {
  std::vector<double> horizons = {0};
  for (const double share : {0.25, 0.5, 1.0}) {
    const double n = share * mean_cycles, digit = std::pow(10, std::floor(std::log10(n)));
    const double rounded = std::max(1.0, std::round(n / digit) * digit);
    if (rounded > horizons.back()) horizons.push_back(rounded);
  }
  return horizons;
}

/// The progress of one engine.
struct Shard {
  fleet::Engine& engine;
  ClutchSql sql = {};
  SqlSource source = {};
  double rows = 0;
  std::string ranges = {};
  FleetOutliers outliers = {};
  LeftOut left_out = {};
};

/// A summand that does not fit its column.
[[noreturn]] void explain(Shard& shard, const InputError& error) {
  const std::string_view said = error.what();
  // rethrown unchanged: it may be a Lost
  if (said.find("out of range") == std::string_view::npos) throw;
  if (shard.ranges.empty()) {
    LeftOut again{.asked = shard.left_out.asked};
    shard.ranges = check_rows(shard.engine, shard.sql, shard.source, again).ranges;
  }
  throw InputError(
      fmt::format("{}: the wear of a cycle exceeds the range of the sums, or is not a number; "
                  "check the readings. They are: {} ({})",
                  shard.engine.source(), shard.ranges, said));
}

/// The engine as one whose rows the built-in loop sums; nullptr if statements do.
fleet::ColumnEngine* columns_of(fleet::Engine& engine, const FleetRequest& request) {
  return request.statements ? nullptr : dynamic_cast<fleet::ColumnEngine*>(&engine);
}

/// With the built-in loop: it checks all rows while it sums.
void sum_shard_by_loop(Shard& shard, fleet::ColumnEngine& columns, const IdentifiedModel& model,
                       const FleetRequest& request, bool full, const Monitor& monitor) {
  const LoopFindings found = sum_by_loop(shard.engine, columns, shard.sql, model.model,
                                         {.replicates = full,
                                          .first = request.first,
                                          .skip_bad = request.skip_bad,
                                          .units_in_memory = request.units_in_memory},
                                         monitor);
  shard.rows = found.rows;
  shard.outliers = found.outliers;
  const double bad = found.refused + found.nameless;
  if (found.rows == 0 || bad > 0) {
    check_rows(shard.engine, shard.sql, shard.source, shard.left_out);
    if (found.rows > 0 && shard.left_out.rows == bad) return;
    throw InputError(fmt::format("{} changed while it was read", shard.engine.source()));
  }
}

/// In portions, if an engine must hold in memory what it sorts.
void sum_by_statements(Shard& shard, const IdentifiedModel& model, const FleetRequest& request,
                       SqlSource source, bool full, const Monitor& monitor) {
  if (source.staged)
    source.portions = static_cast<int>(std::ceil(shard.rows / request.portion_rows));
  for (; source.portion < source.portions; ++source.portion) {
    const std::string query =
        source.portions == 1
            ? shard.sql.query
            : clutch_sql(model.model, model.id, shard.engine.dialect(), source, full).query;
    shard.engine.run(query, monitor, "cycles", static_cast<long long>(shard.rows));
  }
}

/// All steps up to the sums of its units, once.
void try_shard(Shard& shard, const IdentifiedModel& model, const FleetRequest& request, bool full,
               const Monitor& monitor) {
  fleet::Engine& engine = shard.engine;
  SqlSource source;
  source.table = engine.table();
  source.first = request.first || request.read_only;
  source.read_only = request.read_only;
  source.inlined = engine.dialect() == fleet::Dialect::postgresql;
  source.skip_invalid = request.skip_bad;
  shard.left_out = {.asked = request.skip_bad};
  source.prefix = request.prefix;
  source.staged = engine.dialect() == fleet::Dialect::clickhouse;
  engine.begin();
  read_fleet_columns(request.columns, engine.columns(), engine.source(), source);
  engine.refuse_split_units(source.unit.name);
  shard.sql = clutch_sql(model.model, model.id, engine.dialect(), source, full);
  shard.source = source;
  fleet::ColumnEngine* const columns = columns_of(engine, request);
  if (!columns) {
    const FleetCheck check = check_rows(engine, shard.sql, source, shard.left_out);
    shard.rows = check.rows;
    shard.ranges = check.ranges;
    shard.outliers = check.outliers;
  }
  if (request.read_only) return;
  try {
    // ClickHouse has no transaction that would remove the tables again.
    const bool before = engine.dialect() == fleet::Dialect::clickhouse;
    if (before) refuse_other_layout(engine, shard.sql, request.prefix);
    engine.run(shard.sql.setup, {}, "", 0);
    if (!request.first) {
      if (!before) refuse_other_layout(engine, shard.sql, request.prefix);
      refuse_others(engine, shard.sql, model.id, request.prefix);
      refuse_late(engine, shard.sql);
    }
    if (columns) {
      sum_shard_by_loop(shard, *columns, model, request, full, monitor);
    } else {
      sum_by_statements(shard, model, request, source, full, monitor);
    }
  } catch (const InputError& error) {
    explain(shard, error);
  }
}

/// The same, on a replica if a server is lost.
void sum_shard(Shard& shard, const IdentifiedModel& model, const FleetRequest& request, bool full,
               const Monitor& monitor) {
  constexpr int tries = 3;
  for (int i = 1;; ++i) {
    try {
      return try_shard(shard, model, request, full, monitor);
    } catch (const fleet::Lost&) {
      if (i == tries) throw;
    }
  }
}

/// Requested horizons, with now added; else from the mean number of cycles.
std::vector<double> horizons_for(const FleetRequest& request, const std::vector<Shard>& shards) {
  std::vector<double> horizons = request.horizons;
  if (horizons.empty()) {
    double units = 0, cycles = 0;
    for (const Shard& shard : shards) {
      shard.engine.rows(shard.sql.size, 0, [&](const fleet::Row& row) {
        units += row.numbers[0];
        cycles += row.numbers[1];
      });
    }
    return horizons_of(cycles / units);
  }
  if (horizons.front() != 0) horizons.insert(horizons.begin(), 0);
  return horizons;
}

/// Forecasts of many units at a time.
void count_units(std::vector<Shard>& shards, std::size_t replicates, FleetDays& days,
                 FleetCounts& counts, std::vector<UnitRow>& rows, const Monitor& monitor) {
  constexpr std::size_t together = 8192;
  const int threads = threads_or_all(monitor.threads);
  std::vector<UnitSums> units;
  std::vector<double> per_day;
  const auto count = [&] {
    if (monitor.stop.stop_requested()) throw Cancelled();
    for (UnitRow& each : counts.add(units, per_day, threads)) rows.push_back(std::move(each));
    units.clear();
    per_day.clear();
  };
  for (Shard& shard : shards) {
    try {
      shard.engine.rows(shard.sql.totals, 1, [&](const fleet::Row& row) {
        units.push_back(unit_sums(row, replicates));
        refuse_repeated(shard.engine, units.back());
        if (days.known) per_day.push_back(days.of(units.back().unit));
        if (units.size() == together) count();
      });
    } catch (const InputError& error) {
      explain(shard, error);
    }
    count();
  }
}

void refuse_split(const std::vector<UnitRow>& units) {
  std::vector<const std::string*> names;
  for (const UnitRow& each : units) names.push_back(&each.unit);
  std::sort(names.begin(), names.end(), [](auto a, auto b) { return *a < *b; });
  const auto twice =
      std::adjacent_find(names.begin(), names.end(), [](auto a, auto b) { return *a == *b; });
  if (twice != names.end())
    throw InputError(
        fmt::format("unit {} has cycles in more than one of the databases: all rows of a unit must "
                    "be in one (distribute them by unit)",
                    printable(**twice)));
}

}  // namespace

Result find_fleet(const IdentifiedModel& model, const std::vector<fleet::Engine*>& engines,
                  const FleetRequest& request, const Monitor& monitor) {
  const bool full = request.replicates && !model.model.replicates.empty();
  std::vector<Shard> shards;
  for (fleet::Engine* engine : engines) shards.push_back({*engine});
  run_workers(static_cast<int>(shards.size()), [&](int i) {
    // The progress of one engine stands for all.
    sum_shard(shards[static_cast<std::size_t>(i)], model, request, full,
              i == 0 ? monitor : Monitor{.progress = {}, .stop = monitor.stop});
  });
  FleetFindings found;
  found.version = WEARWELL_VERSION;
  found.model_id = model.id;
  found.files = request.files;
  found.replicates = full;
  const ClutchSql& sql = shards.front().sql;
  found.statements = request.read_only ? sql.totals : sql.setup + sql.query;
  found.left_out.asked = request.skip_bad;
  if (columns_of(*engines.front(), request))
    found.statements =
        fleet::comment("Summed by the program's built-in loop. The statements give the same.") +
        found.statements;
  for (const Shard& shard : shards) {
    found.engine += (found.engine.empty() ? "" : ", ") + shard.engine.description();
    found.rows += shard.rows;
    found.outliers.add(shard.outliers);
    found.left_out.add(shard.left_out);
    if (found.layout.empty()) found.layout = shard.engine.layout();
    if (request.files.empty()) found.files.push_back(shard.engine.source());
  }
  std::vector<double> levels;
  for (const double percent : request.levels) levels.push_back(percent / 100);
  for (const Shard& shard : shards) found.days.read(shard.engine, shard.sql, shard.source);
  found.days.finish();
  if (!request.days.empty() && !found.days.known)
    throw InputError(
        "--days: the cycles per day of units are unknown: add --columns time=COLUMN with the time "
        "of a cycle, or cycles_per_day=COLUMN");
  FleetCounts counts(
      model.model, full, levels, horizons_for(request, shards),
      found.days.known && request.days.empty() ? std::vector<double>{30, 90, 365} : request.days);
  count_units(shards, full ? model.model.replicates.size() : 0, found.days, counts, found.units,
              monitor);
  refuse_split(found.units);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    // Only then it costs another look at the rows.
    if (inputs[i].value != &OperatingPoint::temperature || counts.outside()[i] < counts.cycles())
      continue;
    for (const Shard& shard : shards)
      refuse_other_temperature(shard.engine, shard.sql, shard.source, model.model);
  }
  worst_first(found.units);
  Result result = fleet_result(model.model, counts, found);
  for (const Shard& shard : shards) {
    if (!shard.sql.keep.empty()) shard.engine.run(shard.sql.keep, {}, "", 0);
  }
  for (const Shard& shard : shards) shard.engine.commit();
  return result;
}

}  // namespace wearwell::clutch
