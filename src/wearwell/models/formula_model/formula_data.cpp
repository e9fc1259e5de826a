#include "wearwell/models/formula_model/formula_data.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "wearwell/base/contains.h"
#include "wearwell/base/error.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/base/unit_hint.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/input/cell_text.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/heading.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/failure_modes.h"
#include "wearwell/models/formula_model/field_returns.h"

// Longer than others: columns, and the meaning of each cell of a measured one.
namespace wearwell::formula_model {
namespace {

template <class Columns>
auto find(const Columns& columns, const std::string& name) {
  const auto at = std::find_if(columns.begin(), columns.end(),
                               [&](const auto& each) { return each.name == name; });
  return at == columns.end() ? nullptr : &*at;
}

// `status`: of that column, in which an empty cell can have a meaning.
LabelColumn read_labels(const Table& table, const std::string& name, const Column& column,
                        const LifeStatus* status) {
  LabelColumn result{name, column.name, {}, {}};
  std::unordered_map<std::string, int> known;
  for (std::size_t i = 0; i < table.rows; ++i) {
    check_stop();
    std::string text = status ? cell_word(column, i) : label_word(table, column, i);
    if (text.empty()) static_cast<void>(seen_in(table, *status, i));  // refuses others
    const auto [at, is_new] = known.try_emplace(text, static_cast<int>(result.levels.size()));
    result.at.push_back(at->second);
    if (is_new) result.levels.push_back(std::move(text));
  }
  return result;
}

// SI, NaN for an empty cell. `limit` [SI]: the value of "<LOD", NaN if the study does not have one.
NumberColumn read_numbers(const Table& table, const std::string& name, const Column& column,
                          formula::AnyUnit unit, double limit) {
  bool any_empty = false, any_limit = false;
  std::vector<double> values;
  values.reserve(table.rows);
  std::vector<Censoring> seen(table.rows, Censoring::none);
  for (std::size_t i = 0; i < table.rows; ++i) {
    check_stop();
    const CellValue cell = cell_value(table, column, i);
    if (cell.unstated && std::isnan(limit))
      refuse_unstated_limit(table, column, i,
                            fmt::format("{} = {{ column = \"{}\", unit = \"{}\", detection_limit = "
                                        "\"0.05 {}\" }}",
                                        name, column.name, unit.unit.text, unit.unit.text));
    values.push_back(cell.unstated ? from_si(unit.unit, limit) : cell.number);
    if (cell.sign) seen[i] = cell.sign == '<' ? Censoring::left : Censoring::right;
    any_limit |= cell.sign != 0;
    any_empty |= std::isnan(values.back());
  }
  if (!any_limit) seen.clear();
  if (!any_empty && !any_limit) {
    values = si_numbers(table, column.name, unit.unit);
    return {name, column.name, std::move(unit), std::move(values)};
  }
  for (double& each : values) {
    if (!std::isnan(each)) each = to_si(unit.unit, each);
  }
  return {name, column.name, std::move(unit), std::move(values), std::move(seen)};
}

bool is_text(const Column& column) {
  if (column.is_number) return false;
  return std::any_of(column.text.begin(), column.text.end(), [](const std::string& text) {
    return text.find_first_of("0123456789") == std::string::npos && !text.empty() &&
           !is_missing_mark(text) && !cell_text(text);
  });
}

// Whether a column of this name has the bounds, entries or counts of measurements.
bool qualifies(const std::string& name) {
  return name == "lower" || name == "upper" || name == "entry" || name == "count";
}

// One measured column with the columns that qualify it.
class ObservedReader {
 public:
  ObservedReader(const FormulaData& data, const std::string& name, const ResponseForm& form,
                 const SpecialColumns& special, const std::optional<std::string>& trials,
                 bool dead_on_arrival)
      : data_(data), form_(form), exact_(data.number(name)), dead_(dead_on_arrival) {
    const auto column = [&](const std::optional<std::string>& each) {
      return each ? data.number(*each) : nullptr;
    };
    lower_ = column(special.lower);
    upper_ = column(special.upper);
    entry_ = column(special.entry);
    count_ = column(special.count);
    trials_ = column(trials);
    if (data.status) status_ = &*data.status;
    for (const NumberColumn* each : {lower_, upper_, entry_, count_, trials_}) {
      if (each) data.require_values(*each);
    }
  }

  Observed read(bool may_lack) {
    Observed all;
    all.rows.reserve(data_.table.rows);
    all.responses.reserve(data_.table.rows);
    all.counts.reserve(data_.table.rows);
    for (std::size_t i = 0; i < data_.table.rows; ++i) {
      check_stop();
      if (may_lack && exact_ && std::isnan(exact_->values[i])) continue;
      const Response response = row(i);
      all.rows.push_back(i);
      all.responses.push_back(response);
      all.counts.push_back(count(i));
      all.failures += response.seen != Censoring::right;
    }
    return all;
  }

