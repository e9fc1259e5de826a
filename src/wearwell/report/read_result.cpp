#include "wearwell/report/read_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "wearwell/base/error.h"
#include "wearwell/report/plots_json.h"

namespace wearwell {
namespace {

using Json = nlohmann::ordered_json;

std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(fmt::format("cannot read {}", file.string()));
  return {std::istreambuf_iterator<char>(stream), {}};
}

// What was not finite is null: a moment that does not exist, or a limit that is never reached.
double number(const Json& json, const char* name, double null = std::nan("")) {
  const Json& value = json.at(name);
  return value.is_null() ? null : value.get<double>();
}

std::string text(const Json& json, const char* name) {
  return json.at(name).get<std::string>();
}

ParameterSummary read_parameter(const std::string& name, const Json& json) {
  ParameterSummary p{name,
                     text(json, "unit"),
                     number(json, "mean"),
                     number(json, "sd"),
                     number(json, "mcse"),
                     number(json, "q05"),
                     number(json, "q50"),
                     number(json, "q95"),
                     number(json, "ess_bulk"),
                     number(json, "ess_tail"),
                     number(json, "rhat"),
                     {}};
  if (json.contains("exact")) {
    const Json& exact = json["exact"];
    p.exact = {number(exact, "mean"), number(exact, "sd"), number(exact, "q05"),
               number(exact, "q50"), number(exact, "q95")};
  }
  return p;
}

std::vector<ParameterSummary> read_parameters(const Json& json) {
  std::vector<ParameterSummary> parameters;
  for (const auto& [name, each] : json.items()) parameters.push_back(read_parameter(name, each));
  return parameters;
}

Prediction read_interval(const Json& json) {
  return {number(json, "mean"), number(json, "ci05"), number(json, "ci95"), number(json, "pi05"),
          number(json, "pi95")};
}

std::vector<PredictionSummary> read_predictions(const Json& json) {
  std::vector<PredictionSummary> predictions;
  for (const Json& each : json) {
    // The place comes first, under its own name.
    const std::string at = each.begin().key();
    PredictionSummary p{at,
                        number(each, at.c_str()),
                        text(each, "quantity"),
                        text(each, "unit"),
                        read_interval(each),
                        {},
                        {}};
    if (each.contains("exact")) p.exact = read_interval(each["exact"]);
    if (each.contains("measured")) p.measured = number(each, "measured");
    if (each.contains("mean_of")) {
      p.mean_of = text(each, "mean_of");
      p.measured_of = text(each, "pi_of");
    }
    predictions.push_back(std::move(p));
  }
  return predictions;
}

QuantityQuantiles read_quantiles(const Json& json) {
  constexpr double never = std::numeric_limits<double>::infinity();
  QuantityQuantiles q{
      number(json, "q05", never), number(json, "q50", never), number(json, "q95", never), 0, 0, 0};
  if (json.contains("b1")) {
    q.b1 = number(json, "b1", never);
    q.b10 = number(json, "b10", never);
    q.b50 = number(json, "b50", never);
  }
  if (json.contains("predictive")) q.predictive = number(json, "predictive", never);
  if (json.contains("bound")) q.bound = number(json, "bound", never);
  return q;
}

std::vector<QuantitySummary> read_quantities(const Json& json) {
  std::vector<QuantitySummary> quantities;
  for (const Json& each : json) {
    QuantitySummary q{text(each, "name"),
                      text(each, "of"),
                      text(each, "at"),
                      text(each, "unit"),
                      each.contains("b10"),
                      read_quantiles(each),
                      {}};
    if (each.contains("exact")) q.exact = read_quantiles(each["exact"]);
    if (each.contains("credible_level")) q.credible_level = number(each, "credible_level");
    if (each.contains("safe_end")) q.safe_end = number(each, "safe_end");
    quantities.push_back(std::move(q));
  }
  return quantities;
}

CoverageTable read_coverage(const Json& json) {
  constexpr double never = std::numeric_limits<double>::infinity();
  CoverageTable table{text(json, "unit"), {}};
  for (const Json& row : json.at("rows")) {
    table.rows.push_back({row.at("row").get<std::size_t>(),
                          text(row, "label"),
                          text(row, "outcome"),
                          number(row, "life"),
                          {},
                          number(row, "probability"),
                          number(row, "q05", never),
                          number(row, "q95", never),
                          number(row, "b10", never)});
    if (row.contains("until")) table.rows.back().until = number(row, "until");
  }
  return table;
}

ModeSummary read_mode(const Json& json) {
  ModeSummary mode;
  if (json.contains("problem")) {
    mode.problem = text(json, "problem");
    return mode;
  }
  for (const auto& [name, each] : json.at("parameters").items()) {
    mode.parameters.push_back({name, text(each, "unit"), number(each, "value"),
                               number(each, "standard_error"), text(each, "at")});
  }
  mode.log_likelihood = number(json, "log_likelihood");
  mode.log_posterior = number(json, "log_posterior");
  mode.maximum_likelihood = json.at("maximum_likelihood").get<bool>();
  mode.aic = number(json, "aic");
  mode.bic = number(json, "bic");
  mode.observations = number(json, "observations");
  mode.starts = json.at("starts").get<int>();
  mode.reached = json.at("reached").get<int>();
  return mode;
}

LooSummary read_loo(const Json& json) {
  LooSummary summary{text(json, "observation"), {}};
  summary.loo.threshold = number(json, "khat_threshold");
  if (json.contains("error")) summary.loo.error = number(json, "error");
  summary.loo.by_quadrature = json.value("by_quadrature", false);
  for (const Json& each : json.at("pointwise")) {
    constexpr double unknown = std::numeric_limits<double>::infinity();
    LooTerm term{number(each, "elpd"), number(each, "lpd"), number(each, "khat", unknown)};
    if (each.contains("count")) term.count = each["count"].get<int>();
    term.refitted = each.contains("refitted");
    if (each.contains("tail")) term.tail = number(each, "tail");
    summary.loo.terms.push_back(term);
  }
  return summary;
}

Life read_life(const Json& json) {
  constexpr double never = std::numeric_limits<double>::infinity();
  return {number(json, "b1", never),  number(json, "b10", never),
          number(json, "b50", never), number(json, "q05", never),
          number(json, "q95", never), number(json, "inspect_within", never),
          json.contains("passed") ? number(json, "passed") : std::nan("")};
}

LifeSummary read_life_summary(const Json& json) {
  LifeSummary life{text(json, "unit"),
                   number(json, "limit"),
                   text(json, "limit_unit"),
                   number(json, "now"),
                   number(json, "risk"),
                   read_life(json),
                   {}};
  if (json.contains("exact")) life.exact = read_life(json["exact"]);
  return life;
}

std::vector<Check> read_checks(const Json& json) {
  std::vector<Check> checks;
  for (const Json& each : json) {
    const std::string verdict = text(each, "verdict");
    checks.push_back({text(each, "name"),
                      verdict == "pass"   ? Verdict::pass
                      : verdict == "warn" ? Verdict::warn
                                          : Verdict::fail,
                      text(each, "detail"), each.contains("advice") ? text(each, "advice") : ""});
  }
  return checks;
}

PointwiseTable read_pointwise(const Json& json) {
  const Json& units = json.at("units");
  PointwiseTable table{
      text(units, "volume"), text(units, "force"), text(units, "slip"), text(units, "k"), {}};
  for (const Json& row : json.at("rows")) {
    table.rows.push_back({number(row, "cycles"), number(row, "force"), number(row, "slip"),
                          number(row, "volume"), number(row, "k")});
  }
  return table;
}

StudyResult read_summary(const Json& json) {
  const Json &data = json.at("data"), &sampler = json.at("sampler");
  StudyResult result;
  result.version = text(json, "wearwell");
  result.title = text(json, "title");
  result.model = text(json, "model");
  result.equation = text(json, "equation");
  result.data_file = text(data, "file");
  result.data_rows = data.at("rows").get<std::size_t>();
  if (data.contains("fingerprint")) result.data_fingerprint = text(data, "fingerprint");
  result.method = text(sampler, "method");
  result.chains = sampler.at("chains").get<int>();
  result.warmup = sampler.at("warmup").get<int>();
  result.draws = sampler.at("draws").get<int>();
  result.seed = sampler.at("seed").get<std::uint64_t>();
  result.parameters = read_parameters(json.at("parameters"));
  for (const Json& stage : json.at("stages")) {
    result.stages.push_back({stage.at("rows").get<std::size_t>(),
                             read_parameters(stage.at("parameters")),
                             read_predictions(stage.at("predictions")),
                             read_checks(stage.at("checks")), stage.at("trusted").get<bool>()});
  }
  if (json.contains("mode")) result.mode = read_mode(json["mode"]);
  if (json.contains("loo")) result.loo = read_loo(json["loo"]);
  result.predictions = read_predictions(json.at("predictions"));
  if (json.contains("quantities")) result.quantities = read_quantities(json["quantities"]);
  if (json.contains("life")) result.life = read_life_summary(json["life"]);
  if (json.contains("pointwise")) result.pointwise = read_pointwise(json["pointwise"]);
  if (json.contains("coverage")) result.coverage = read_coverage(json["coverage"]);
  if (json.contains("log_evidence")) result.log_evidence = number(json, "log_evidence");
  result.checks = read_checks(json.at("checks"));
  result.trusted = json.at("trusted").get<bool>();
  return result;
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0, end; begin <= line.size(); begin = end + 1) {
    end = std::min(line.find(',', begin), line.size());
    cells.push_back(line.substr(begin, end - begin));
  }
  return cells;
}

