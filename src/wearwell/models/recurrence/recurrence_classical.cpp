#include "wearwell/models/recurrence/recurrence_classical.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/models/recurrence/exact_bounds.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/terminal_rows.h"

namespace wearwell::recurrence {
namespace {

using Json = nlohmann::ordered_json;

// A positive function of the parameters, SI.
struct PositiveQuantity {
  std::string name, at;
  Unit unit;
  Function value;
  std::optional<ExactBounds> exact = {};  // SI
};

struct UnbiasedEstimate {
  std::string name, at, unit;
  double value = 0;  // in this unit
};

// Bounds that take beta as known, at its estimate.
struct GivenBeta {
  std::string name;
  Interval bounds;
};

struct Estimates {
  std::string problem;
  double log_likelihood = 0;
  std::vector<ClassicalEstimate> parameters, quantities;
  std::vector<UnbiasedEstimate> unbiased = {};
  std::optional<GivenBeta> lambda = {};
  std::vector<std::string> notes;
};

std::optional<ExactBounds> exact_of(const std::optional<Interval>& interval, const char* method) {
  if (!interval) return {};
  return ExactBounds{interval->lower, interval->upper, method};
}

constexpr const char* mtbf_name = "mean time between failures";

constexpr const char* lambda_note =
    "Crow's bounds of lambda take beta as known; those by Fisher's information and by the "
    "likelihood "
    "ratio do not, and are wider.";

std::string lambda_name(const Asked& asked) {
  return fmt::format("lambda, t in {}", asked.data.unit.text);
}

std::vector<PositiveQuantity> power_law_quantities(const Asked& asked,
                                                   const std::optional<PowerLawSample>& sample) {
  const Process& process = asked.process;
  const double reference = from_si(asked.data.unit, process.reference);
  std::vector<PositiveQuantity> all = {
      {lambda_name(asked), "", Unit{"1", 1, 0},
       [reference](const double* x) { return x[1] * std::pow(reference, -x[0]); }},
      {"eta", "", asked.data.unit,
       [process](const double* x) { return process.reference * std::pow(x[1], -1 / x[0]); }}};
  for (const double age : asked.ages) {
    PositiveQuantity mtbf{
        mtbf_name, "at age " + age_text(asked.data, age), asked.data.unit,
        [process, age](const double* x) { return 1 / process.intensity(x, age); }};
    if (sample && age == sample->end)
      mtbf.exact = exact_of(exact_mtbf(*sample, asked.classical->outside()), "Crow");
    all.push_back(std::move(mtbf));
    PositiveQuantity until{
        "age per failure", "until age " + age_text(asked.data, age), asked.data.unit,
        [process, age](const double* x) { return age / process.mean_by(x, age); }};
    if (sample && age == sample->end)
      until.exact =
          exact_of(exact_age_per_failure(*sample, asked.classical->outside()), "chi-square");
    all.push_back(std::move(until));
  }
  return all;
}

std::vector<PositiveQuantity> quantities_of(const Asked& asked,
                                            const std::optional<PowerLawSample>& sample) {
  switch (asked.process.kind) {
    case ProcessKind::power_law:
      return power_law_quantities(asked, sample);
    case ProcessKind::renewal:
      return {{mtbf_name, "", asked.data.unit,
               [](const double* x) { return x[1] * std::tgamma(1 + 1 / x[0]); }}};
    case ProcessKind::phases:
      break;
  }
  return {};
}

// The exact bounds of the parameters, SI.
std::optional<ExactBounds> exact_parameter(const Asked& asked,
                                           const std::optional<PowerLawSample>& sample,
                                           std::size_t i) {
  const double outside = asked.classical->outside();
  if (asked.process.kind == ProcessKind::phases)
    return exact_of(exact_phase(asked.process, asked.data.units, i, outside), "chi-square");
  if (asked.process.kind == ProcessKind::power_law && i == 0 && sample)
    return exact_of(exact_beta(*sample, outside), "chi-square");
  if (asked.process.kind == ProcessKind::power_law && i == 1 && sample &&
      asked.process.reference == sample->end) {
    const auto age = exact_age_per_failure(*sample, outside);
    if (age) return ExactBounds{sample->end / age->upper, sample->end / age->lower, "chi-square"};
  }
  return {};
}

ClassicalEstimate reported(const std::string& name, const std::string& at, const Unit& unit,
                           const ClassicalBounds& bounds, const std::optional<ExactBounds>& exact,
                           const Function& value, const Asked& asked, const WeightedDraws& draws) {
  ClassicalEstimate estimate;
  estimate.name = name;
  estimate.at = at;
  estimate.unit = unit.text;
  estimate.scale = "log";
  set_bounds(estimate, bounds, [&](double y) { return from_si(unit, std::exp(y)); });
  const QuantityDistribution posterior(draws, value);
  const double outside = asked.classical->outside();
  estimate.posterior_lower = from_si(unit, posterior.quantile(outside));
  estimate.posterior_upper = from_si(unit, posterior.quantile(1 - outside));
  if (exact)
    estimate.exact =
        ExactBounds{from_si(unit, exact->lower), from_si(unit, exact->upper), exact->method};
  return estimate;
}

void add_maximum(const Asked& asked, const Fit& fit, const std::optional<PowerLawSample>& sample,
                 Estimates& found) {
  const std::vector<Parameter>& parameters = asked.parameters;
  const std::vector<NormalScale> scales(parameters.size(), NormalScale::logarithm);
  const MaximumLikelihood maximum =
      maximum_of(process_likelihood(asked.process, asked.data), scales, parameters, fit.pooled);
  if (!maximum.found()) {
    found.problem = fmt::format(
        "the likelihood has no maximum: it rises without end along {}, because too few "
        "failures were observed",
        parameters[static_cast<std::size_t>(maximum.rising())].name);
    return;
  }
  const WeightedDraws& draws = fit.exact ? fit.exact->nodes : fit.pooled;
  const double within = asked.classical->within();
  found.log_likelihood = maximum.log_likelihood();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    found.parameters.push_back(reported(
        parameters[i].name, "", parameters[i].unit,
        maximum.of_parameter(static_cast<Eigen::Index>(i), within),
        exact_parameter(asked, sample, i), [i](const double* x) { return x[i]; }, asked, draws));
  }
  for (const PositiveQuantity& each : quantities_of(asked, sample)) {
    const auto at_log = [&each](const double* x) { return std::log(each.value(x)); };
    const ClassicalBounds bounds = maximum.of(
        at_log, [&](const double* x, double y) { return at_log(x) - y; }, within);
    found.quantities.push_back(
        reported(each.name, each.at, each.unit, bounds, each.exact, each.value, asked, draws));
  }
}

// beta-bar, and what follows from it at a common end of observation.
void add_unbiased(const Asked& asked, const std::optional<PowerLawSample>& sample,
                  Estimates& found) {
  if (asked.process.kind != ProcessKind::power_law || !sample) return;
  const auto beta = sample->unbiased_beta();
  if (!beta) return;
  const auto add = [&](const std::string& name, const std::string& at, const std::string& unit,
                       double value) {
    found.unbiased.push_back({name, at, unit, value});
  };
  add("beta", "", "1", *beta);
  add("growth rate, 1 - beta", "", "1", 1 - *beta);
  if (!std::isfinite(sample->end)) return;
  const double end = from_si(asked.data.unit, sample->end);
  const double each = static_cast<double>(sample->failures) / static_cast<double>(sample->units);
  add(lambda_name(asked), "", "1", each / std::pow(end, *beta));
  add(mtbf_name, "at age " + age_text(asked.data, sample->end), asked.data.unit.text,
      end / (each * *beta));
}

// Crow's bounds of lambda: those of the expected failures until the common end, over its power beta.
void add_lambda(const Asked& asked, const std::optional<PowerLawSample>& sample, Estimates& found) {
  if (asked.process.kind != ProcessKind::power_law || !sample || found.parameters.empty()) return;
  const auto age = exact_age_per_failure(*sample, asked.classical->outside());
  if (!age) return;
  const double power =
      std::pow(from_si(asked.data.unit, sample->end), found.parameters.front().value);
  found.lambda = GivenBeta{lambda_name(asked),
                           {sample->end / age->upper / power, sample->end / age->lower / power}};
}

void add_notes(const Asked& asked, const std::optional<PowerLawSample>& sample, Estimates& found) {
  const auto note = [&](const char* text) { found.notes.push_back(text); };
  const bool rounded = asked.process.rounding > 0;
  if (asked.process.kind == ProcessKind::phases) {
    note(
        "Exact: chi-square bounds of a constant intensity. In a phase that a time limit ends the "
        "lower bound has two degrees of freedom more.");
    return;
  }
  if (asked.process.kind == ProcessKind::renewal) return;
  if (!sample) {
    note("Exact bounds need units that were observed from age 0.");
    return;
  }
  if (asked.data.units.front().grouped) {
    note(
        "Exact: the expected failures until the end of observation and the age per failure, by the "
        "chi-square distribution of their number. Beta and the mean time between failures have no "
        "exact bounds and no estimates without bias where failures are counted by interval.");
    if (found.lambda) note(lambda_note);
    return;
  }
  note(
      "Exact: beta by the chi-square distribution, given the numbers of failures; the mean time "
      "between failures at the end of observation by Crow's conditional distribution; the expected "
      "failures and the age per failure until then by the chi-square distribution of their "
      "number.");
  if (found.lambda) note(lambda_note);
  if (!std::isfinite(sample->end))
    note("Crow's bounds of the mean time between failures need one common end of observation.");
  else if (!sample->time_ended && !sample->failure_ended)
    note(
        "Crow's bounds of the mean time between failures are for several units that a time limit "
        "ends, or one unit whose last failure ends the test.");
  else if (std::find(asked.ages.begin(), asked.ages.end(), sample->end) == asked.ages.end())
    note("Crow's bounds of the mean time between failures hold at the end of observation only.");
  if (rounded) note("Exact bounds take rounded ages as exact.");
}

present::Table unbiased_table(const Estimates& found) {
  present::Table table{"unbiased-estimates",
                       "Crow's estimates without bias of beta",
                       {{"Quantity"}, {"Unit"}, {"Estimate"}}};
  for (const UnbiasedEstimate& each : found.unbiased)
    table.rows.push_back(
        {each.at.empty() ? each.name : each.name + " " + each.at, each.unit, each.value});
  return table;
}

present::Table lambda_table(const GivenBeta& lambda) {
  present::Table table{"lambda-given-beta",
                       "Crow's bounds of lambda, beta at its estimate",
                       {{"Quantity"}, {"From"}, {"To"}}};
  table.rows.push_back({lambda.name, lambda.bounds.lower, lambda.bounds.upper});
  return table;
}

Json classical_json(const Asked& asked, const Estimates& found) {
  Json json = {{"level", asked.classical->level},
               {"sides", asked.classical->two_sided ? "two" : "one"},
               {"life_unit", asked.data.unit.text}};
  Json& maximum = json["maximum_likelihood"];
  if (!found.problem.empty()) {
    maximum = {{"problem", found.problem}};
  } else {
    maximum = {{"log_likelihood", found.log_likelihood + asked.density.total},
               {"density_unit", asked.density.text},
               {"parameters", Json::array()},
               {"quantities", Json::array()}};
    for (const ClassicalEstimate& each : found.parameters)
      maximum["parameters"].push_back(estimate_json(each));
    for (const ClassicalEstimate& each : found.quantities)
      maximum["quantities"].push_back(estimate_json(each));
  }
  json["groups"] = Json::array();
  if (!found.unbiased.empty()) {
    json["unbiased"] = Json::array();
    for (const UnbiasedEstimate& each : found.unbiased)
      json["unbiased"].push_back(
          {{"name", each.name}, {"at", each.at}, {"unit", each.unit}, {"value", each.value}});
  }
  if (found.lambda)
    json["lambda_given_beta"] = {{"name", found.lambda->name},
                                 {"lower", found.lambda->bounds.lower},
                                 {"upper", found.lambda->bounds.upper}};
  json["notes"] = found.notes;
  return json;
}

}  // namespace

