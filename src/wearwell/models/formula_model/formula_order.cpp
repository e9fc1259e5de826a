#include "wearwell/models/formula_model/formula_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wearwell/base/error.h"
#include "wearwell/input/idle_status.h"
#include "wearwell/models/formula_model/use_rate_model.h"

namespace wearwell::formula_model {

void order_rows(FormulaModel& model, const TomlReader& root) {
  const bool paths =
      std::any_of(model.measured.begin(), model.measured.end(),
                  [](const Measured& m) { return m.program.has_paths() || m.process; });
  const LabelColumn* label = model.label   ? model.data.label(*model.label)
                             : model.steps ? model.data.label(model.steps->label)
                                           : nullptr;
  if (!label && paths && model.symbols.labels.size() == 1) {
    label = model.data.label(model.symbols.labels.front().name);
  } else if (!label && paths && model.symbols.labels.size() > 1) {
    root.fail(
        "data",
        "has several labels without random effects; the order of rows within units needs one");
  }
  const std::size_t rows = model.data.table.rows;
  model.unit_of_row.assign(rows, 0);
  if (label) {
    model.units = label->levels;
    model.unit_of_row.assign(label->at.begin(), label->at.end());
  } else {
    model.units = {""};
  }
  const NumberColumn* axis = model.along   ? model.data.number(*model.along)
                             : model.steps ? model.data.number(model.measured.front().column)
                                           : nullptr;
  if (paths && !axis) {
    root.required_table("predict").fail("along",
                                        "is missing: the column that orders a unit's rows");
  }
  if (axis) model.data.require_complete(*axis);
  model.order.resize(rows);
  std::iota(model.order.begin(), model.order.end(), std::size_t{0});
  std::stable_sort(model.order.begin(), model.order.end(), [&](std::size_t a, std::size_t b) {
    if (model.unit_of_row[a] != model.unit_of_row[b]) {
      return model.unit_of_row[a] < model.unit_of_row[b];
    }
    return paths && axis->values[a] < axis->values[b];
  });
}

void require_rising(const FormulaModel& model) {
  if (!model.has_process()) return;
  const NumberColumn& axis = *model.data.number(*model.along);
  for (const Measured& each : model.measured) {
    if (!each.process) continue;
    const NumberColumn& column = *model.data.number(each.column);
    const bool noisy = each.wanted.size() > 2;
    std::optional<std::size_t> before;
    for (const std::size_t row : model.order) {
      if (std::isnan(column.values[row])) continue;
      const bool first = !before || model.unit_of_row[*before] != model.unit_of_row[row];
      const std::string where = place(model.data.table, column.column, row);
      const double y = column.values[row];
      if (!noisy && !first && axis.values[*before] == axis.values[row]) {
        throw InputError(
            fmt::format("{}: two readings at one position: a reading of a {} without noise has no "
                        "error, so two readings contradict",
                        where, each.form->name));
      }
      if (!noisy && each.process->process != Process::wiener &&
          !(y > (first ? 0 : column.values[*before]))) {
        throw InputError(fmt::format(
            "{}: {:.6g}{} after {:.6g}: the path of the family {} only rises from row to "
            "row of a unit, from 0 on; if readings have errors, add noise",
            where, from_si(each.unit, y), each.unit.text == "1" ? "" : " " + each.unit.text,
            first ? 0.0 : from_si(each.unit, column.values[*before]), each.form->name));
      }
      before = row;
    }
  }
}

namespace {

// Parts dead on arrival say nothing of the lives of others, and a left-censored one may be one of them.
bool has_failure(const Measured& measured) {
  if (!measured.life.dead) return measured.observed.failures > 0;
  return std::any_of(measured.observed.responses.begin(), measured.observed.responses.end(),
                     [](const Response& y) {
                       return y.seen == Censoring::interval ||
                              (y.seen == Censoring::none && y.at > 0);
                     });
}

}  // namespace

void require_failures(const FormulaModel& model) {
  if (model.use_rate && failures_of_use(model) > 0) return;
  for (const Measured& each : model.measured) {
    if (each.form->counted || has_failure(each)) continue;
    for (const Parameter& parameter : model.parameters) {
      if (parameter.prior.proper) continue;
      throw InputError(fmt::format(
          "{}: no row of '{}' is a failure{}: then every parameter needs a proper prior, "
          "but that of {} is {}",
          model.data.table.source, each.column,
          each.life.dead ? " of a part that was certainly not dead on arrival" : "", parameter.name,
          parameter.distribution));
    }
  }
}

namespace {

// Times, counts and distances can be lives; a length below a meter is a wear depth.
bool is_life(const Measured& measured) {
  const ResponseForm& form = *measured.form;
  if (!form.positive && form.family != ResponseFamily::smallest_extreme_value &&
      form.family != ResponseFamily::largest_extreme_value)
    return false;
  const formula::Powers& powers = measured.powers;
  if (powers.empty()) return true;
  if (powers.size() > 1 || powers.begin()->second != 1) return false;
  const std::string& base = powers.begin()->first;
  return base == "s" || base == "cycle" || (base == "m" && measured.unit.scale >= 1);
}

}  // namespace

void require_status(const FormulaModel& model, const TomlReader& root) {
  const TomlReader data = root.required_table("data");
  static_cast<void>(data.texts("unused"));
  if (model.along || model.data.status) return;
  if (model.modes) {  // whose cells can mark run-outs
    if (std::ranges::count(model.modes->possible, 0U) > 0) return;
  } else if (model.measured.size() != 1 && !model.use_rate) {
    return;
  }
  const Measured& measured = model.measured.front();
  const SpecialColumns special = special_columns(model.data);
  if (measured.form->counted || measured.program.has_paths() || special.lower || special.upper) {
    return;
  }
  refuse_idle_status(data, model.data.table,
                     is_life(measured) ? RowKind::life : RowKind::measurement);
}

}  // namespace wearwell::formula_model