 private:
  const NumberColumn& need(const NumberColumn* column, std::size_t i, const char* what) const {
    if (!column) {
      throw InputError(fmt::format("{}: an interval needs the columns data.columns.lower and upper",
                                   place(data_.table, status_->column, i)));
    }
    if (std::isnan(column->values[i])) {
      throw InputError(
          fmt::format("{}: no value; {}", place(data_.table, column->column, i), what));
    }
    return *column;
  }

  void demand(bool good, const NumberColumn& column, std::size_t i, const char* allowed) const {
    if (good) return;
    throw InputError(fmt::format("{}: {:.10g} {} must be {}", place(data_.table, column.column, i),
                                 from_si(column.unit.unit, column.values[i]), column.unit.unit.text,
                                 allowed));
  }

  int count(std::size_t i) const {
    if (!count_) return 1;
    const double n = count_->values[i];
    demand(n >= 1 && n == std::floor(n) && n <= 1e6, *count_, i, "a whole number from 1");
    return static_cast<int>(n);
  }

  // The interval between two values; an empty one is open.
  Response between(std::size_t i) const {
    if (!lower_ || !upper_) {
      const NumberColumn* there = lower_ ? lower_ : upper_;
      throw InputError(fmt::format(
          "{}: an interval needs both data.columns.lower and upper",
          there ? place(data_.table, there->column, i) : place(data_.table, status_->column, i)));
    }
    double a = lower_->values[i], b = upper_->values[i];
    if (std::isnan(a) && std::isnan(b)) {
      throw InputError(fmt::format("{}: both this cell and the upper end are empty",
                                   place(data_.table, lower_->column, i)));
    }
    if (dead_ && a == 0 && b > 0 && b < infinity)
      demand(false, *lower_, i,
             "positive, or empty: 0 to the upper end can include parts dead on arrival, or not; "
             "leave the lower end empty if this part may have been dead on arrival, or give a "
             "small positive one if it worked at first");
    if (dead_ && a == 0 && b == 0) return {Censoring::none, 0};
    const bool no_lower = std::isnan(a) || (form_.positive && a <= 0);
    if (no_lower && (std::isnan(b) || b == infinity)) {
      throw InputError(
          fmt::format("{}: the interval contains every possible value: give an upper end, a lower "
                      "end above 0, or remove the row",
                      place(data_.table, lower_->column, i)));
    }
    if (no_lower) return {Censoring::left, b};
    if (std::isnan(b) || b == infinity) return {Censoring::right, a};
    demand(b >= a, *upper_, i, "no less than the lower end");
    if (a == b) return {Censoring::none, a};
    return {Censoring::interval, a, b};
  }

  // An end in a row that is not an interval must repeat the value or be empty; otherwise there are
  // two readings.
  void refuse_other_ends(const Response& y, std::size_t i) const {
    const auto refuse = [&](const NumberColumn* end, bool open) {
      if (!end || open || std::isnan(end->values[i]) || end->values[i] == y.at) return;
      demand(false, *end, i,
             status_ ? "empty where the status is not interval"
                     : "empty if there is a measured value, which is read as exact");
    };
    refuse(lower_, y.seen == Censoring::left && lower_ && lower_->values[i] <= 0);
    refuse(upper_, y.seen == Censoring::right && upper_ && upper_->values[i] == infinity);
  }

  // By its cell, "<0.5", or by its status; both are allowed if they agree.
  Censoring seen_of(std::size_t i) const {
    const Censoring said = status_ ? seen_in(data_.table, *status_, i) : Censoring::none;
    if (!exact_ || exact_->seen.empty() || exact_->seen[i] == Censoring::none) return said;
    if (status_ && said != exact_->seen[i])
      throw InputError(fmt::format(
          "{}: '{}' is a limit, but column '{}' has '{}'; correct one of them",
          place(data_.table, exact_->column, i), data_.table.column(exact_->column).text[i],
          status_->column, cell_word(data_.table.column(status_->column), i)));
    return exact_->seen[i];
  }

