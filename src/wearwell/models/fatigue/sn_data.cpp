#include "wearwell/models/fatigue/sn_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/input/heading.h"
#include "wearwell/input/idle_status.h"
#include "wearwell/models/fatigue/read_outcome.h"
#include "wearwell/models/fatigue/spring.h"

namespace wearwell {
namespace {

using fatigue::LifeTest;
using fatigue::MeanStress;
using fatigue::Outcome;
using fatigue::Stress;

// One input of every test: from its column, or the same for all from [conditions].
class Inputs {
 public:
  Inputs(const TomlReader& columns, const std::optional<TomlReader>& conditions, const Table& table)
      : columns_(columns), conditions_(conditions), table_(table) {}

  bool has(const std::string& name) const {
    return columns_.has(name) || (conditions_ && conditions_->has(name));
  }

  struct Series {
    std::vector<double> values;  // SI
    Unit unit;
    std::optional<ColumnChoice> column;
  };

  Series read(const std::string& name, const std::string& si) const {
    const auto column = read_column(columns_, name, si, table_);
    const auto constant = conditions_ ? conditions_->quantity(name, si) : std::nullopt;
    if (column && constant) {
      conditions_->fail(name, fmt::format("is given here and as data.columns.{}; keep one", name));
    }
    if (constant) {
      return {std::vector<double>(table_.rows, constant->si()), constant->unit, {}};
    }
    if (!column) {
      columns_.fail(name, fmt::format("is missing; give it here, or in [conditions] if it is the "
                                      "same for all: {} = \"NUMBER{}\"",
                                      name, may_be_plain(si) ? "" : " " + si));
    }
    return {si_numbers(table_, *column), column->unit, column};
  }

  void require(bool good, const Series& series, std::size_t row, const char* name,
               const char* allowed) const {
    if (good) return;
    if (series.column) wearwell::require(false, table_, *series.column, row, allowed);
    conditions_->fail(name, fmt::format("must be {}", allowed));
  }