// One chain: a line of names, lines of numbers, comments anywhere.
Chain read_chain(const std::filesystem::path& file, std::size_t parameters) {
  std::ifstream stream(file);
  std::string line;
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
  while (std::getline(stream, line)) {
    if (line.empty() || line.front() == '#') continue;
    const auto cells = split(line);
    if (names.empty()) {
      names.assign(cells.begin(), cells.end());
      continue;
    }
    rows.emplace_back();
    for (const std::string_view cell : cells) {
      double value = 0;
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      if (error != std::errc() || end != cell.data() + cell.size()) break;
      rows.back().push_back(value);
    }
    if (rows.back().size() != names.size()) {
      throw InputError(fmt::format("{}, draw {}: it should hold {} numbers", file.string(),
                                   rows.size(), names.size()));
    }
  }
  if (names.size() <= parameters || rows.empty()) {
    throw InputError(
        fmt::format("{}: these are not {} parameters' draws", file.string(), parameters));
  }
  Chain chain;
  chain.values.resize(static_cast<Eigen::Index>(rows.size()),
                      static_cast<Eigen::Index>(parameters));
  const std::size_t first = names.size() - parameters;
  const auto divergent = std::find(names.begin(), names.end(), "divergent__");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t p = 0; p < parameters; ++p) {
      chain.values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(p)) = rows[i][first + p];
    }
    if (divergent != names.end()) {
      NutsStep step{};
      step.divergent = rows[i][static_cast<std::size_t>(divergent - names.begin())] != 0;
      chain.nuts.push_back(step);
    }
  }
  return chain;
}

Json read_json(const std::filesystem::path& file) {
  try {
    return Json::parse(content(file));
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{} is not JSON: {}", file.string(), error.what()));
  }
}

}  // namespace

StudyResult read_result(const std::filesystem::path& folder) {
  std::filesystem::path file = folder / "summary.json";
  StudyResult result;
  try {
    result = read_summary(read_json(file));
    if (std::filesystem::exists(folder / "plots.json")) {
      file = folder / "plots.json";
      result.plots = plots_from_json(read_json(file));
    }
  } catch (const Json::exception& error) {
    throw InputError(
        fmt::format("{} is not what wearwell writes: {}", file.string(), error.what()));
  }
  for (int c = 1; c <= result.chains; ++c) {
    file = folder / fmt::format("draws_{}.csv", c);
    if (!std::filesystem::exists(file)) {
      throw InputError(fmt::format("{} is missing", file.string()));
    }
    result.posterior_draws.push_back(read_chain(file, result.parameters.size()));
  }
  return result;
}

}  // namespace wearwell
