#include "wearwell/models/formula_model/unit_readings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wearwell/base/error.h"

namespace wearwell::formula_model {
namespace {

// The label that identifies units: the one with random effects, or the only one if rows follow each
// other.
std::optional<std::string> label_of_units(const FormulaModel& model) {
  if (model.label) return model.label;
  const bool paths =
      std::any_of(model.measured.begin(), model.measured.end(),
                  [](const Measured& m) { return m.program.has_paths() || m.process; });
  if (paths && model.symbols.labels.size() == 1) return model.symbols.labels.front().name;
  return {};
}

}  // namespace

ReadingReader::ReadingReader(std::shared_ptr<const FormulaModel> model) : model_(std::move(model)) {
  const FormulaData& data = model_->data;
  const auto is_measured = [&](const std::string& name) {
    return std::any_of(model_->measured.begin(), model_->measured.end(),
                       [&](const Measured& each) { return each.column == name; });
  };
  const SpecialColumns special = special_columns(data);
  for (const NumberColumn& each : data.numbers) {
    const bool special_name =
        each.name == special.lower || each.name == special.upper || each.name == special.entry;
    columns_.push_back({each.name, each.unit.unit, is_measured(each.name) || special_name});
  }
  const std::optional<std::string> units = label_of_units(*model_);
  for (std::size_t l = 0; l < data.labels.size(); ++l) {
    if (data.labels[l].name == units) continue;
    labels_.push_back(data.labels[l].name);
    label_of_.push_back(l);
  }
  needed_.assign(model_->row_symbols.columns.size(), false);
  needed_label_.assign(model_->row_symbols.labels.size(), false);
  special_ = special.status || special.lower || special.upper || special.entry || special.count;
  for (const Measured& each : model_->measured) {
    special_ |= each.trials || each.form->counted;
    for (std::size_t c = 0; c < needed_.size(); ++c) {
      needed_[c] = needed_[c] || each.program.uses_column(c);
    }
    for (std::size_t l = 0; l < needed_label_.size(); ++l) {
      needed_label_[l] = needed_label_[l] || each.program.uses_label(l);
    }
    const auto column = std::find_if(data.numbers.begin(), data.numbers.end(),
                                     [&](const auto& c) { return c.name == each.column; });
    measured_.push_back(static_cast<std::size_t>(column - data.numbers.begin()));
  }
  for (std::size_t c = 0; c < needed_.size(); ++c) {
    if (model_->along == model_->row_symbols.columns[c].name) needed_[c] = true;
  }
}

int ReadingReader::level_of(const LabelColumn& label, const std::string& text) const {
  const auto at = std::find(label.levels.begin(), label.levels.end(), text);
  return at == label.levels.end() ? -1 : static_cast<int>(at - label.levels.begin());
}

std::string ReadingReader::read(const prognosis::Reading& from, UnitReading& reading) const {
  if (from.numbers.size() != columns_.size() || from.labels.size() != labels_.size()) {
    throw InputError(fmt::format("a reading has {} numbers and {} labels; expected are {} and {}",
                                 from.numbers.size(), from.labels.size(), columns_.size(),
                                 labels_.size()));
  }
  reading = {};
  reading.row.numbers = from.numbers;
  reading.row.labels.assign(model_->row_symbols.labels.size(), 0);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const double x = from.numbers[c];
    if (std::isinf(x)) return fmt::format("{} is not finite", columns_[c].name);
    if (needed_[c] && std::isnan(x)) return fmt::format("{} is missing", columns_[c].name);
    if (model_->along == columns_[c].name) reading.place = x;
  }
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    const LabelColumn& label = model_->data.labels[label_of_[i]];
    for (std::size_t l = 0; l < needed_label_.size(); ++l) {
      if (model_->row_symbols.labels[l].name != label.name) continue;
      const int level = level_of(label, from.labels[i]);
      if (level < 0 && needed_label_[l]) {
        return from.labels[i].empty()
                   ? fmt::format("{} is missing", label.name)
                   : fmt::format("'{}' is not a {} of the study: {}", from.labels[i], label.name,
                                 fmt::join(label.levels, ", "));
      }
      reading.row.labels[l] = std::max(level, 0);
    }
  }
  if (special_) return read_special(from, reading);
  bool any = false;
  for (std::size_t m = 0; m < measured_.size(); ++m) {
    const double y = from.numbers[measured_[m]];
    reading.responses.emplace_back();
    if (std::isnan(y)) continue;
    if (model_->measured[m].form->positive && !(y > 0)) {
      return fmt::format("{} must be positive for the {} family", columns_[measured_[m]].name,
                         model_->measured[m].form->name);
    }
    reading.responses.back() = Response{.at = y};
    any = true;
  }
  if (any) return {};
  std::vector<std::string> names;
  for (const Measured& each : model_->measured) names.push_back(each.column);
  return names.size() == 1
             ? fmt::format("{} is missing", names.front())
             : fmt::format("nothing was measured: {} are missing", fmt::join(names, ", "));
}

