#include "wearwell/study/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "wearwell/input/csv_reader.h"
#include "wearwell/present/table.h"

namespace wearwell {
namespace {

void add_predictions(std::string& out, std::size_t rows,
                     const std::vector<PredictionSummary>& predictions, bool of_items) {
  for (const PredictionSummary& p : predictions) {
    const Prediction& b = p.best();
    fmt::format_to(std::back_inserter(out), "{},{},{},{},{},{},{},{},{},{}{}\n", rows, p.at,
                   printable_csv_cell(p.quantity), printable_csv_cell(p.unit), b.mean, b.ci05,
                   b.ci95, b.pi05, b.pi95, p.measured ? fmt::format("{}", *p.measured) : "",
                   of_items ? "," + printable_csv_cell(p.measured_of) : "");
  }
}

// For studies that predict lives and derived quantities: the requested quantities, then each test.
std::string lives_csv(const PosteriorSummary& result) {
  // The last column is there with upper bounds only, so that files without them stay as they were.
  const bool upper = std::any_of(result.quantities.begin(), result.quantities.end(),
                                 [](const auto& q) { return q.best().upper_bound.has_value(); });
  std::string out = "rows,quantity,of,at,unit,q05,q50,q95,bound,predictive,b1,b10,measured,outcome";
  out += upper ? ",upper_bound\n" : "\n";
  auto end = std::back_inserter(out);
  const auto cell = [](const std::optional<double>& x) { return x ? fmt::format("{}", *x) : ""; };
  for (const QuantitySummary& q : result.quantities) {
    const QuantityQuantiles& b = q.best();
    std::optional<double> b1, b10;
    if (q.is_life) {
      b1 = b.b1;
      b10 = b.b10;
    }
    fmt::format_to(end, "{},{},{},{},{},{},{},{},{},{},{},{},,{}\n", result.data_rows,
                   printable_csv_cell(q.name), printable_csv_cell(q.of), printable_csv_cell(q.at),
                   printable_csv_cell(q.unit), b.q05, b.q50, b.q95, cell(b.bound),
                   cell(b.predictive), cell(b1), cell(b10), upper ? "," + cell(b.upper_bound) : "");
  }
  if (!result.coverage) return out;
  for (const CoverageRow& row : result.coverage->rows) {
    const std::string of = row.label.empty() ? "test" : "test of type " + row.label;
    fmt::format_to(end, "{},life,{},row {},{},{},,{},,,,{},{},{}{}\n", result.data_rows,
                   printable_csv_cell(of), row.row, printable_csv_cell(result.coverage->unit),
                   row.q05, row.q95, row.b10, row.life, row.outcome, upper ? "," : "");
  }
  return out;
}

}  // namespace

std::string draws_csv(const PosteriorSummary& result, std::size_t index) {
  const Chain& chain = result.posterior_draws[index];
  const bool nuts = !chain.nuts.empty();
  std::string out = fmt::format(
      "# model = {}\n# wearwell_version = {}\n# method = {}\n# num_samples = {}\n# num_warmup = "
      "{}\n"
      "# save_warmup = 0\n# thin = 1\n# id = {}\n# seed = {}\n",
      result.model, result.version, result.method, result.draws, result.warmup, index + 1,
      result.seed);
  for (const ParameterSummary& parameter : result.parameters) {
    out += fmt::format("# unit of {} = {}\n", parameter.name, parameter.unit);
  }
  out +=
      nuts ? "lp__,accept_stat__,stepsize__,treedepth__,n_leapfrog__,divergent__,energy__" : "lp__";
  for (const ParameterSummary& parameter : result.parameters) out += "," + parameter.name;
  out += '\n';
  if (nuts) out += fmt::format("# Adaptation terminated\n# Step size = {:.6g}\n", chain.step_size);
  for (const std::string& note : chain.notes) out += fmt::format("# {}\n", note);
  auto end = std::back_inserter(out);
  for (Eigen::Index i = 0; i < chain.values.rows(); ++i) {
    const auto row = static_cast<std::size_t>(i);
    fmt::format_to(end, "{}", chain.log_density[row]);
    if (nuts) {
      const NutsStep& step = chain.nuts[row];
      fmt::format_to(end, ",{},{},{},{},{},{}", step.accept_stat, chain.step_size, step.treedepth,
                     step.n_leapfrog, static_cast<int>(step.divergent), step.energy);
    }
    for (const double value : chain.values.row(i)) fmt::format_to(end, ",{}", value);
    out += '\n';
  }
  return out;
}

std::string predictions_csv(const PosteriorSummary& result) {
  const bool at_points =
      !result.predictions.empty() ||
      std::any_of(result.stages.begin(), result.stages.end(),
                  [](const StageSummary& stage) { return !stage.predictions.empty(); });
  if (!at_points && (!result.quantities.empty() || result.coverage)) return lives_csv(result);
  std::string at = "cycles";
  if (!result.predictions.empty()) {
    const PredictionSummary& first = result.predictions.front();
    at = printable_csv_cell(
        present::heading(first.at_name, first.at_unit.empty() ? "1" : first.at_unit));
  }
  // If some predictions are for observed items, each row names its item.
  const bool of_items = std::any_of(
      result.predictions.begin(), result.predictions.end(),
      [](const auto& p) { return !p.measured_of.empty() && p.mean_of == p.measured_of; });
  std::string out = fmt::format("rows,{},quantity,unit,mean,ci05,ci95,pi05,pi95,measured{}\n", at,
                                of_items ? ",of" : "");
  for (const StageSummary& stage : result.stages)
    add_predictions(out, stage.rows, stage.predictions, of_items);
  if (result.stages.empty()) add_predictions(out, result.data_rows, result.predictions, of_items);
  return out;
}

}  // namespace wearwell
