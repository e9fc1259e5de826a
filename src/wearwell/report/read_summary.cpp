#include "wearwell/report/read_summary.h"

#include <fmt/format.h>

#include <limits>

#include "wearwell/report/long_tables.h"

namespace wearwell {
namespace {

// What was not finite is null: a moment that does not exist, or a limit that is never reached.
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double never = std::numeric_limits<double>::infinity();
constexpr int most = std::numeric_limits<int>::max();

constexpr int most_chains = 1000;

double number(const JsonReader& json, const char* key, double null = unknown) {
  return json.at(key).number_or(null);
}

std::string text(const JsonReader& json, const char* key) {
  return json.at(key).text();
}

int count(const JsonReader& json, const char* key) {
  return static_cast<int>(json.at(key).integer(0, most));
}

std::size_t rows(const JsonReader& json) {
  return static_cast<std::size_t>(json.integer(1));
}

ParameterSummary read_parameter(const std::string& name, const JsonReader& json) {
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
  if (const auto exact = json.find("exact")) {
    p.exact = {number(*exact, "mean"), number(*exact, "sd"), number(*exact, "q05"),
               number(*exact, "q50"), number(*exact, "q95")};
  }
  return p;
}

std::vector<ParameterSummary> read_parameters(const JsonReader& json) {
  std::vector<ParameterSummary> parameters;
  for (const auto& [name, each] : json.members()) parameters.push_back(read_parameter(name, each));
  if (parameters.empty()) json.fail("is empty: a study has at least one parameter");
  return parameters;
}

Prediction read_interval(const JsonReader& json) {
  return {number(json, "mean"), number(json, "ci05"), number(json, "ci95"), number(json, "pi05"),
          number(json, "pi95")};
}

PredictionSummary read_prediction(const JsonReader& json) {
  const auto members = json.members();
  if (members.empty()) json.fail("is empty");
  // The place comes first, under its own name.
  const auto& [at_name, at] = members.front();
  PredictionSummary p{at_name,
                      at.number_or(unknown),
                      text(json, "quantity"),
                      text(json, "unit"),
                      read_interval(json),
                      {},
                      {}};
  if (const auto exact = json.find("exact")) p.exact = read_interval(*exact);
  if (const auto measured = json.find("measured")) p.measured = measured->number_or(unknown);
  if (json.find("mean_of")) {
    p.mean_of = text(json, "mean_of");
    p.measured_of = text(json, "pi_of");
  }
  return p;
}

std::vector<PredictionSummary> read_predictions(const JsonReader& json) {
  std::vector<PredictionSummary> predictions;
  for (const JsonReader& each : json.items()) predictions.push_back(read_prediction(each));
  return predictions;
}

QuantityQuantiles read_quantiles(const JsonReader& json) {
  QuantityQuantiles q{
      number(json, "q05", never), number(json, "q50", never), number(json, "q95", never), 0, 0, 0};
  if (json.find("b1")) {
    q.b1 = number(json, "b1", never);
    q.b10 = number(json, "b10", never);
    q.b50 = number(json, "b50", never);
  }
  if (json.find("predictive")) q.predictive = number(json, "predictive", never);
  if (json.find("bound")) q.bound = number(json, "bound", never);
  if (q.predictive.has_value() != q.bound.has_value()) {
    json.fail("has one of predictive and bound: they go together");
  }
  return q;
}

QuantitySummary read_quantity(const JsonReader& json) {
  QuantitySummary q{text(json, "name"),
                    text(json, "of"),
                    text(json, "at"),
                    text(json, "unit"),
                    json.find("b10").has_value(),
                    read_quantiles(json),
                    {}};
  if (const auto exact = json.find("exact")) q.exact = read_quantiles(*exact);
  if (const auto level = json.find("credible_level")) q.credible_level = level->number();
  if (q.best().predictive && !q.credible_level) json.at("credible_level");
  if (const auto safe = json.find("safe_end")) q.safe_end = safe->number();
  return q;
}

CoverageTable read_coverage(const JsonReader& json, const std::filesystem::path& folder) {
  CoverageTable table{text(json, "unit"), {}};
  if (const auto tests = json.find("tests")) table.tests = rows(*tests);
  if (json.find("table")) {
    table.rows = read_coverage_table(folder);
    return table;
  }
  for (const JsonReader& row : json.at("rows").items()) {
    table.rows.push_back({rows(row.at("row")),
                          text(row, "label"),
                          text(row, "outcome"),
                          number(row, "life"),
                          {},
                          number(row, "probability"),
                          number(row, "q05", never),
                          number(row, "q95", never),
                          number(row, "b10", never)});
    if (const auto until = row.find("until")) table.rows.back().until = until->number_or(unknown);
  }
  return table;
}

ProfileSummary read_profile(const JsonReader& json) {
  const auto why = [&](const char* key) {
    const auto word = json.find(key);
    return word ? word->text() : std::string();
  };
  return {number(json, "level"), number(json, "lower"), number(json, "upper"), why("lower_open"),
          why("upper_open")};
}

ModeSummary read_mode(const JsonReader& json) {
  ModeSummary mode;
  if (const auto problem = json.find("problem")) {
    mode.problem = problem->text();
    if (mode.problem.empty()) problem->fail("is empty");
    return mode;
  }
  for (const auto& [name, each] : json.at("parameters").members()) {
    mode.parameters.push_back({name, text(each, "unit"), number(each, "value"),
                               number(each, "standard_error"),
                               each.at("at").one_of({"inside", "lower bound", "upper bound"})});
    if (const auto profile = each.find("profile"))
      mode.parameters.back().profile = read_profile(*profile);
  }
  if (const auto quantities = json.find("quantities")) {
    for (const JsonReader& each : quantities->items()) {
      mode.quantities.push_back({text(each, "name"), text(each, "of"), text(each, "at"),
                                 text(each, "unit"), number(each, "value"),
                                 read_profile(each.at("profile"))});
    }
  }
  mode.log_likelihood = number(json, "log_likelihood");
  mode.log_posterior = number(json, "log_posterior");
  mode.maximum_likelihood = json.at("maximum_likelihood").flag();
  mode.aic = number(json, "aic");
  mode.bic = number(json, "bic");
  mode.observations = static_cast<double>(json.at("observations").integer(0));
  mode.starts = count(json, "starts");
  mode.reached = count(json, "reached");
  return mode;
}

LooSummary read_loo(const JsonReader& json, const std::filesystem::path& folder) {
  LooSummary summary{text(json, "observation"), {}};
  summary.loo.threshold = number(json, "khat_threshold");
  if (json.find("error")) summary.loo.error = number(json, "error");
  if (const auto exact = json.find("by_quadrature")) summary.loo.by_quadrature = exact->flag();
  if (json.find("table")) {
    summary.loo.terms = read_loo_table(folder);
  } else {
    for (const JsonReader& each : json.at("pointwise").items()) {
      LooTerm term{number(each, "elpd"), number(each, "lpd"), number(each, "khat", never)};
      if (const auto alike = each.find("count")) {
        term.count = static_cast<int>(alike->integer(1, most));
      }
      term.refitted = each.find("refitted").has_value();
      if (const auto tail = each.find("tail")) term.tail = tail->number();
      summary.loo.terms.push_back(term);
    }
  }
  if (summary.loo.terms.empty()) json.fail("is of no observation");
  return summary;
}

Life read_life(const JsonReader& json) {
  return {number(json, "b1", never),  number(json, "b10", never),
          number(json, "b50", never), number(json, "q05", never),
          number(json, "q95", never), number(json, "inspect_within", never),
          json.find("passed") ? number(json, "passed") : unknown};
}

LifeSummary read_life_summary(const JsonReader& json) {
  LifeSummary life{text(json, "unit"),
                   number(json, "limit"),
                   text(json, "limit_unit"),
                   number(json, "now"),
                   number(json, "risk"),
                   read_life(json),
                   {}};
  if (const auto exact = json.find("exact")) life.exact = read_life(*exact);
  return life;
}

std::vector<Check> read_checks(const JsonReader& json) {
  std::vector<Check> checks;
  for (const JsonReader& each : json.items()) {
    const std::string verdict = each.at("verdict").one_of({"pass", "warn", "fail"});
    const auto advice = each.find("advice");
    checks.push_back({text(each, "name"),
                      verdict == "pass"   ? Verdict::pass
                      : verdict == "warn" ? Verdict::warn
                                          : Verdict::fail,
                      text(each, "detail"), advice ? advice->text() : ""});
  }
  return checks;
}

PointwiseTable read_pointwise(const JsonReader& json, const std::filesystem::path& folder) {
  const JsonReader units = json.at("units");
  PointwiseTable table{
      text(units, "volume"), text(units, "force"), text(units, "slip"), text(units, "k"), {}};
  if (json.find("table")) {
    table.rows = read_pointwise_table(folder);
    return table;
  }
  for (const JsonReader& row : json.at("rows").items()) {
    table.rows.push_back({number(row, "cycles"), number(row, "force"), number(row, "slip"),
                          number(row, "volume"), number(row, "k")});
  }
  return table;
}

StageSummary read_stage(const JsonReader& json, std::size_t parameters) {
  StageSummary stage{rows(json.at("rows")), read_parameters(json.at("parameters")),
                     read_predictions(json.at("predictions")), read_checks(json.at("checks")),
                     json.at("trusted").flag()};
  if (stage.parameters.size() != parameters) {
    json.at("parameters").fail(fmt::format("should hold the {} of the study", parameters));
  }
  return stage;
}

}  // namespace

StudyResult read_summary(const JsonReader& json, const std::filesystem::path& folder) {
  StudyResult result;
  result.version = text(json, "wearwell");
  result.title = text(json, "title");
  result.model = text(json, "model");
  result.equation = text(json, "equation");
  const JsonReader data = json.at("data");
  result.data_file = text(data, "file");
  result.data_rows = rows(data.at("rows"));
  if (const auto fingerprint = data.find("fingerprint")) {
    result.data_fingerprint = fingerprint->text();
  }
  const JsonReader sampler = json.at("sampler");
  result.method = text(sampler, "method");
  result.chains = static_cast<int>(sampler.at("chains").integer(1, most_chains));
  result.warmup = count(sampler, "warmup");
  result.draws = static_cast<int>(sampler.at("draws").integer(1, most));
  result.seed = sampler.at("seed").natural();
  result.parameters = read_parameters(json.at("parameters"));
  for (const JsonReader& stage : json.at("stages").items()) {
    result.stages.push_back(read_stage(stage, result.parameters.size()));
  }
  if (const auto mode = json.find("mode")) result.mode = read_mode(*mode);
  if (const auto loo = json.find("loo")) result.loo = read_loo(*loo, folder);
  result.predictions = read_predictions(json.at("predictions"));
  if (const auto quantities = json.find("quantities")) {
    for (const JsonReader& each : quantities->items()) {
      result.quantities.push_back(read_quantity(each));
    }
  }
  if (const auto life = json.find("life")) result.life = read_life_summary(*life);
  if (const auto pointwise = json.find("pointwise")) {
    result.pointwise = read_pointwise(*pointwise, folder);
  }
  if (const auto coverage = json.find("coverage")) {
    result.coverage = read_coverage(*coverage, folder);
  }
  if (const auto quadrature = json.find("quadrature")) {
    result.quadrature = {quadrature->at("tolerance").number_or(unknown),
                         quadrature->at("reached").number_or(unknown), static_cast<std::size_t>(count(*quadrature, "nodes"))};
  }
  if (const auto evidence = json.find("log_evidence")) {
    result.log_evidence = evidence->number_or(unknown);
  }
  result.checks = read_checks(json.at("checks"));
  result.trusted = json.at("trusted").flag();
  return result;
}

}  // namespace wearwell