// The message of the study's own reader for such a row.
std::string ReadingReader::read_special(const prognosis::Reading& from,
                                        UnitReading& reading) const {
  const SpecialColumns special = special_columns(model_->data);
  bool any = false;
  try {
    const FormulaData data = one_row(from);
    for (const Measured& each : model_->measured) {
      const bool may_lack = model_->measured.size() > 1;
      const Observed observed =
          read_observed(data, each.column, *each.form, special, each.trials, may_lack);
      reading.responses.emplace_back();
      if (observed.rows.empty()) continue;
      reading.responses.back() = observed.responses.front();
      reading.count = observed.counts.front();
      any = true;
    }
  } catch (const InputError& error) {
    return error.what();
  }
  return any ? "" : "nothing was measured";
}

FormulaData ReadingReader::one_row(const prognosis::Reading& from) const {
  FormulaData data;
  data.table.source = "the reading";
  data.table.rows = 1;
  data.status = model_->data.status;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const NumberColumn& column = model_->data.numbers[c];
    data.numbers.push_back({column.name, column.column, column.unit, {from.numbers[c]}});
  }
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    const LabelColumn& label = model_->data.labels[label_of_[i]];
    data.labels.push_back({label.name, label.column, {from.labels[i]}, {0}});
    Column text;
    text.name = label.column;
    text.text = {from.labels[i]};
    data.table.columns.push_back(text);
  }
  return data;
}

std::vector<UnitReading> ReadingReader::of_study(std::size_t unit) const {
  std::vector<UnitReading> all;
  const FormulaData& data = model_->data;
  for (const std::size_t row : model_->order) {
    if (model_->unit_of_row[row] != unit) continue;
    UnitReading reading;
    for (const NumberColumn& each : data.numbers) {
      reading.row.numbers.push_back(each.values[row]);
      if (model_->along == each.name) reading.place = each.values[row];
    }
    for (const formula::LabelSymbol& each : model_->row_symbols.labels) {
      reading.row.labels.push_back(data.label(each.name)->at[row]);
    }
    for (const Measured& each : model_->measured) {
      reading.responses.emplace_back();
      const auto at = std::lower_bound(each.observed.rows.begin(), each.observed.rows.end(), row);
      if (at == each.observed.rows.end() || *at != row) continue;
      const auto i = static_cast<std::size_t>(at - each.observed.rows.begin());
      reading.responses.back() = each.observed.responses[i];
      reading.count = each.observed.counts[i];
    }
    all.push_back(std::move(reading));
  }
  return all;
}

void sort_along(std::vector<UnitReading>& readings) {
  const auto before = [](double a, double b) { return std::isnan(b) ? !std::isnan(a) : a < b; };
  std::stable_sort(
      readings.begin(), readings.end(), [&](const UnitReading& a, const UnitReading& b) {
        if (a.place != b.place) return a.place < b.place;
        if (a.row.labels != b.row.labels) return a.row.labels < b.row.labels;
        return std::lexicographical_compare(a.row.numbers.begin(), a.row.numbers.end(),
                                            b.row.numbers.begin(), b.row.numbers.end(), before);
      });
}

std::shared_ptr<const FormulaModel> model_of_unit(const FormulaModel& model,
                                                  const std::vector<UnitReading>& readings) {
  auto own = std::make_shared<FormulaModel>();
  own->lines = model.lines;
  own->symbols = model.symbols;
  own->row_symbols = model.row_symbols;
  own->parameters = model.parameters;
  own->shared = model.shared;
  own->effects = model.effects;
  own->label = model.label;
  own->population = model.population;
  own->correlated = model.correlated;
  own->along = model.along;
  own->units = {""};
  const std::size_t n = readings.size();
  own->data.table.rows = n;
  own->data.table.source = model.data.table.source;
  own->order.resize(n);
  std::iota(own->order.begin(), own->order.end(), std::size_t{0});
  own->unit_of_row.assign(n, 0);
  for (std::size_t c = 0; c < model.data.numbers.size(); ++c) {
    const NumberColumn& column = model.data.numbers[c];
    own->data.numbers.push_back({column.name, column.column, column.unit, {}});
    for (const UnitReading& each : readings) {
      own->data.numbers.back().values.push_back(each.row.numbers[c]);
    }
  }
  for (const LabelColumn& label : model.data.labels) {
    own->data.labels.push_back({label.name, label.column, label.levels, std::vector<int>(n, 0)});
    for (std::size_t l = 0; l < model.row_symbols.labels.size(); ++l) {
      if (model.row_symbols.labels[l].name != label.name) continue;
      for (std::size_t i = 0; i < n; ++i) {
        own->data.labels.back().at[i] = readings[i].row.labels[l];
      }
    }
  }
  for (std::size_t m = 0; m < model.measured.size(); ++m) {
    Measured measured = model.measured[m];
    measured.observed = {};
    for (std::size_t i = 0; i < n; ++i) {
      if (!readings[i].responses[m]) continue;
      measured.observed.rows.push_back(i);
      measured.observed.responses.push_back(*readings[i].responses[m]);
      measured.observed.counts.push_back(readings[i].count);
    }
    if (!measured.observed.rows.empty()) own->measured.push_back(std::move(measured));
  }
  return own;
}

}  // namespace wearwell::formula_model