void add_classical(const Asked& asked, const Fit& fit, PresetAddition& added) {
  const auto sample = power_law_sample(asked.data.units);
  Estimates found;
  add_maximum(asked, fit, sample, found);
  add_unbiased(asked, sample, found);
  add_lambda(asked, sample, found);
  add_notes(asked, sample, found);
  added.body["classical"] = classical_json(asked, found);
  std::vector<ClassicalEstimate> all = found.parameters;
  all.insert(all.end(), found.quantities.begin(), found.quantities.end());
  for (ClassicalEstimate& each : all)
    if (!each.at.empty()) each.name += " " + each.at;
  std::string words =
      "Classical estimates, to lay beside other programs. Maximum likelihood of the data alone, "
      "without the priors; normal bounds by the observed Fisher information of the logarithm.";
  if (!found.problem.empty())
    words =
        "Classical estimates: there is none by maximum likelihood, because " + found.problem + ".";
  for (const std::string& each : found.notes) words += " " + each;
  std::vector<present::Block>& blocks = added.blocks["predictions"];
  blocks.push_back({present::Prose{words}});
  const present::Table unbiased = unbiased_table(found);
  added.text += fmt::format("\nClassical estimates ({})\n", confidence_text(*asked.classical));
  if (found.problem.empty()) {
    blocks.push_back({estimate_table(all, *asked.classical)});
    added.text += estimate_text(all);
  } else {
    added.text += wrapped("There is no maximum likelihood estimate: " + found.problem + ".", 2, 4);
  }
  if (!unbiased.rows.empty()) {
    blocks.push_back({unbiased});
    std::vector<std::vector<std::string>> rows = {{unbiased.caption + ":", "estimate"}};
    for (const UnbiasedEstimate& each : found.unbiased)
      rows.push_back(
          {"  " + printable_heading(each.at.empty() ? each.name : each.name + " " + each.at,
                                    each.unit),
           plain_number(each.value)});
    added.text += "\n" + text_table(rows);
  }
  if (found.lambda) {
    const present::Table lambda = lambda_table(*found.lambda);
    blocks.push_back({lambda});
    added.text +=
        "\n" + text_table({{lambda.caption + ":", "from", "to"},
                           {"  " + found.lambda->name, plain_number(found.lambda->bounds.lower),
                            plain_number(found.lambda->bounds.upper)}});
  }
  for (const std::string& each : found.notes) added.text += wrapped(each, 2, 4);
}

}  // namespace wearwell::recurrence