  Response row(std::size_t i) const {
    const bool has_exact = exact_ && !std::isnan(exact_->values[i]);
    const Censoring seen = seen_of(i);
    Response y;
    if (seen == Censoring::interval || (!status_ && lower_ && !has_exact)) {
      y = between(i);
    } else {
      if (!exact_) {
        throw InputError(fmt::format("{}: the study has no column for the observed value itself",
                                     place(data_.table, status_->column, i)));
      }
      y = {seen, need(exact_, i, "the observed value is missing").values[i]};
      refuse_other_ends(y, i);
    }
    if (form_.positive && exact_ && y.seen != Censoring::interval &&
        !(dead_ && y.at == 0 && y.seen != Censoring::left)) {
      const char* zero = y.at == 0 && y.seen == Censoring::none && !form_.counted && !dead_
                             ? "; if 0 is the life of a part dead on arrival, the likelihood "
                               "needs share_dead_on_arrival"
                             : "";
      demand(y.at > 0, *exact_, i,
             fmt::format("positive for the {} family{}", form_.name, zero).c_str());
    }
    if (form_.counted) {
      if (y.seen != Censoring::none) {
        throw InputError(fmt::format("{}: a count of the {} family cannot be censored",
                                     place(data_.table, exact_ ? exact_->column : "", i),
                                     form_.name));
      }
      demand(y.at >= 0 && y.at == std::floor(y.at), *exact_, i, "a whole number, 0 or more");
    }
    if (trials_) {
      y.trials = need(trials_, i, "give the number of trials").values[i];
      demand(y.trials >= 1 && y.trials == std::floor(y.trials), *trials_, i,
             "a whole number from 1");
      demand(y.at <= y.trials, *exact_, i, "no more than the number of trials");
    }
    if (entry_ && !std::isnan(entry_->values[i]) && !(form_.positive && entry_->values[i] <= 0)) {
      y.entry = entry_->values[i];
      const double last = y.seen == Censoring::interval ? y.until : y.at;
      demand(y.entry < last, *entry_, i,
             "less than the observed value (it is the delayed entry, where observation began)");
      if (y.seen == Censoring::left) {
        demand(false, *entry_, i,
               "empty for a left-censored row: the event came after observation began");
      }
      if (y.seen == Censoring::interval) y.at = std::max(y.at, y.entry);
    }
    return y;
  }

