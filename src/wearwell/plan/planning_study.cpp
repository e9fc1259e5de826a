#include "wearwell/plan/planning_study.h"
#include "wearwell/plan/no_mixtures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/contains.h"
#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/rng.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/infer/posterior_shape.h"
#include "wearwell/input/as_read.h"
#include "wearwell/input/heading.h"
#include "wearwell/prob/family_form.h"
#include "wearwell/study/inference_data.h"

namespace wearwell::plan {
namespace {

using prognosis::DataRoles;

// The column of the tests for one of the study: by its heading, or by its name.
const Column* column_for(const Table& rows, const DataRoles::Named& named) {
  for (const Column& each : rows.columns)
    if (each.name == named.column) return &each;
  for (const Column& each : rows.columns)
    if (each.name == named.name || read_heading(each.name, "").name == named.name) return &each;
  return nullptr;
}

// Two values of a measured column, in turn.
struct MeasuredPair {
  double even = 1, odd = 10;
};

Column stand_in(const DataRoles::Named& named, std::size_t rows,
                const std::optional<MeasuredPair>& measured, bool label) {
  Column column{named.column, !label && named.name != "status", {}, {}};
  for (std::size_t i = 0; i < rows; ++i) {
    if (named.name == "status") {
      column.text.push_back("failure");
    } else if (label) {
      column.text.push_back(fmt::format("stand-in {}", i + 1));
    } else if (named.name == "count") {
      column.numbers.push_back(1);
    } else if (measured) {
      column.numbers.push_back(i % 2 ? measured->odd : measured->even);
    } else {
      // A value that any model reads; if the likelihood uses the column, `read_candidates` asks for it.
      column.numbers.push_back(0.5);
    }
  }
  return column;
}

// Values that the family allows, far apart: the search for the range of outcomes begins from their
// spread.
MeasuredPair values_of_family(const TomlReader& root, const std::string& name) {
  if (root.required_text("model") != "formula") return {};
  const std::string family =
      root.required_table("likelihood").required_table(name).required_text("family");
  bool any = false, positive = false, counted = false;
  for (const ResponseForm& form : response_forms()) {
    if (form.name != family) continue;
    positive = any ? positive && form.positive : form.positive;
    counted = counted || form.counted;
    any = true;
  }
  if (counted) return {0, 1};
  return any && !positive ? MeasuredPair{-1e6, 1e6} : MeasuredPair{};
}

// Rows that let the study be read before there are data: the conditions are those of the tests.
Table stand_in_rows(const TomlReader& root, const Table& rows) {
  const TomlReader columns = root.required_table("data").required_table("columns");
  const bool formula = root.required_text("model") == "formula";
  if (root.has("failure_modes"))
    root.fail("failure_modes",
              "is not possible with `wearwell plan size`; plan with a study of one mode");
  refuse_mixtures(root, "wearwell plan size");
  std::vector<std::string> measured, random;
  if (formula) measured = root.required_table("likelihood").keys();
  if (const auto effects = root.table("random_effects")) random = effects->keys();
  if (!formula) measured = {"life", "depth", "volume", "dx", "dy"};
  Table table{rows.source, {}, std::max<std::size_t>(2, rows.rows)};
  for (const std::string& name : columns.keys()) {
    const DataRoles::Named named = prognosis::named_column(columns, name);
    if (name == "lower" || name == "upper" || name == "life_until" || name == "entry")
      throw InputError(
          fmt::format("plan size: [data.columns] has '{}'; tests with intervals or late entry "
                      "cannot be planned "
                      "before any test; leave it out",
                      name));
    const bool is_measured = contains(measured, name);
    const Column* given = is_measured ? nullptr : column_for(rows, named);
    if (!given) {
      // A column of words has no unit in the study.
      const bool label = contains(random, name) || (!is_measured && named.unit.empty());
      table.columns.push_back(stand_in(
          named, table.rows,
          is_measured ? std::optional(values_of_family(root, name)) : std::nullopt, label));
      continue;
    }
    Column column = *given;
    column.name = named.column;
    for (std::size_t i = rows.rows; i < table.rows; ++i)
      column.is_number ? column.numbers.push_back(column.numbers.back())
                       : column.text.push_back(column.text.back());
    table.columns.push_back(std::move(column));
  }
  return table;
}

// [predict] types names types of the data, which are not there before any test.
TextFile without_types(const TextFile& study) {
  TextFile rest = study;
  rest.text.clear();
  bool predict = false, inside = false;  // [predict], and a list of types over several lines
  for (std::size_t at = 0; at < study.text.size();) {
    const std::size_t end = std::min(study.text.find('\n', at), study.text.size() - 1) + 1;
    const std::string line = study.text.substr(at, end - at);
    at = end;
    const std::size_t first = std::min(line.find_first_not_of(" \t"), line.size() - 1);
    if (line[first] == '[' && !inside) predict = line.compare(first, 9, "[predict]") == 0;
    if (predict && !inside && line.compare(first, 5, "types") == 0 &&
        line.find_first_not_of(" \t", first + 5) == line.find('='))
      inside = true;
    if (!inside) {
      rest.text += line;
    } else {
      rest.text += "\n";  // messages name lines
      const bool list = line.find('[', first) < line.find('#');
      inside = (list || line[first] != 't') && line.find(']') == line.npos;
    }
  }
  return rest;
}

void refuse_improper(const PosteriorStudy& study) {
  std::vector<std::string> improper, defaults;
  for (const Parameter& each : study.parameters) {
    if (!each.prior.proper) improper.push_back(each.name);
    if (each.is_default) defaults.push_back(each.name);
  }
  if (!improper.empty())
    throw InputError(
        fmt::format("plan size: the prior of {} is improper, so no test can be simulated from it; "
                    "give a proper "
                    "one under [prior] that says what is known before the tests",
                    fmt::join(improper, ", ")));
  if (!defaults.empty())
    throw InputError(fmt::format(
        "plan size: the prior of {} is the model's default; give one under [prior] that says what "
        "is known before the tests",
        fmt::join(defaults, ", ")));
  if (study.parameters.size() > max_exact_dimension)
    throw InputError(fmt::format("plan size: {} parameters exceed the limit of quadrature ({})",
                                 study.parameters.size(), max_exact_dimension));
}

// Proportions as whole numbers, which candidates are read with.
Table with_whole_specimens(const Table& rows) {
  Table whole = rows;
  for (Column& each : whole.columns) {
    if (each.name != specimens_column || !each.is_number) continue;
    const bool fractions = std::any_of(each.numbers.begin(), each.numbers.end(),
                                       [](double x) { return x != std::floor(x); });
    if (!fractions) continue;
    for (double& x : each.numbers) x = std::isfinite(x) && x > 0 ? std::round(1000 * x) : x;
  }
  return whole;
}

}  // namespace

const PosteriorStudy& PlanningStudy::study() const {
  return require_posterior_study(*whole);
}

PlanningStudy planning_study(const Source& source, const ReadStudy& read, const Table& rows,
                             const std::string& measure) {
  PlanningStudy planning;
  const TomlReader root = TomlReader::parse(source.study);
  Source stand_in = source;
  if (root.required_text("model") == "sn") stand_in.study = without_types(source.study);
  stand_in.tables[as_read_name(root.required_table("data"))] = stand_in_rows(root, rows);
  planning.whole = read(stand_in);
  refuse_improper(planning.study());
  planning.tests = test_study(stand_in, read, measure);
  // No unit and no level is there before the first test.
  std::erase_if(planning.tests.conditions, [&](const ConditionColumn& each) {
    if (each.varies) planning.tests.new_units.push_back(each.heading);
    return each.varies;
  });
  planning.conditions = read_candidates(planning.tests, with_whole_specimens(rows), {});
  double sum = 0;
  for (const Candidate& each : planning.conditions.all) sum += each.specimens;
  for (const Candidate& each : planning.conditions.all)
    planning.shares.push_back(each.specimens / sum);
  return planning;
}

std::vector<std::size_t> allocation(std::span<const double> shares, std::size_t count) {
  std::vector<std::size_t> specimens;
  std::vector<double> placed(shares.size(), 0);
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t best = 0;
    double missing = -1;
    for (std::size_t k = 0; k < shares.size(); ++k) {
      const double lack = shares[k] * static_cast<double>(i + 1) - placed[k];
      if (lack > missing + 1e-12) missing = lack, best = k;
    }
    placed[best] += 1;
    specimens.push_back(best);
  }
  return specimens;
}

