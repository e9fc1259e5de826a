#include <fmt/format.h>
#include <fmt/ranges.h>

#include "wearwell/models/clutch/sql_writer.h"

namespace wearwell::clutch {

using fleet::number;

static constexpr int newton_steps = 8;

/// The sums of each unit over all runs, in SI.
std::string SqlWriter::unit_sums() const {
  SqlColumns inner, outer;
  outer.keep("unit");
  inner.keep("unit");
  // ClickHouse would take the new name for the column within the sum.
  const auto add = [&](const std::string& sum, const std::string& name, const std::string& factor) {
    inner.add(fleet::real(dialect_, sum) + factor, "total_" + name);
    outer.add("total_" + name, name);
  };
  add("max(last_cycle)", "last_cycle", "");
  for (const char* each : count_names) add(fmt::format("sum({})", each), each, "");
  const auto add_sum = [&](const std::string& name, double unit) {
    add(fmt::format("sum({})", name), name, " * " + number(unit));
  };
  add_sum("energy", units_.energy);
  add_sum("volume", units_.fine);
  add_sum("variance", units_.variance);
  add_sum("settled", units_.fine);
  for (std::size_t i = 0; i < 4; ++i)
    add_sum(std::string("sum_") + input_columns[i], units_.inputs[i]);
  for (const char letter : {'v', 's'}) {
    for (std::size_t b = 1; b <= replicates_; ++b)
      add_sum(fmt::format("{}{}", letter, b), units_.volume);
  }
  return fmt::format(
      "select\n  {}\nfrom (\nselect\n  {}\nfrom {} where model = {} group by unit\n) as totals",
      outer.text(), inner.text(), known_sums(), id_);
}

std::string SqlWriter::known_sums() const {
  if (source_.read_only) return fmt::format("(\n{}\n) as all_sums", sums());
  if (!source_.staged) return sums_table_;
  return fmt::format("(select {0} from {1} union all select {0} from {2}) as known", kept_names(),
                     sums_table_, fresh_table_);
}

std::string SqlWriter::totals() const {
  return unit_sums();
}

/// Volume of replicate b after `n` more cycles of the unit's own mean duty; run-in as a geometric
/// series.
std::string SqlWriter::future(std::size_t b, const std::string& volume, const std::string& settled,
                              const std::string& n) const {
  const auto mode = [&](const char* name, const char* scale) {
    return fmt::format("{}{} * (1e0 - {})", name, b,
                       fleet::decay(dialect_, fmt::format("-{} * duty_energy / {}", n,
                                                          parameters_.column(b, scale))));
  };
  return fmt::format("({} + {} * {} / cycles + {} + {})", volume, n, settled,
                     mode("slow_left", "slow_energy"), mode("fast_left", "fast_energy"));
}

/// Nested SELECTs: sums, the remaining run-in, Newton's steps to the worn-out volume.
std::string SqlWriter::wear() const {
  SqlColumns duty;
  duty.add("energy / cycles", "duty_energy");
  std::string squares = "0e0";
  for (std::size_t b = 1; b <= replicates_; ++b)
    squares += fmt::format(" + (v{0} - volume) * (v{0} - volume)", b);
  duty.add(fmt::format("({}) / {}", squares,
                       number(static_cast<double>(std::max<std::size_t>(replicates_, 1)))),
           "model_variance");
  std::string text =
      fmt::format("select sums.*,{}\n  {}\nfrom (\n{}\n) as sums{}\nwhere cycles > 0{}",
                  parameter_columns(), duty.text(), unit_sums(), with_parameters(), fence());

  SqlColumns left;
  for (std::size_t b = 0; b <= replicates_; ++b) {
    const std::string settled = b == 0 ? "settled" : fmt::format("s{}", b);
    for (const char* mode : {"slow", "fast"}) {
      const std::string scale = parameters_.column(b, fmt::format("{}_energy", mode));
      left.add(
          fmt::format("{} / cycles * {} * {} / (1e0 - {})", settled, parameters_.column(b, mode),
                      fleet::decay(dialect_, "-energy / " + scale),
                      fleet::decay(dialect_, "-duty_energy / " + scale)),
          fmt::format("{}_left{}", mode, b));
    }
  }
  text = fmt::format("select *,\n  {},\n  0e0 as n0\nfrom (\n{}\n) as duty{}", left.text(), text,
                     fence());
  const auto slope = [&](const std::string& n) {
    std::string sum = "settled / cycles";
    for (const char* mode : {"slow", "fast"}) {
      const std::string scale = parameters_.column(0, fmt::format("{}_energy", mode));
      sum += fmt::format(" + {}_left0 * duty_energy / {} * {}", mode, scale,
                         fleet::decay(dialect_, fmt::format("-{} * duty_energy / {}", n, scale)));
    }
    return sum;
  };
  // The volume is a concave function of n: from the left, Newton's steps never overshoot.
  for (int i = 0; i < newton_steps; ++i) {
    const std::string n = fmt::format("n{}", i);
    text = fmt::format(
        "select *, case when volume < {0} and settled > 0 then {1} + ({0} - {2}) / ({3}) end as "
        "n{4}\nfrom (\n{5}\n) as step{4}{6}",
        parameters_.column(0, "worn_out"), n, future(0, "volume", "settled", n), slope(n), i + 1,
        text, fence());
  }
  const std::string n = fmt::format("n{}", newton_steps);
  std::string off = "0e0";
  for (std::size_t b = 1; b <= replicates_; ++b)
    off += fmt::format(" + power({} - {}, 2)",
                       future(b, fmt::format("v{}", b), fmt::format("s{}", b), n),
                       parameters_.column(0, "worn_out"));
  return fmt::format(
      "select *,\n  {0} as life_left,\n  sqrt(variance * (1e0 + {0} / cycles)) / ({1}) as "
      "life_sd_scatter,\n  sqrt(variance * (1e0 + {0} / cycles) + ({2}) / {3} + power({4} * {5}, "
      "2)) / "
      "({1}) as life_sd_full\nfrom (\n{6}\n) as life{7}",
      n, slope(n), off, number(static_cast<double>(std::max<std::size_t>(replicates_, 1))),
      parameters_.column(0, "plate_sd"), parameters_.column(0, "worn_out"), text, fence());
}

std::string SqlWriter::combine() const {
  const std::string mm3_of = " * 1e9";
  const std::string worn_out = parameters_.column(0, "worn_out");
  const std::string full = fmt::format("sqrt(variance + model_variance + power({} * volume, 2))",
                                       parameters_.column(0, "plate_sd"));
  SqlColumns columns;
  columns.keep("unit");
  columns.keep("cycles");
  columns.keep("last_cycle");
  columns.keep("energy");
  columns.add("volume" + mm3_of, "volume_mm3");
  const auto interval = [&](const std::string& sd, const std::string& name) {
    columns.add(sd + mm3_of, fmt::format("sd_{}_mm3", name));
    columns.add(fmt::format("(volume - 2e0 * {}){}", sd, mm3_of), fmt::format("{}_low_mm3", name));
    columns.add(fmt::format("(volume + 2e0 * {}){}", sd, mm3_of), fmt::format("{}_high_mm3", name));
  };
  interval("sqrt(variance)", "scatter");
  interval(full, "full");
  columns.add("volume / " + worn_out, "worn");
  columns.add(fmt::format("case when volume >= {} then 0e0 else life_left end", worn_out),
              "life_left");
  for (const char* each : {"scatter", "full"}) {
    columns.add(fmt::format("greatest(life_left - 2e0 * life_sd_{}, 0e0)", each),
                fmt::format("life_left_{}_low", each));
    columns.add(fmt::format("life_left + 2e0 * life_sd_{}", each),
                fmt::format("life_left_{}_high", each));
  }
  for (const char* each : count_names) {
    if (std::string(each) != "cycles") columns.keep(each);
  }
  return fmt::format(
      "-- 3. Combine: wear of each unit with its intervals of 95 % (volume +- 2 standard "
      "deviations): by the scatter of cycles, and by\n"
      "-- the total uncertainty. life_left: cycles until it is worn out, at its own mean duty; its "
      "interval is that of the volume then over the\n"
      "-- wear rate then. Cycles outside the calibrated range are counted, not left out. Rows that "
      "are\n"
      "-- refused (no value, not positive) are left out, and repeated cycles are counted twice: if "
      "either is not 0, do not use the answer.{}\n"
      "select\n"
      "  {}\n"
      "from (\n"
      "{}\n"
      ") as wear\n"
      "order by worn desc;\n",
      replicates_ == 0 ? "\n"
                         "-- No replicates: the full interval includes scatter and plate only."
                       : "",
      columns.text(), wear());
}

std::string SqlWriter::size() const {
  // All rows are new: their sums are not needed for their number.
  if (source_.read_only)
    return fmt::format("select {}, {} from (\n{}\n) as si where unit is not null and {}",
                       fleet::real(dialect_, "count(distinct unit)"),
                       fleet::real(dialect_, "count(*)"), si(false), valid());
  return fmt::format(
      "select {}, {} from (select unit, sum(cycles) as cycles from {} where model = {} group by "
      "unit) "
      "as sums",
      fleet::real(dialect_, "count(*)"), fleet::real(dialect_, "sum(cycles)"), known_sums(), id_);
}

std::string SqlWriter::late() const {
  std::string table = source_.table, unit = fleet::text(dialect_, this->unit());
  std::string cycle = cell(source_.cycle.name);
  const char* join = "inner";
  if (source_.skip_invalid) {
    table = fmt::format("(select * from (\n{}\n) as si where {})", si(false), valid());
    unit = clickhouse() ? "t.unit" : fleet::text(dialect_, "t.unit");
    cycle = "t.cycle";
    join = clickhouse() ? "left" : "inner";
  } else if (clickhouse()) {
    // ClickHouse 18.16 loses a joined table's name across shards, and fails if the right side of an
    // inner join is empty; a left join gives 0 there, and no cycle has the number 0.
    table = fmt::format("(select {} as unit, {} as cycle from {} as t)", unit, cycle, table);
    unit = "t.unit";
    cycle = "t.cycle";
    join = "left";
  }
  return fmt::format(
      "select unit, found, counted from (\nselect last.unit as unit, {} as found, {} as counted\n"
      "from {} as t {} join (\n  select unit, max(last_cycle) as after_cycle, sum(cycles) as "
      "counted from {} where model = {} group by unit\n) as last on last.unit = {}\nwhere {} <= "
      "last.after_cycle group by last.unit\n) as late where found <> counted order by unit limit 3",
      fleet::real(dialect_, "count(*)"), fleet::real(dialect_, "max(last.counted)"), table, join,
      sums_table_, id_, unit, cycle);
}

/// Adds to a unit's existing row, unless another run has counted in between.
std::string SqlWriter::adding() const {
  if (clickhouse()) return "";
  std::vector<std::string> sets;
  for (const std::string& each : sums_columns()) {
    if (each == "model" || each == "unit") continue;
    const bool place = each == "after_cycle" || each == "last_cycle";
    sets.push_back(place ? fmt::format("{0} = excluded.{0}", each)
                         : fmt::format("{0} = kept.{0} + excluded.{0}", each));
  }
  return fmt::format(
      "\non conflict (model, unit) do update set\n  {}\nwhere kept.last_cycle = "
      "excluded.after_cycle",
      fmt::join(sets, ",\n  "));
}

std::string SqlWriter::times() const {
  if (source_.time.empty() && source_.per_day.empty()) return "";
  const std::string unit = this->unit();
  const std::string nothing = clickhouse() ? "nan" : fmt::format("cast(null as {})", types_.real);
  SqlColumns columns;
  columns.add(
      clickhouse() ? fmt::format("ifNull(toString({}), '')", unit) : fleet::text(dialect_, unit),
      "wearwell_unit");
  if (source_.time.empty()) {
    for (const char* each : {"first_time", "last_time", "timed", "clock"})
      columns.add(nothing, each);
  } else {
    const bool duckdb = dialect_ == fleet::Dialect::duckdb;
    std::string time = "t." + fleet::identifier(dialect_, source_.time);
    // An unreadable time is an error with --skip-bad too: without it a unit would seem to run less.
    if (duckdb && source_.text_decimal) time = fmt::format("nullif(trim({}), '')", time);
    if (duckdb) time = fmt::format("cast({} as timestamp)", time);
    columns.add(fleet::seconds(dialect_, fmt::format("min({})", time)), "first_time");
    columns.add(fleet::seconds(dialect_, fmt::format("max({})", time)), "last_time");
    columns.add(fleet::real(dialect_, fmt::format("count({})", time)), "timed");
    // Texts that are dates have no time of day other than 0.
    columns.add(duckdb ? fmt::format("cast(max(epoch({}) % 86400) as double)", time) : nothing,
                "clock");
  }
  columns.add(source_.per_day.empty()
                  ? nothing
                  : fleet::real(dialect_, fmt::format("avg({})", cell(source_.per_day))),
              "per_day");
  return fmt::format("select\n  {}\nfrom {} as t group by {}", columns.text(), source_.table,
                     clickhouse() ? "wearwell_unit" : unit);
}

std::string SqlWriter::stream() const {
  SqlColumns columns;
  columns.add(unit(), "unit");
  columns.add(fleet::real(dialect_, cell(source_.cycle.name)), "cycle");
  for (std::size_t i = 0; i < 4; ++i) columns.add(in_si(source_.inputs[i]), input_columns[i]);
  columns.add(in_si(source_.energy), "energy");
  return fmt::format("select\n  {}\nfrom {} as t", columns.text(), source_.table);
}

std::string SqlWriter::known() const {
  constexpr const char* half = "4294967296";
  return fmt::format("select unit, {}, {}, {} from {} where model = {}",
                     fleet::real(dialect_, "last_cycle"),
                     fleet::real(dialect_, fmt::format("energy // {}", half)),
                     fleet::real(dialect_, fmt::format("energy % {}", half)), sums_table_, id_);
}

std::string SqlWriter::fresh() const {
  std::string columns;
  for (const char* each : count_names) columns += fmt::format(", {} {}", each, types_.whole);
  for (const std::string& each : sum_names()) columns += fmt::format(", {} {}", each, types_.sum);
  return fmt::format(
      "create or replace temp table {} (unit {}, after_cycle {}, last_cycle {}{});\n", fresh_table,
      types_.text, types_.whole, types_.whole, columns);
}

std::string SqlWriter::gather() const {
  SqlColumns columns;
  columns.keep(id_);
  columns.keep("unit");
  columns.keep("min(after_cycle)");
  columns.keep("max(last_cycle)");
  for (const char* each : count_names) columns.keep(fmt::format("sum({})", each));
  for (const std::string& each : sum_names()) columns.keep(fmt::format("sum({})", each));
  return fmt::format("insert into {} as kept ({})\nselect\n  {}\nfrom {}\ngroup by unit{};\n",
                     sums_table_, fmt::join(sums_columns(), ", "), columns.text(), fresh_table,
                     adding());
}

std::string SqlWriter::layout() const {
  const std::string table = fleet::literal(dialect_, sums_table_);
  switch (dialect_) {
    case fleet::Dialect::duckdb:
      return fmt::format("select name, cast(pk as double) from pragma_table_info({})", table);
    case fleet::Dialect::postgresql:
      return fmt::format(
          "select cast(a.attname as text), case when a.attnum = any(i.indkey) then 1e0 else 0e0 "
          "end "
          "from pg_catalog.pg_attribute as a left join pg_catalog.pg_index as i on i.indrelid = "
          "a.attrelid and i.indisprimary where a.attrelid = to_regclass({}) and a.attnum > 0 and "
          "not "
          "a.attisdropped",
          table);
    case fleet::Dialect::clickhouse:
      break;
  }
  return "describe table " + sums_table_;
}

std::string SqlWriter::exists() const {
  return clickhouse() ? "exists table " + sums_table_ : "";
}

}  // namespace wearwell::clutch
