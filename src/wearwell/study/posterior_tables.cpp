#include "wearwell/study/posterior_tables.h"

#include "wearwell/study/bound_words.h"
#include "wearwell/study/mean_tail.h"
#include "wearwell/study/never_reached.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/present/html.h"
#include "wearwell/study/answers.h"
#include "wearwell/study/long_tables.h"
#include "wearwell/study/numerical_error.h"
#include "wearwell/study/trust_blocks.h"

namespace wearwell {
namespace {

using present::Cell;
using present::Column;
using present::count;
using present::digits;
using present::fixed;
using present::Format;
using present::given;
using present::Range;
using present::Table;

Column interval_column(const std::string& name, const std::string& unit, Format format = {}) {
  return {name, unit, format, true};
}

Table prediction_rows(const char* id, const std::string& caption, const PredictionSummary& first) {
  const bool items = !first.mean_of.empty();
  return {id,
          caption,
          {{"Rows", "1", given},
           {first.at_name, first.at_unit.empty() ? "1" : first.at_unit, given},
           {first.quantity, first.unit},
           interval_column("90 % of the " + (items ? first.mean_of : "mean"), first.unit),
           interval_column(
               items ? "90 % of measurements of a " + first.measured_of : "90 % of measurements",
               first.unit),
           {"Measured", first.unit}}};
}

void add_row(Table& table, std::size_t data_sets, const PredictionSummary& p) {
  const Prediction& b = p.best();
  Cell measured;
  if (p.measured) measured = *p.measured;
  table.rows.push_back({count(data_sets), p.at, b.mean, Range{b.ci05, b.ci95},
                        Range{b.pi05, b.pi95}, std::move(measured)});
}

std::vector<Cell> profile_cells(const std::optional<ProfileSummary>& profile) {
  if (!profile) return {Cell(), Cell()};
  const auto end = [](double value, const std::string& open) -> Cell {
    return open.empty() ? Cell(value) : Cell("open: " + open);
  };
  return {end(profile->lower, profile->lower_open), end(profile->upper, profile->upper_open)};
}

}  // namespace

Format life_format(const std::string& unit, int digits) {
  return is_count(unit) ? present::life(digits) : present::digits(digits);
}

// If the rows describe different quantities or items, each row names its own.
Table mixed_prediction_table(const PosteriorSummary& result) {
  PredictionSummary plain = result.predictions.front();
  plain.quantity = "Mean";
  plain.unit = "1";
  plain.mean_of.clear();
  Table table = prediction_rows("predictions", "Predictions", plain);
  table.columns.insert(table.columns.begin() + 2, {{"Quantity"}, {"Unit"}, {"Of"}});
  for (const PredictionSummary& p : result.predictions) {
    add_row(table, result.data_rows, p);
    const std::string next = p.mean_of == p.measured_of ? "" : ", readings of a " + p.measured_of;
    std::vector<Cell>& cells = table.rows.back();
    cells.insert(cells.begin() + 2, {Cell(p.quantity), Cell(p.unit), Cell(p.mean_of + next)});
  }
  return table;
}

Table prediction_table(const PosteriorSummary& result) {
  const auto& all = result.predictions;
  if (!std::all_of(all.begin(), all.end(), [&](const auto& p) { return p.is_like(all.front()); }))
    return mixed_prediction_table(result);
  Table table = prediction_rows("predictions", "Predictions", result.predictions.front());
  for (const PredictionSummary& p : result.predictions) add_row(table, result.data_rows, p);
  return table;
}

Table stage_prediction_table(const PosteriorSummary& result) {
  Table table;
  for (const StageSummary& stage : result.stages) {
    for (const PredictionSummary& p : stage.predictions) {
      if (table.rows.empty())
        table = prediction_rows("predictions-by-data-set", "Predictions, row by row", p);
      add_row(table, stage.rows, p);
    }
  }
  return table;
}

Table life_table(const LifeSummary& summary) {
  const Life& life = summary.best();
  const Format format = life_format(summary.unit);
  return {
      "life",
      fmt::format("Life until {} {}", html::given(summary.limit), html::unit(summary.limit_unit)),
      {{"B1", summary.unit, format},
       {"B10", summary.unit, format},
       {"B50", summary.unit, format},
       interval_column("90 % interval", summary.unit),
       {"After", summary.unit, given},
       {"Passed already", "%", digits(2)},
       {"If not, inspect within", summary.unit, format},
       {"At a risk of", "%", given}},
      {{life.b1, life.b10, life.b50, Range{life.q05, life.q95}, summary.now, 100 * life.passed,
        life.inspect_within, 100 * summary.risk}}};
}

namespace {

// For numbers summed over few points of the posterior: limits the digits to the known ones and
// shows the error.
void add_numerical_errors(Table& table, const std::vector<QuantitySummary>& quantities,
                          bool bounds) {
  const auto largest = largest_numerical_error(quantities, bounds);
  if (!largest) return;
  for (Column& column : table.columns) column.format = digits(digits_within(*largest));
  table.columns.push_back({"Numerical error", "%", digits(2)});
  auto row = table.rows.begin();
  for (const QuantitySummary& each : quantities) {
    if (each.best().predictive.has_value() != bounds) continue;
    const auto error = each.best().numerical_error;
    (row++)->push_back(error ? Cell(100 * *error) : Cell());
  }
}

}  // namespace

Table quantity_table(const std::vector<QuantitySummary>& quantities) {
  Table table{"quantities",
              results_title(quantities),
              {{"Quantity"},
               {"Unit"},
               {"Of"},
               {"Where"},
               {"5 %"},
               {"50 %"},
               {"95 %"},
               {"Design with"},
               {"B1"},
               {"B10"}}};
  // If there are bounds, they are the design values: of these quantities, or in a table of their own.
  const QuantitySummary* bounded = first_bounded(quantities);
  const std::vector<std::string> named =
      bounded ? bound_columns(*bounded->credible_level, bounded->sides)
              : std::vector<std::string>();
  for (const std::string& name : named) table.columns.push_back({name});
  const bool bounds = std::any_of(quantities.begin(), quantities.end(),
                                  [](const auto& each) { return each.is_bounded(); });
  const bool means = std::any_of(quantities.begin(), quantities.end(),
                                 [](const auto& each) { return each.best().mean.has_value(); });
  if (means) table.columns.push_back({"Mean"});
  for (const QuantitySummary& each : quantities) {
    const QuantityQuantiles& q = each.best();
    if (q.predictive) continue;
    const auto value = [&](double x) -> Cell {
      if (std::isnan(x) && q.mean) return Cell();  // only the mean is known
      return std::isinf(x) && each.is_life ? Cell("never") : Cell(x);
    };
    table.rows.push_back(
        {each.name, each.unit, each.of, each.at, value(q.q05), value(q.q50), value(q.q95),
         bounds || !each.safe_end ? Cell() : value(*each.safe_end < 0.5 ? q.q05 : q.q95),
         each.is_life ? value(q.b1) : Cell(), each.is_life ? value(q.b10) : Cell()});
    const std::size_t before = table.rows.back().size();
    for (const std::optional<double>& bound : {q.bound, q.upper_bound})
      if (bounded && bound) table.rows.back().push_back(value(*bound));
    table.rows.back().resize(before + named.size());
    if (means)
      table.rows.back().push_back(!q.mean              ? Cell()
                                  : is_endless_mean(q) ? Cell(not_finite_text)
                                                       : value(*q.mean));
  }
  add_numerical_errors(table, quantities, false);
  return table;
}

Table bound_table(const std::vector<QuantitySummary>& quantities) {
  Table table{"bounds", "Design values", {}};
  for (const QuantitySummary& each : quantities) {
    const QuantityQuantiles& q = each.best();
    if (!q.predictive) continue;
    if (table.columns.empty()) {
      table.columns = {{"Quantity"}, {"Unit"}, {"Of"}, {"Where"}};
      for (const std::string& name : bound_columns(*each.credible_level, each.sides))
        table.columns.push_back({name});
      for (const char* name : {"5 %", "50 %", "95 %", "Next one"}) table.columns.push_back({name});
    }
    const auto value = [&](double x) -> Cell {
      if (std::isinf(x) && x > 0 && is_b_life(each)) return "never";
      return std::isinf(x) && q.mean_tail ? Cell(not_finite_text) : Cell(x);
    };
    table.rows.push_back({each.name, each.unit, each.of, each.at});
    std::vector<Cell>& row = table.rows.back();
    for (const std::optional<double>& bound : {q.bound, q.upper_bound})
      if (bound) row.push_back(value(*bound));
    for (const double x : {q.q05, q.q50, q.q95}) row.push_back(value(x));
    row.push_back(is_endless_mean(q) ? Cell(not_finite_text) : value(*q.predictive));
  }
  add_numerical_errors(table, quantities, true);
  return table;
}

Table parameter_table(const std::vector<ParameterSummary>& parameters) {
  Table table{"parameters",
              "Parameters",
              {{"Parameter"},
               {"Unit"},
               {"Mean"},
               {"Sd"},
               {"5 %"},
               {"50 %"},
               {"95 %"},
               {"Mean of draws"},
               {"MCSE", "1", digits(2)},
               {"Sd of draws"}}};
  for (const ParameterSummary& p : parameters) {
    const ExactSummary b = p.best();
    table.rows.push_back({p.name, p.unit, b.mean, b.sd, b.q05, b.q50, b.q95, p.mean, p.mcse, p.sd});
  }
  return table;
}

Table prior_table(const std::vector<ParameterSummary>& parameters) {
  Table table{"priors", "Priors", {{"Parameter"}, {"Meaning"}, {"Prior"}, {"Stated by"}}, {}, true};
  for (const ParameterSummary& p : parameters) {
    table.rows.push_back(
        {p.name, p.meaning, p.prior, p.prior_is_default ? "default" : "the study"});
  }
  return table;
}

Table mode_table(const ModeSummary& mode) {
  Table table{mode.maximum_likelihood ? "maximum-likelihood" : "mode",
              mode.maximum_likelihood
                  ? "Maximum likelihood: where the density is highest under these flat priors"
                  : "Mode: where the posterior density is highest",
              {{"Parameter"}, {"Unit"}, {"Mode"}, {"Standard error", "1", digits(3)}}};
  const auto profile = mode.profile();
  if (profile) {
    table.columns.push_back({fmt::format("{:.4g} % profile interval from", 100 * profile->level)});
    table.columns.push_back({"to"});
  }
  const auto add = [&](std::vector<Cell> row, const std::optional<ProfileSummary>& p) {
    if (profile) {
      for (Cell& cell : profile_cells(p)) row.push_back(std::move(cell));
    }
    table.rows.push_back(std::move(row));
  };
  for (const ModeParameter& p : mode.parameters) {
    add({p.name, p.unit, p.value,
         p.at == "inside" ? Cell(p.standard_error) : Cell("on its " + p.at)},
        p.profile);
  }
  for (const ModeQuantity& q : mode.quantities) {
    add({fmt::format("{} of {}{}{}", q.name, q.of, q.at.empty() ? "" : " ", q.at), q.unit, q.value,
         Cell()},
        q.profile);
  }
  return table;
}

Table stage_table(const PosteriorSummary& result) {
  Table table{"parameters-by-data-set", "Parameters, row by row", {{"Rows", "1", given}}};
  for (const ParameterSummary& p : result.parameters) {
    table.columns.push_back({p.name, p.unit});
    table.columns.push_back({"sd of " + p.name, p.unit});
    table.columns.push_back(interval_column("90 % of " + p.name, p.unit));
  }
  table.columns.push_back({"Trusted"});
  for (const StageSummary& stage : result.stages) {
    table.rows.push_back({count(stage.rows)});
    std::vector<Cell>& row = table.rows.back();
    for (const ParameterSummary& p : stage.parameters) {
      const ExactSummary b = p.best();
      row.insert(row.end(), {b.mean, b.sd, Range{b.q05, b.q95}});
    }
    row.emplace_back(stage.trusted ? std::string(trust_word(stage.checks))
                                   : "no: " + names_of(stage.checks, Verdict::fail));
  }
  return table;
}

Table fit_table(const Plots& plots) {
  const History& r = plots.replicated;
  Table table{"fit",
              "Data and fit",
              {{plots.at_name, "1", given},
               {"Measured", plots.unit},
               {"Fitted mean", plots.unit, digits(3)},
               interval_column("90 % of the mean", plots.unit, digits(3)),
               interval_column("90 % of measurements", plots.unit, digits(3))}};
  for (std::size_t i = 0; i < r.at.size(); ++i) {
    table.rows.push_back({r.at[i], plots.measured[i], r.mean[i], Range{r.ci05[i], r.ci95[i]},
                          Range{r.pi05[i], r.pi95[i]}});
  }
  return table;
}

Table draws_table(const std::vector<ParameterSummary>& parameters) {
  Table table{"draws",
              "Draws of each parameter",
              {{"Parameter"},
               {"R-hat", "1", fixed(4)},
               {"Effective draws, center", "1", fixed(0)},
               {"Effective draws, tails", "1", fixed(0)}}};
  for (const ParameterSummary& p : parameters)
    table.rows.push_back({p.name, p.rhat, p.ess_bulk, p.ess_tail});
  return table;
}

}  // namespace wearwell