std::vector<SimulatedCampaign> simulated_campaigns(const PlanningStudy& planning,
                                                   std::span<const std::size_t> specimens,
                                                   std::size_t count, std::uint64_t seed) {
  const std::vector<Parameter>& parameters = planning.study().parameters;
  const auto n = static_cast<Eigen::Index>(count);
  Points truths(n, static_cast<Eigen::Index>(parameters.size()));
  std::vector<Rng> streams;
  for (Eigen::Index i = 0; i < n; ++i) {
    Rng rng(seed, static_cast<std::uint64_t>(i));
    for (std::size_t p = 0; p < parameters.size(); ++p)
      truths(i, static_cast<Eigen::Index>(p)) = quantile(parameters[p].prior, rng.uniform());
    streams.push_back(rng);
  }
  std::vector<PlannedTest> tests;
  for (const Candidate& each : planning.conditions.all) tests.push_back({each.row, each.stop});
  const std::vector<double> weights(count, 1 / static_cast<double>(count));
  const std::vector<Outcomes> possible =
      possible_outcomes(planning.tests, planning.conditions.conditions, tests, truths, weights);
  std::vector<SimulatedCampaign> campaigns(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    campaigns[i].truth.assign(truths.row(row).data(), truths.row(row).data() + truths.cols());
    for (const std::size_t k : specimens)
      campaigns[i].outcomes.push_back(
          possible[k].drawn(row, streams[i].uniform(), planning.tests.positive));
  }
  return campaigns;
}

