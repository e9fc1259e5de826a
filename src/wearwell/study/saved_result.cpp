#include "wearwell/study/saved_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "wearwell/base/error.h"
#include "wearwell/input/csv_reader.h"
#include "wearwell/input/json_reader.h"
#include "wearwell/present/section_json.h"
#include "wearwell/study/header_json.h"
#include "wearwell/study/long_tables.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {
namespace {

// A value that is not finite is null: a moment that does not exist, or a limit that is never
// reached.
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double never = std::numeric_limits<double>::infinity();
constexpr int most = std::numeric_limits<int>::max();

double number(const JsonReader& json, const char* key, double null = unknown) {
  return json.at(key).number_or(null);
}

std::string text(const JsonReader& json, const char* key) {
  return json.at(key).text();
}

int count(const JsonReader& json, const char* key) {
  return static_cast<int>(json.at(key).integer(0, most));
}

bool by_quadrature(const JsonReader& json) {
  return json.at("by").one_of({"quadrature", "draws"}) == "quadrature";
}

ParameterSummary read_parameter(const std::string& name, const JsonReader& json) {
  const std::string by = json.at("by").one_of({"quadrature", "draws", "least squares"});
  ParameterSummary p{.name = name, .unit = text(json, "unit"), .exact = {}};
  p.drawn = by != "least squares";
  const JsonReader drawn = p.drawn ? json.at("draws") : json;
  p.mean = number(drawn, "mean");
  p.sd = number(drawn, "sd");
  p.q05 = number(drawn, "q05");
  p.q50 = number(drawn, "q50");
  p.q95 = number(drawn, "q95");
  p.mcse = p.drawn ? number(drawn, "mcse") : unknown;
  p.ess_bulk = p.drawn ? number(drawn, "ess_bulk") : unknown;
  p.ess_tail = p.drawn ? number(drawn, "ess_tail") : unknown;
  p.rhat = p.drawn ? number(drawn, "rhat") : unknown;
  if (by == "quadrature") {
    p.exact = {number(json, "mean"), number(json, "sd"), number(json, "q05"), number(json, "q50"),
               number(json, "q95")};
  }
  return p;
}

std::vector<ParameterSummary> read_parameters(const JsonReader& json) {
  std::vector<ParameterSummary> parameters;
  for (const auto& [name, each] : json.members()) parameters.push_back(read_parameter(name, each));
  if (parameters.empty()) json.fail("is empty: a study has at least one parameter");
  return parameters;
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
  mode.density_unit = text(json, "density_unit");
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
  LooSummary summary{text(json, "observation"), {}, text(json, "density_unit")};
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
  if (summary.loo.terms.empty()) json.fail("has no observations");
  return summary;
}

QuantityQuantiles read_quantiles(const JsonReader& json) {
  QuantityQuantiles q{number(json, "q05"), number(json, "q50"), number(json, "q95")};
  const double none = json.find("undetermined") ? unknown : never;
  if (json.find("b10")) q.b10 = number(json, "b10", none);
  if (json.find("predictive")) q.predictive = number(json, "predictive", none);
  if (json.find("bound")) q.bound = number(json, "bound", none);
  if (json.find("upper_bound")) q.upper_bound = number(json, "upper_bound", none);
  if (json.find("mean")) q.mean = number(json, "mean", none);
  if (json.find("numerical_error")) q.numerical_error = number(json, "numerical_error");
  if (const auto tail = json.find("mean_tail")) {
    q.mean_tail = MeanTail{number(*tail, "highest"), {}, {}};
    if (tail->find("beyond")) {
      q.mean_tail->longest = number(*tail, "observed_to");
      q.mean_tail->beyond = number(*tail, "beyond");
    }
  }
  return q;
}

std::vector<QuantitySummary> read_quantities(const JsonReader& json) {
  std::vector<QuantitySummary> quantities;
  for (const JsonReader& each : json.items()) {
    QuantitySummary q{text(each, "name"),
                      text(each, "of"),
                      text(each, "at"),
                      text(each, "unit"),
                      each.find("b10").has_value(),
                      read_quantiles(by_quadrature(each) ? each.at("draws") : each),
                      {}};
    if (by_quadrature(each)) q.exact = read_quantiles(each);
    if (const auto sides = each.find("sides"))
      q.sides = sides->text() == "both" ? BoundSides::both : BoundSides::upper;
    quantities.push_back(std::move(q));
  }
  return quantities;
}

void add_figures(const std::vector<present::Block>& blocks, std::vector<html::Figure>& figures) {
  for (const present::Block& block : blocks) {
    if (const auto* found = std::get_if<present::Figures>(&block.content))
      figures.insert(figures.end(), found->figures.begin(), found->figures.end());
    if (const auto* details = std::get_if<present::Details>(&block.content))
      add_figures(details->blocks, figures);
  }
}

// The last columns are the parameters, in their order.
std::size_t first_parameter(const CsvReader& csv, const std::filesystem::path& file,
                            const std::vector<ParameterSummary>& parameters) {
  const std::vector<std::string>& names = csv.heading();
  const bool fit = names.size() > parameters.size() &&
                   std::equal(parameters.rbegin(), parameters.rend(), names.rbegin(),
                              [](const auto& p, const auto& name) { return p.name == name; });
  if (!fit) {
    throw InputError(fmt::format("{}: its last columns are not the {} parameters of summary.json",
                                 file.string(), parameters.size()));
  }
  return names.size() - parameters.size();
}

// One chain: a line of names, lines of numbers, and comments anywhere.
Chain read_chain(const std::filesystem::path& file,
                 const std::vector<ParameterSummary>& parameters) {
  CsvReader csv(file, "draw", "numbers");
  const std::vector<std::string>& names = csv.heading();
  const std::size_t first = first_parameter(csv, file, parameters);
  const auto found = std::find(names.begin(), names.end(), "divergent__");
  const auto divergent = static_cast<std::size_t>(found - names.begin());
  Chain chain;
  std::vector<double> values;
  while (csv.next()) {
    for (std::size_t c = first; c < names.size(); ++c) values.push_back(csv.number(c));
    if (found == names.end()) continue;
    NutsStep step{};
    step.divergent = csv.flag(divergent);
    chain.nuts.push_back(step);
  }
  if (values.empty()) throw InputError(fmt::format("{} does not contain draws", file.string()));
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto columns = static_cast<Eigen::Index>(parameters.size());
  chain.values = Eigen::Map<const RowMajor>(values.data(), std::ssize(values) / columns, columns);
  return chain;
}

}  // namespace

