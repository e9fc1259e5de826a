// ClickHouse's variants of the statements.
#include <fmt/format.h>

#include "wearwell/models/clutch/sql_writer.h"

namespace wearwell::clutch {

/// Inserting the same rows twice changes nothing: they are read by their largest value. Its client
/// needs them in one line.
std::string SqlWriter::setup_of_clickhouse(const std::string& rows) const {
  std::string sums;
  for (const char* each : count_names) sums += fmt::format(",\n  {} {}", each, types_.whole);
  for (const std::string& each : sum_names()) sums += fmt::format(",\n  {} {}", each, types_.sum);
  return fmt::format(
      "set max_query_size = 16777216, max_ast_elements = 1000000, max_expanded_ast_elements = "
      "10000000;\n"
      "create table if not exists {0} (\n"
      "  model String, replicate Int32, name String, value Float64) engine = ReplacingMergeTree "
      "order by (model, replicate, name);\n"
      "-- One row per unit and run of statement 2. Never run statement 2 twice at the same time: "
      "nothing here prevents it.\n"
      "create table if not exists {1} (\n"
      "  model String, unit String, after_cycle Int64, last_cycle Int64{2}) engine = MergeTree "
      "order by (model, unit, after_cycle);\n"
      "{4}insert into {0} (model, replicate, name, value) values{3};\n",
      model_table_, sums_table_, sums, rows,
      source_.staged
          ? fmt::format("create temporary table {} (model String, unit String, after_cycle Int64, "
                        "last_cycle Int64{});\n",
                        fresh_table_, sums)
          : "");
}

/// In one block, which is inserted completely or not at all.
std::string SqlWriter::keep() const {
  if (!source_.staged) return "";
  return fmt::format(
      "set min_insert_block_size_rows = 1000000000, min_insert_block_size_bytes = 1000000000000, "
      "max_threads = 1;\ninsert into {0} ({1}) select {1} from {2};\n",
      sums_table_, kept_names(), fresh_table_);
}

/// The rows first, from shards perhaps; then the sums, which are local. Column names are unique,
/// since ClickHouse 18.16 needs that for a join across shards, and current servers do not accept
/// names of the outer SELECT. A join without a match gives 0.
std::string SqlWriter::fresh_of_clickhouse(const std::string& rows) const {
  return fmt::format(
      "select *, wearwell_unit as unit, wearwell_after as after_cycle, wearwell_energy as "
      "energy_before\nfrom (\n{}\n) as new_rows all left join (\n  select unit as wearwell_unit, "
      "max(last_cycle) as wearwell_after, sum(energy) as wearwell_energy from {} where model = {} "
      "group by unit\n) as last using wearwell_unit\nwhere cycle > wearwell_after",
      rows, sums_table_, id_);
}

/// ClickHouse of 2018 has no window functions: the cycles of a unit are a sorted array. Sorted rows
/// come in blocks of a bounded size; arrays would come all at once, and each value of a row is a
/// column of the block.
std::string SqlWriter::ordered_by_arrays() const {
  const std::string row =
      "cycle, valid, slip_speed, torque, temperature, closing_time, fixed_energy";
  return fmt::format(
      "select unit, after_cycle, cycle, valid, slip_speed, torque, temperature, closing_time, "
      "fixed_energy,\n  energy_before + toDecimal128(passed, 0) as before, cycle_before\n"
      "from (\nselect unit, any(after_cycle) as after_cycle, any(energy_before) as energy_before,\n"
      "  arraySort(x -> x.1, groupArray(({}))) as r\nfrom (\n{}\n) as checked\ngroup by unit\n"
      "having throwIf(sum(toFloat64(fixed_energy)) > 9e18) = 0\n) as units\narray join r.1 as "
      "cycle, "
      "r.2 as valid, r.3 as slip_speed, r.4 as torque, r.5 as temperature, r.6 as closing_time,\n"
      "  r.7 as fixed_energy, arrayMap((c, x) -> c - x, arrayCumSum(r.7), r.7) as passed,\n"
      "  arrayPopBack(arrayPushFront(arrayMap(x -> toInt64(x), r.1), toInt64(0))) as cycle_before\n"
      "order by unit",
      row, checked());
}

}  // namespace wearwell::clutch
