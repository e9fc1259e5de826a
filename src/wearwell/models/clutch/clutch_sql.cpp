#include "wearwell/models/clutch/clutch_sql.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "wearwell/fleet/named_columns.h"
#include "wearwell/models/clutch/sql_writer.h"
#include "wearwell/models/clutch/sums_key.h"

// Longer than others: the parts of one statement in their order.
namespace wearwell::clutch {
using fleet::number;

std::string SqlColumns::text() const {
  return fmt::format("{}", fmt::join(list_, ",\n  "));
}

SqlWriter::SqlWriter(const WearModel& model, const std::string& id, fleet::Dialect dialect,
                     const SqlSource& source, bool replicates)
    : model_(model),
      dialect_(dialect),
      source_(source),
      table_key_(dialect == fleet::Dialect::duckdb ? "" : table_key(id, source)),
      id_(fleet::literal(dialect, table_key_.empty() ? id : table_key_ + columns_key(source))),
      parameters_(sql_parameters(model, replicates, source.inlined)),
      units_(fixed_units(model)),
      types_(fleet::types(dialect)),
      replicates_(replicates ? model.replicates.size() : 0),
      model_table_(fleet::table_identifier(dialect, source.prefix + "_model")),
      sums_table_(fleet::table_identifier(dialect, source.prefix + "_sums")),
      fresh_table_(source.staged ? "wearwell_fresh_sums" : sums_table_) {
  std::vector<std::string> names = {source.unit.name, source.cycle.name, source.energy.name};
  for (const SqlColumn& each : source.inputs) names.push_back(each.name);
  for (const std::string& each : {source.time, source.per_day})
    if (!each.empty()) names.push_back(each);
  fleet::refuse_alike(dialect, names);
}

/// The sums of each unit, after the counts.
std::vector<std::string> SqlWriter::sum_names() const {
  std::vector<std::string> names = {"energy", "volume", "variance", "settled"};
  for (const char* input : input_columns) names.push_back(std::string("sum_") + input);
  for (std::size_t b = 1; b <= replicates_; ++b) names.push_back(fmt::format("v{}", b));
  for (std::size_t b = 1; b <= replicates_; ++b) names.push_back(fmt::format("s{}", b));
  return names;
}

std::vector<std::string> SqlWriter::sums_columns() const {
  std::vector<std::string> names = {"model", "unit", "after_cycle", "last_cycle"};
  names.insert(names.end(), std::begin(count_names), std::end(count_names));
  for (const std::string& each : sum_names()) names.push_back(each);
  return names;
}

std::string SqlWriter::kept_names() const {
  return fmt::format("{}", fmt::join(sums_columns(), ", "));
}

std::string SqlWriter::count_if(const std::string& condition) const {
  return fmt::format("sum(case when {} then 1 else 0 end)", condition);
}

std::string SqlWriter::setup() const {
  std::string sums;
  for (const char* each : count_names)
    sums += fmt::format(",\n  {} {} not null", each, types_.whole);
  for (const std::string& each : sum_names())
    sums += fmt::format(",\n  {} {} not null", each, types_.sum);
  std::vector<std::string> rows;
  for (const SqlParameter& each : parameters_.all)
    rows.push_back(fmt::format("  ({}, {}, {}, {})", id_, each.replicate,
                               fleet::literal(dialect_, each.name), number(each.value)));
  const std::string head =
      "-- 1. Set-up: the model's numbers as rows, and a table for sums. May be run again.\n"
      "-- SI, temperatures in degrees Celsius. Replicate 0 is the model; the others are its "
      "bootstrap replicates.\n";
  if (clickhouse()) return head + setup_of_clickhouse(fmt::format("{}", fmt::join(rows, ",")));
  return fmt::format(
      "-- 1. Set-up: the model's numbers as rows, and a table for sums. May be run again.\n"
      "-- SI, temperatures in degrees Celsius. Replicate 0 is the model; the others are its "
      "bootstrap replicates.\n"
      "create table if not exists {0} (\n"
      "  model {1} not null, replicate integer not null, name {1} not null, value {2} not null,\n"
      "  primary key (model, replicate, name));\n-- One row per unit.\n"
      "create table if not exists {3} (\n"
      "  model {1} not null, unit {1} not null, after_cycle {4} not null, last_cycle {4} not "
      "null{5},\n"
      "  primary key (model, unit));\n"
      "delete from {0} where model = {6};\n"
      "insert into {0} (model, replicate, name, value) values\n{7};\n",
      model_table_, types_.text, types_.real, sums_table_, types_.whole, sums, id_,
      fmt::join(rows, ",\n"));
}

/// The parameters as one row.
std::string SqlWriter::parameters() const {
  // In ClickHouse a missing value would be 0, not null.
  const char* value = clickhouse() ? "maxIf(value, replicate = {} and name = {})"
                                   : "max(case when replicate = {} and name = {} then value end)";
  const std::string all = clickhouse()
                              ? fmt::format("\nhaving throwIf(uniqExact(replicate, name) < {}) = 0",
                                            parameters_.all.size())
                              : "";
  SqlColumns columns;
  for (const SqlParameter& each : parameters_.all)
    columns.add(
        fmt::format(fmt::runtime(value), each.replicate, fleet::literal(dialect_, each.name)),
        each.column);
  return fmt::format("(select\n  {}\nfrom {} where model = {}{}) as k", columns.text(),
                     model_table_, id_, all);
}

std::string SqlWriter::with_parameters() const {
  return source_.inlined ? "" : " cross join\n" + parameters();
}

std::string SqlWriter::cell(const std::string& column) const {
  return fleet::number_cell("t." + fleet::identifier(dialect_, column), source_.text_decimal);
}

std::string SqlWriter::in_si(const SqlColumn& column) const {
  std::string text = fleet::real(dialect_, cell(column.name));
  if (clickhouse()) text = fmt::format("ifNull({}, nan)", text);
  if (column.scale != 1) text += " * " + number(column.scale);
  if (column.offset != 0) text += " + " + number(column.offset);
  return text;
}

/// Null if a number that names a unit is not whole.
std::string SqlWriter::unit() const {
  const std::string name = "t." + fleet::identifier(dialect_, source_.unit.name);
  if (!source_.unit.is_real) return name;
  return fmt::format("case when {0} = floor({0}) then cast({0} as bigint) end", name);
}

std::string SqlWriter::si(bool fresh) const {
  const std::string unit = this->unit();
  const std::string cycle = cell(source_.cycle.name);
  SqlColumns columns;
  // In ClickHouse arrays leave out null.
  columns.add(clickhouse() ? fmt::format("ifNull(toString({}), '')", unit) : unit,
              clickhouse() && fresh && !source_.first ? "wearwell_unit" : "unit");
  columns.add(clickhouse() ? fmt::format("ifNull({}, 0)", cycle) : cycle, "cycle");
  for (std::size_t i = 0; i < 4; ++i)
    columns.add(in_si(source_.inputs[i]), std::string("raw_") + input_columns[i]);
  columns.add(in_si(source_.energy), "raw_energy");
  if (fresh && source_.first) {
    columns.add("0", "after_cycle");
    columns.add("0", "energy_before");
  }
  const std::string portion = fresh && source_.portions > 1
                                  ? fmt::format("cityHash64(toString({})) % {} = {}", unit,
                                                source_.portions, source_.portion)
                                  : "";
  const std::string rows =
      fmt::format("select\n  {}\nfrom {} as t{}{}{}", columns.text(), source_.table,
                  portion.empty() ? "" : "\nwhere ", portion, fence());
  if (!fresh || source_.first) return rows;
  if (clickhouse()) return fresh_of_clickhouse(rows);
  columns.add("coalesce(last.after_cycle, 0)", "after_cycle");
  columns.add("coalesce(last.energy, 0)", "energy_before");
  return fmt::format(
      "select\n  {0}\nfrom {1} as t\nleft join (\n  select unit, max(last_cycle) as after_cycle, "
      "sum(energy) as energy from {2} where model = {3} group by unit\n) as last on last.unit = "
      "{4}\nwhere last.after_cycle is null or {5} is null or {5} > last.after_cycle{6}",
      columns.text(), source_.table, sums_table_, id_, fleet::text(dialect_, unit), cycle, fence());
}

std::string SqlWriter::checked() const {
  SqlColumns columns;
  for (const char* each : {"unit", "cycle", "after_cycle", "energy_before"}) columns.keep(each);
  columns.add(valid(), "valid");
  // A refused row counts as null. ClickHouse leaves null out of arrays.
  const char* choice = clickhouse() ? "if({}, {}, {})" : "case when {} then {} end";
  const auto add = [&](const std::string& value, const char* otherwise, const std::string& name) {
    columns.add(fmt::format(fmt::runtime(choice), valid(), value, otherwise), name);
  };
  for (const char* each : input_columns) add(std::string("raw_") + each, "1e0", each);
  add(fleet::whole(dialect_, "raw_energy * " + number(1 / units_.energy)), "0", "fixed_energy");
  std::string where;
  if (source_.skip_invalid)
    where =
        fmt::format("\nwhere {} and {}", clickhouse() ? "unit <> ''" : "unit is not null", valid());
  return fmt::format("select\n  {}\nfrom (\n-- the new cycles, in SI\n{}\n) as si{}{}",
                     columns.text(), si(true), where, fence());
}

std::string SqlWriter::ordered() const {
  if (clickhouse()) return ordered_by_arrays();
  return fmt::format(
      "select *,\n"
      "  energy_before + coalesce(sum(fixed_energy) over (partition by unit order by cycle\n"
      "    rows between unbounded preceding and 1 preceding), 0) as before,\n"
      "  lag(cycle) over (partition by unit order by cycle) as cycle_before\n"
      "from (\n{}\n) as checked{}",
      checked(), fence());
}

std::string SqlWriter::powers() const {
  SqlColumns columns;
  // PostgreSQL would multiply a bigint with a literal as numeric, and convert the product to a double
  // by its text wherever it is used.
  const auto energy = [&](double unit, const char* name) {
    columns.add(fmt::format("{} * {}", fleet::real(dialect_, "fixed_energy"), number(unit)), name);
  };
  energy(units_.energy, "energy");
  energy(0.5 * units_.energy / units_.volume, "half_energy");
  energy(0.5 * units_.energy / units_.fine, "half_fine");
  columns.add(fmt::format("{} * {}", fleet::real(dialect_, "before"), number(units_.energy)),
              "running");
  for (std::size_t p = 0; p < parameters_.pairs.size(); ++p) {
    const std::size_t b = parameters_.pairs[p].first;
    columns.add(
        fmt::format("exp({} * ln(slip_speed) + {} * ln(closing_time))", k(b, "r"), k(b, "q")),
        fmt::format("ds{}", p));
  }
  return fmt::format(
      "select ordered.*,{}\n  {}\nfrom (\n"
      "-- energy of the cycles before each, in whole units; a row with invalid values counts only "
      "as refused\n"
      "{}\n) as ordered{}{}",
      parameter_columns(), columns.text(), ordered(), with_parameters(), fence());
}

std::string SqlWriter::run_in(std::size_t b, const std::string& energy) const {
  const auto mode = [&](const char* share, const char* rate) {
    return fmt::format(
        "{} * {}", parameters_.column(b, share),
        fleet::decay(dialect_, fmt::format("{} * {}", energy, parameters_.column(b, rate))));
  };
  return fmt::format("(1e0 + {} + {})", mode("slow", "slow_rate"), mode("fast", "fast_rate"));
}

std::string SqlWriter::rates() const {
  SqlColumns columns;
  for (std::size_t b = 0; b <= replicates_; ++b)
    columns.add(horner(parameters_, b, ""), fmt::format("w{}", b));
  return fmt::format(
      "select *,\n  {}\nfrom (\n-- slip distance of each pair of exponents\n{}\n) as powers{}",
      columns.text(), powers(), fence());
}

/// sigma_w, never below its floor; as in CycleSum from the rate before it is clipped at 0.
std::string SqlWriter::sigma() const {
  const auto p = [&](int i) { return parameters_.column(0, fmt::format("sigma{}", i)); };
  std::string text;
  switch (model_.scatter.kind) {
    case ScatterKind::exponential:
      text = fmt::format("{} * exp({} * w0)", p(1), p(2));
      break;
    case ScatterKind::linear:
      text = fmt::format("{} + {} * w0", p(1), p(2));
      break;
    case ScatterKind::quadratic:
      text = fmt::format("{} + w0 * ({} + w0 * {})", p(1), p(2), p(3));
      break;
    case ScatterKind::conditions:
      text =
          fmt::format("{} + {} * temperature + {} * slip_speed + {} * torque + {} * closing_time",
                      p(1), p(2), p(3), p(4), p(5));
  }
  return fmt::format("greatest({}, {})", text, parameters_.column(0, "sigma_floor"));
}

std::string SqlWriter::worn() const {
  SqlColumns columns;
  columns.add(sigma() + " * energy", "step");
  // w + |w| is 2 w, or 0 if the rate is negative: exact, and faster than a conditional.
  for (std::size_t b = 0; b <= replicates_; ++b)
    columns.add(fmt::format("(w{0} + abs(w{0})) * {1}", b, b == 0 ? "half_fine" : "half_energy"),
                fmt::format("settled{}", b));
  return fmt::format(
      "select *,\n  {}\nfrom (\n-- wear rates: of the model, then of the replicates\n{}\n) as "
      "rates{}",
      columns.text(), rates(), fence());
}

std::string SqlWriter::sums() const {
  std::vector<std::string> all;
  const auto keep = [&](const std::string& expression) { all.push_back(expression); };
  keep(id_);
  keep(fleet::text(dialect_, "unit"));
  keep("max(after_cycle)");
  keep(clickhouse() ? "max(cycle)" : "coalesce(max(cycle), max(after_cycle))");
  const char* refused = clickhouse() ? "valid = 0" : "not coalesce(valid, false)";
  for (const char* condition :
       {clickhouse() ? "valid = 1" : "valid", refused, "cycle = cycle_before"})
    keep(count_if(condition));
  std::string any;
  for (const char* each : input_columns) {
    const std::string out = fmt::format("{0} < {1} or {0} > {2}", each,
                                        parameters_.column(0, std::string(each) + "_from"),
                                        parameters_.column(0, std::string(each) + "_to"));
    keep(count_if(counted(out)));
    any += (any.empty() ? "" : " or ") + out;
  }
  keep(count_if(counted(any)));
  keep(count_if(counted("w0 < 0")));
  const auto sum = [&](const std::string& fixed) {
    const std::string total = fleet::sum_of(dialect_, fixed);
    keep(clickhouse() ? total : fmt::format("coalesce({}, 0)", total));
  };
  sum("fixed_energy");
  sum(fleet::wide(dialect_, "settled0 * " + run_in(0, "running")));
  sum(fleet::wide(dialect_, fmt::format("step * step * {}", number(1 / units_.variance))));
  sum(fleet::wide(dialect_, "settled0"));
  for (std::size_t i = 0; i < 4; ++i)
    sum(fleet::whole(dialect_,
                     fmt::format("{} * {}{}", input_columns[i], number(1 / units_.inputs[i]),
                                 clickhouse() ? " * valid" : "")));
  for (std::size_t b = 1; b <= replicates_; ++b)
    sum(fleet::whole(dialect_, fmt::format("settled{} * {}", b, run_in(b, "running"))));
  for (std::size_t b = 1; b <= replicates_; ++b)
    sum(fleet::whole(dialect_, fmt::format("settled{}", b)));
  // ClickHouse would take a new name for the column within a sum.
  const std::vector<std::string> names = sums_columns();
  for (std::size_t i = 0; source_.read_only && i < all.size(); ++i) all[i] += " as " + names[i];
  return fmt::format(
      "select\n  {}\nfrom (\n-- volumes of a run-in plate, and scatter\n{}\n) as worn\n"
      "group by unit",
      fmt::join(all, ",\n  "), worn());
}

std::string SqlWriter::query() const {
  return fmt::format(
      "-- 2. Query: adds the sums of all cycles after the last counted one of each unit. May be "
      "run again, and then adds nothing.\n"
      "-- Integers, so that the order of rows does not change a bit. Units: energy 2^{} J, volume "
      "and settled 2^{} m^3, variance 2^{} m^6,\n"
      "-- replicates v1 .. (with run-in) and s1 .. (without) 2^{} m^3.\n"
      "insert into {}{} ({})\n{}{};\n",
      std::ilogb(units_.energy), std::ilogb(units_.fine), std::ilogb(units_.variance),
      std::ilogb(units_.volume), fresh_table_, clickhouse() ? "" : " as kept", kept_names(), sums(),
      adding());
}

ClutchSql clutch_sql(const WearModel& model, const std::string& id, fleet::Dialect dialect,
                     const SqlSource& source, bool replicates) {
  const SqlWriter writer(model, id, dialect, source, replicates);
  ClutchSql sql;
  sql.setup = writer.setup();
  sql.query = writer.query();
  sql.combine = writer.combine();
  sql.totals = writer.totals();
  sql.size = writer.size();
  sql.late = writer.late();
  sql.times = writer.times();
  sql.keep = writer.keep();
  sql.check = writer.check();
  sql.invalid_row = writer.invalid_row();
  sql.left_out = writer.left_out();
  sql.left_out_rows = writer.left_out_rows();
  sql.left_out_units = writer.left_out_units();
  sql.outlier = writer.outlier();
  sql.stream = writer.stream();
  sql.sorted = sql.stream + "\norder by unit, cycle";
  sql.known = writer.known();
  sql.fresh = writer.fresh();
  sql.gather = writer.gather();
  sql.columns = writer.sums_columns();
  sql.layout = writer.layout();
  sql.exists = writer.exists();
  sql.others = writer.others();
  return sql;
}

}  // namespace wearwell::clutch