Source with_tests(const PlanningStudy& planning, std::span<const std::size_t> specimens,
                  std::span<const TestOutcome> outcomes) {
  std::vector<std::size_t> rows;
  for (const std::size_t each : specimens) rows.push_back(planning.conditions.all[each].row);
  Source source = planning.tests.source;
  source.tables[planning.tests.key] = rows_with_outcomes(
      planning.tests, planning.conditions.conditions, rows, outcomes, "specimen");
  return source;
}

ExactPosterior tested_posterior(const PosteriorStudy& study, long max_evaluations) {
  const Posterior posterior(study.parameters, study.likelihood(study.data_rows));
  const PosteriorShape shape = posterior_shape(posterior);
  ExactSettings settings;
  settings.tolerance = 1e-3;
  settings.max_evaluations = max_evaluations;
  for (std::size_t k = 1; k < shape.maxima.found.size(); ++k)
    settings.maxima.push_back(shape.maxima.found[k].mode);
  return integrate(posterior, whitening_at(shape.mode), settings);
}

std::optional<GoalInterval> goal_interval(const ExactPosterior& exact, const Goal& goal,
                                          double level) {
  if (!exact.failure.empty()) return {};
  const QuantityDistribution distribution(exact.nodes, goal.value);
  const auto at = [&](double p) { return from_si(goal.unit, distribution.quantile(p)); };
  const GoalInterval interval{at((1 - level) / 2), at(0.5), at((1 + level) / 2)};
  if (!std::isfinite(interval.low) || !std::isfinite(interval.high)) return {};
  return interval;
}

std::optional<GoalInterval> goal_interval(const PlanningStudy& planning, const Goal& goal,
                                          std::span<const std::size_t> specimens,
                                          const SimulatedCampaign& campaign, std::size_t size,
                                          double level) {
  const auto read = planning.tests.read(
      with_tests(planning, specimens.first(size), std::span(campaign.outcomes).first(size)));
  return goal_interval(tested_posterior(require_posterior_study(*read)), goal, level);
}

}  // namespace wearwell::plan