  const FormulaData& data_;
  const ResponseForm& form_;
  const NumberColumn *exact_, *lower_ = nullptr, *upper_ = nullptr, *entry_ = nullptr,
                              *count_ = nullptr, *trials_ = nullptr;
  const LifeStatus* status_ = nullptr;
  bool dead_;
};

}  // namespace

const NumberColumn* FormulaData::number(const std::string& name) const {
  return find(numbers, name);
}

const LabelColumn* FormulaData::label(const std::string& name) const {
  return find(labels, name);
}

void FormulaData::require_values(const NumberColumn& column) const {
  for (std::size_t i = 0; i < column.seen.size(); ++i) {
    if (column.seen[i] != Censoring::none)
      static_cast<void>(cell_number(table, table.column(column.column), i));  // refused below
  }
}

void FormulaData::require_complete(const NumberColumn& column) const {
  require_values(column);
  for (std::size_t i = 0; i < table.rows; ++i) {
    if (std::isfinite(column.values[i])) continue;
    throw InputError(fmt::format(
        "{}: {}", place(table, column.column, i),
        std::isnan(column.values[i]) ? "no value (empty or NaN)" : "the value is infinite"));
  }
}

namespace {

// Whether the table has a unit for the column: in a row of units, or in square brackets in the
// heading.
bool says_unit(const Column& column) {
  return !column.unit.empty() || read_heading(column.name, "").certain;
}

formula::AnyUnit written_unit(const Table& table, const Column& column, const std::string& name) {
  if (!says_unit(column)) return formula::read_any_unit("1");
  const bool row = !column.unit.empty();
  const Heading heading = read_heading(column.name, "");
  const std::string text = row ? bare_unit(column.unit) : heading.unit;
  try {
    return formula::read_any_unit(text);
  } catch (const InputError& error) {
    throw InputError(
        no_unit_of(table, column, name, "1", error.what() + unit_hint(text, std::nullopt)));
  }
}

// Empty if the unit has a root.
std::string si_of(const formula::AnyUnit& unit) {
  const bool whole = std::all_of(unit.powers.begin(), unit.powers.end(),
                                 [](const auto& each) { return each.second.denominator() == 1; });
  return whole ? formula::si_text(unit.powers) : std::string();
}

// The value of "<LOD" in a column of this unit, SI; NaN if the study does not have one.
double detection_limit(const TomlReader& choice, const formula::AnyUnit& unit) {
  const std::string si = si_of(unit);
  if (!choice.text("detection_limit") || si.empty()) return NAN;
  return choice.required_quantity("detection_limit", si).si();
}

// A triangle by failure mode goes with [failure_modes], and the other way round.
void require_modes_of_returns(const TomlReader& root, const FieldReturns& returns) {
  const auto modes = root.table("failure_modes");
  const bool in_table = !returns.triangle.mode_column.empty();
  if (in_table && !modes)
    root.required_table("data").required_table("returns").fail(
        "mode", "needs [failure_modes] column = \"mode\", which gives each failure mode a life");
  if (!modes) return;
  if (!in_table)
    modes->fail("column",
                "needs [data.returns] mode = HEADING, the column of failure modes of the returns");
  if (const std::string name = modes->required_text("column"); name != mode_of_returns)
    modes->fail("column",
                fmt::format("must be \"{}\", the key of [data.returns]", mode_of_returns));
  const std::vector<std::string> without = modes_without_returns(returns);
  for (const std::string& mode : modes_with_tables(*modes)) {
    if (contains(without, mode))
      modes->fail(mode, fmt::format("this failure mode has no return {}; remove its table",
                                    fitted_periods(returns)));
  }
  if (returns.reporting)
    modes->fail("",
                "is not possible with delays that vary; state fixed delays, or fit the returns "
                "of all modes together");
}

}  // namespace

FormulaData read_own_data(const TomlReader& root, const Source& source,
                          const std::vector<std::string>& label_names) {
  const TomlReader section = root.required_table("data");
  if (section.has("returns")) {
    if (root.has("random_effects"))
      root.fail("random_effects", "is not possible with [data.returns]");
    const auto returns = read_field_returns(root, source);
    require_modes_of_returns(root, *returns);
    return lives_of_returns(*returns);
  }
  const TomlReader columns = section.required_table("columns");
  FormulaData data{read_table(section, source), {}, {}, {}};
  data.status = read_life_status(columns, data.table);
  const auto is_label = [&](const std::string& name) {
    return std::find(label_names.begin(), label_names.end(), name) != label_names.end();
  };
  std::optional<std::string> mode;
  if (const auto modes = root.table("failure_modes")) mode = modes->required_text("column");
  if (mode && !columns.has(*mode))
    root.required_table("failure_modes")
        .fail("column", fmt::format("'{}' is not a column under data.columns", *mode));
  for (const std::string& name : columns.keys()) {
    std::string heading;
    std::optional<formula::AnyUnit> unit;
    const std::optional<TomlReader> in_table =
        columns.is_text(name) ? std::nullopt : std::optional(columns.required_table(name));
    if (columns.is_text(name)) {
      heading = columns.required_text(name);
    } else {
      const TomlReader& choice = *in_table;
      heading = choice.required_text("column");
      if (const auto text = choice.text("unit")) {
        try {
          unit = formula::read_any_unit(*text);
        } catch (const InputError& error) {
          choice.fail("unit", error.what());
        }
      }
    }
    const Column* const column = &study_column(columns, name, heading, data.table);
    if (mode == name) {
      if (unit) columns.fail(name, "has a unit, but it is the column of failure modes");
      continue;
    }
    if (is_label(name) && unit) {
      columns.fail(name, "has a unit, but the study uses it as a label; remove one of the two");
    }
    // A word in a column that qualifies measurements is an error: a label there would be ignored.
    const bool words =
        !qualifies(name) && (is_text(*column) || (name == "status" && !column->is_number));
    if (is_label(name) || (!unit && words)) {
      const bool is_status = name == "status" && data.status;
      data.labels.push_back(
          read_labels(data.table, name, *column, is_status ? &*data.status : nullptr));
    } else {
      if (!unit) {
        unit = written_unit(data.table, *column, name);
      } else if (const std::string si = si_of(*unit); !si.empty() && says_unit(*column)) {
        unit->unit = column_unit(data.table, *column, si, unit->unit);  // refuses contradictions
      }
      const double limit = in_table ? detection_limit(*in_table, *unit) : NAN;
      data.numbers.push_back(read_numbers(data.table, name, *column, std::move(*unit), limit));
    }
  }
  if (data.table.rows == 0) throw InputError(fmt::format("{} has no rows", data.table.source));
  return data;
}

SpecialColumns special_columns(const FormulaData& data) {
  SpecialColumns special;
  const auto take = [&](const char* name, std::optional<std::string>& to) {
    if (data.number(name) || data.label(name)) to = name;
  };
  take("status", special.status);
  take("lower", special.lower);
  take("upper", special.upper);
  take("entry", special.entry);
  take("count", special.count);
  return special;
}

Observed read_observed(const FormulaData& data, const std::string& name, const ResponseForm& form,
                       const SpecialColumns& special, const std::optional<std::string>& trials,
                       bool may_lack, bool dead_on_arrival) {
  return ObservedReader(data, name, form, special, trials, dead_on_arrival).read(may_lack);
}

}  // namespace wearwell::formula_model