 private:
  const TomlReader& columns_;
  const std::optional<TomlReader>& conditions_;
  const Table& table_;
};

double positive(const TomlReader& table, const char* name, const char* si) {
  const Quantity quantity = table.required_quantity(name, si);
  if (!(quantity.si() > 0)) table.fail(name, "must be positive");
  return quantity.si();
}

fatigue::HelicalSpring read_spring(const TomlReader& conditions) {
  const fatigue::HelicalSpring spring{
      positive(conditions, "wire_diameter", "m"), positive(conditions, "coil_diameter", "m"),
      positive(conditions, "active_coils", "1"), positive(conditions, "shear_modulus", "Pa")};
  if (!(spring.coil_diameter > spring.wire_diameter)) {
    conditions.fail("coil_diameter", "must be larger than wire_diameter (it is the mean diameter)");
  }
  return spring;
}

std::vector<Stress> read_stresses(const TomlReader& columns,
                                  const std::optional<TomlReader>& conditions, const Table& table,
                                  MeanStress correction, SnData& data) {
  const Inputs inputs(columns, conditions, table);
  const std::string& si = data.stress_si;
  std::vector<Stress> stresses(table.rows);
  const bool displacement = inputs.has("displacement_amplitude");
  const bool extremes = inputs.has("max_stress");
  const bool ratio = inputs.has("stress_ratio");
  if (displacement + extremes + inputs.has("alternating_stress") != 1) {
    columns.fail(displacement || extremes ? "alternating_stress" : "",
                 "give the stress in one way: alternating_stress with mean_stress or "
                 "stress_ratio, max_stress with min_stress, or displacement_amplitude with "
                 "displacement_mean");
  }
  data.has_mean_stress = displacement || extremes || ratio || inputs.has("mean_stress");
  if (displacement) {
    if (!conditions) columns.fail("displacement_amplitude", "needs the spring in [conditions]");
    const fatigue::HelicalSpring spring = read_spring(*conditions);
    data.spring = spring;
    const auto mean = inputs.read("displacement_mean", "m");
    const auto amplitude = inputs.read("displacement_amplitude", "m");
    data.stress_unit = read_unit("MPa", "Pa");
    for (std::size_t i = 0; i < table.rows; ++i) {
      inputs.require(amplitude.values[i] > 0, amplitude, i, "displacement_amplitude", "positive");
      stresses[i] = {shear_stress(spring, amplitude.values[i]),
                     shear_stress(spring, mean.values[i])};
    }
    data.mean_stress_column = mean.column ? mean.column->column : "";
    data.columns.push_back({"displacement_amplitude", "m", amplitude.unit, amplitude.values, true});
    if (mean.column) data.columns.push_back({"displacement_mean", "m", mean.unit, mean.values});
    return stresses;
  }
  if (extremes) {
    const auto high = inputs.read("max_stress", si), low = inputs.read("min_stress", si);
    data.stress_unit = high.unit;
    for (std::size_t i = 0; i < table.rows; ++i) {
      inputs.require(high.values[i] > low.values[i], high, i, "max_stress",
                     "larger than the smallest stress");
      stresses[i] = {0.5 * (high.values[i] - low.values[i]),
                     0.5 * (high.values[i] + low.values[i])};
    }
    data.mean_stress_column = high.column ? high.column->column : "";
    data.columns.push_back({"max_stress", si, high.unit, high.values, true});
    if (low.column) data.columns.push_back({"min_stress", si, low.unit, low.values});
    return stresses;
  }
  const auto alternating = inputs.read("alternating_stress", si);
  data.stress_unit = alternating.unit;
  data.columns.push_back({"alternating_stress", si, alternating.unit, alternating.values, true});
  for (std::size_t i = 0; i < table.rows; ++i) {
    inputs.require(alternating.values[i] > 0, alternating, i, "alternating_stress", "positive");
    stresses[i].alternating = alternating.values[i];
  }
  if (ratio) {
    if (inputs.has("mean_stress")) {
      columns.fail("mean_stress", "is given, and so is stress_ratio; keep one of the two");
    }
    const auto ratios = inputs.read("stress_ratio", "1");
    for (std::size_t i = 0; i < table.rows; ++i) {
      const double r = ratios.values[i];
      inputs.require(r < 1, ratios, i, "stress_ratio",
                     "less than 1 (smallest over largest stress)");
      stresses[i].mean = stresses[i].alternating * (1 + r) / (1 - r);
    }
    data.mean_stress_column = ratios.column ? ratios.column->column : "";
    if (ratios.column) data.columns.push_back({"stress_ratio", "1", ratios.unit, ratios.values});
  } else if (inputs.has("mean_stress") || correction != MeanStress::none) {
    const auto mean = inputs.read("mean_stress", si);
    for (std::size_t i = 0; i < table.rows; ++i) stresses[i].mean = mean.values[i];
    data.mean_stress_column = mean.column ? mean.column->column : "";
    if (mean.column) data.columns.push_back({"mean_stress", si, mean.unit, mean.values});
  }
  return stresses;
}

// A part is one test of the table: later readings refer to it by name.
void read_part(const Table& table, const ColumnChoice& choice, std::size_t row,
               const LifeTest& test, std::vector<std::string>& parts) {
  const std::string name = cell_word(table.column(choice.column), row);
  if (name.empty())
    throw InputError(
        fmt::format("{}: no value; each part needs its own name, or remove data.columns.part",
                    place(table, choice.column, row)));
  if (test.count != 1)
    throw InputError(fmt::format("{}: '{}' is one part, but its row stands for {}",
                                 place(table, choice.column, row), printable(name), test.count));
  const auto before = std::find(parts.begin(), parts.end(), name);
  if (before != parts.end())
    throw InputError(fmt::format(
        "{}: '{}' is row {} already, and a part is one test here: keep the most informative row. A "
        "part that was tested on at a higher stress is not new; remove that row",
        place(table, choice.column, row), printable(name), before - parts.begin() + 1));
  parts.push_back(name);
}

}  // namespace

Unit life_unit(Unit unit) {
  if (is_number(unit)) unit.text = unit.text == "1" ? "cycles" : unit.text + " cycles";
  return unit;
}

std::vector<Quantity> read_lives(const TomlReader& table, const std::string& key) {
  std::vector<Quantity> lives = table.quantities(key, "cycle");
  for (Quantity& life : lives) {
    life.unit = life_unit(life.unit);
    if (!(life.si() > 0)) table.fail(key, "a life must be positive");
  }
  return lives;
}

std::string driver_si(const std::string& unit) {
  const auto read = parse_unit(unit);
  if (!read) return "";
  for (const char* si : {"Pa", "N", "N m", "1", "m", "V", "A"}) {
    if (read->dimension == parse_unit(si)->dimension) return si;
  }
  return "";
}

std::string stated_driver_si(const TomlReader& root, const Table& table) {
  for (const std::string key : {"alternating_stress", "max_stress"}) {
    std::string column, unit;
    for (const TomlReader::Present& each : root.present()) {
      const std::string at = "data.columns." + key;
      if (each.path == at + ".unit") unit = each.text;
      if (each.path == at || each.path == at + ".column") column = each.text;
      if (each.path == "conditions." + key)
        unit = each.text.substr(std::min(each.text.find(' '), each.text.size()));
    }
    if (unit.empty() && !column.empty()) {
      for (const Column& each : table.columns) {
        const Heading heading = read_heading(each.name, "");
        if (each.name != column && heading.name != column) continue;
        unit = !each.unit.empty() ? each.unit : heading.certain ? heading.unit : "";
      }
    }
    if (unit.empty()) continue;
    const std::string si = driver_si(unit);
    return si.empty() ? "Pa" : si;
  }
  return "Pa";
}

Stress read_stress(const TomlReader& table, MeanStress correction,
                   const std::optional<fatigue::HelicalSpring>& spring,
                   const std::string& stress_si) {
  const bool displacement = table.has("displacement_amplitude");
  const bool extremes = table.has("max_stress");
  if (displacement + extremes + table.has("alternating_stress") != 1) {
    table.fail("",
               "give the stress in one way: alternating_stress with mean_stress or stress_ratio, "
               "max_stress with min_stress, or displacement_amplitude with displacement_mean");
  }
  if (displacement) {
    if (!spring) table.fail("displacement_amplitude", "needs data given as displacements");
    const double mean = table.required_quantity("displacement_mean", "m").si();
    return {shear_stress(*spring, positive(table, "displacement_amplitude", "m")),
            shear_stress(*spring, mean)};
  }
  if (extremes) {
    const double high = table.required_quantity("max_stress", stress_si).si();
    const double low = table.required_quantity("min_stress", stress_si).si();
    if (!(high > low)) table.fail("max_stress", "must be larger than min_stress");
    return {0.5 * (high - low), 0.5 * (high + low)};
  }
  const double alternating = positive(table, "alternating_stress", stress_si.c_str());
  if (!table.has("mean_stress") && !table.has("stress_ratio") && correction == MeanStress::none) {
    return {alternating, 0};
  }
  return read_line(table, stress_si).at(alternating);
}

fatigue::StressLine read_line(const TomlReader& table, const std::string& stress_si) {
  if (table.has("mean_stress") == table.has("stress_ratio")) {
    table.fail(table.has("mean_stress") ? "stress_ratio" : "mean_stress",
               "give one of mean_stress and stress_ratio (smallest over largest stress)");
  }
  if (table.has("mean_stress")) return {table.required_quantity("mean_stress", stress_si).si(), {}};
  const double ratio = table.required_quantity("stress_ratio", "1").si();
  if (!(ratio < 1)) table.fail("stress_ratio", "must be less than 1");
  return {0, ratio};
}

SnData read_sn_data(const TomlReader& root, const Source& source, MeanStress correction) {
  const TomlReader section = root.required_table("data");
  const TomlReader columns = section.required_table("columns");
  const auto conditions = root.table("conditions");
  const Table table = read_table(section, source);
  SnData data;
  data.source = table.source;
  data.layout = table.layout;
  data.stress_si = stated_driver_si(root, table);
  const std::vector<Stress> stresses = read_stresses(columns, conditions, table, correction, data);

  ColumnChoice life = required_column(columns, "life", "cycle", table);
  data.life_unit = life.unit = life_unit(life.unit);
  auto until = read_column(columns, "life_until", "cycle", table);
  if (until) until->unit = life_unit(until->unit);
  const auto status = read_life_status(columns, table);
  static_cast<void>(section.texts("unused"));
  if (!status && !until) refuse_idle_status(section, table, RowKind::life);
  const auto count = read_column(columns, "count", "1", table);
  const auto label = read_word_column(columns, "label", table);
  const auto part = read_word_column(columns, "part", table);
  bool any_label = false;
  for (std::size_t i = 0; label && i < table.rows; ++i)
    any_label = any_label || !cell_word(table.column(label->column), i).empty();
  const CensoredNumbers seen = censored_numbers(table, life);
  const std::vector<double>& lives = seen.values;
  data.columns.push_back({"life", "cycle", life.unit, lives});
  const std::vector<double> counts = count ? si_numbers(table, *count) : std::vector<double>();
  if (count) data.columns.push_back({"count", "1", count->unit, counts});
  const bool without_tension_harmless =
      correction == MeanStress::swt || correction == MeanStress::walker;
  bool any_broke = false;
  for (std::size_t i = 0; i < table.rows; ++i) {
    require(lives[i] > 0, table, life, i, "positive");
    LifeTest test{stresses[i], read_outcome(table, status, life, seen.seen[i], i), lives[i], 0, 1};
    if (test.outcome == Outcome::interval && !until) {
      columns.fail("life_until",
                   fmt::format("is missing: {} is an interval, which ends at a second life",
                               place(table, status->column, i)));
    }
    if (until) test.until = read_interval_end(table, *until, i, test);
    if (count) {
      require(counts[i] >= 1 && counts[i] == std::floor(counts[i]) && counts[i] <= 1e6, table,
              *count, i, "a whole number from 1");
      test.count = static_cast<int>(counts[i]);
    }
    if (without_tension_harmless && !(test.stress.mean + test.stress.alternating > 0)) {
      throw InputError(
          fmt::format("{}, row {}: the largest stress is not tensile, so this mean-stress "
                      "correction counts no damage; remove the row",
                      table.source, i + 1));
    }
    any_broke = any_broke || test.outcome != Outcome::runout;
    data.tests.push_back(test);
    data.labels.push_back(any_label ? label_word(table, table.column(label->column), i) : "");
    if (part) read_part(table, *part, i, test, data.parts);
  }
  if (!any_broke) {
    throw InputError(fmt::format(
        "{}, rows 1 to {}: every test is a runout; without a failure lives have no upper bound",
        table.source, table.rows));
  }
  return data;
}

}  // namespace wearwell