std::filesystem::path summary_file(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!std::filesystem::exists(folder, ignored))
    throw InputError(fmt::format("no such folder: {}", folder.string()));
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw InputError(fmt::format(
        "{} is a file; give the folder of results that wearwell fit wrote (its last line names it)",
        folder.string()));
  }
  std::filesystem::path file = folder / "summary.json";
  if (std::filesystem::exists(file, ignored)) return file;
  throw InputError(fmt::format(
      "{} does not contain summary.json, so it is not a folder of results of wearwell fit",
      folder.string()));
}

SavedResult read_saved_result(const std::filesystem::path& folder) {
  const std::filesystem::path file = summary_file(folder);
  const auto summary = read_json(file);
  const JsonReader json(summary, file);
  SavedResult result{read_header(json)};
  const auto sampler = json.find("sampler");  // then there are draws, and of parameters
  if (sampler || json.find("parameters"))
    result.parameters = read_parameters(json.at("parameters"));
  if (const auto mode = json.find("mode")) result.mode = read_mode(*mode);
  if (const auto loo = json.find("loo")) result.loo = read_loo(*loo, folder);
  if (const auto quantities = json.find("quantities")) {
    result.quantities = read_quantities(*quantities);
  }
  if (const std::filesystem::path report = folder / "report.json";
      std::filesystem::exists(report)) {
    const auto sections = read_json(report);
    for (const present::Section& each : present::sections_from_json(JsonReader(sections, report)))
      add_figures(each.blocks, result.figures);
  }
  if (sampler) {
    const long long chains = sampler->at("chains").integer(1, max_chains);
    for (long long c = 1; c <= chains; ++c)
      result.draws.push_back(
          read_chain(folder / fmt::format("draws_{}.csv", c), result.parameters));
  }
  return result;
}

SavedReport read_saved_report(const std::filesystem::path& folder) {
  const std::filesystem::path file = summary_file(folder), report = folder / "report.json";
  const auto summary = read_json(file);
  SavedReport saved{read_header(JsonReader(summary, file)), {}};
  if (!std::filesystem::exists(report)) {
    throw InputError(
        fmt::format("{} is missing, because the study was fitted with --no-report; fit it again",
                    report.string()));
  }
  const auto sections = read_json(report);
  saved.sections = present::sections_from_json(JsonReader(sections, report));
  return saved;
}

SavedReport read_saved_report(const std::string& summary, const std::string& report) {
  const auto parsed = [](const std::string& text) {
    auto json = nlohmann::ordered_json::parse(text, nullptr, false);
    if (json.is_discarded()) throw InputError("a saved result is not valid JSON");
    return json;
  };
  const auto header = parsed(summary), sections = parsed(report);
  return {read_header(JsonReader(header, "summary.json")),
          present::sections_from_json(JsonReader(sections, "report.json"))};
}

}  // namespace wearwell
