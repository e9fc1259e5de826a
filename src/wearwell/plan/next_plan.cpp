#include "wearwell/plan/next_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/math/constants.h"
#include "wearwell/plan/goal_target.h"
#include "wearwell/plan/row_densities.h"
#include "wearwell/predict/thinned_posterior.h"
#include "wearwell/prognosis/new_data.h"
#include "wearwell/prognosis/reweighted.h"
#include "wearwell/study/inference_data.h"

namespace wearwell::plan {
namespace {

using Eigen::Index;

// Nodes are fewer where each takes long: integrals within the likelihood, or over new levels.
constexpr int nodes_of_slow = 150;

// The posterior after the tests that were done since the fit.
void take_tests(const std::vector<Table>& tests, const std::string& result, const ReadStudy& read,
                prognosis::CarriedState& state, NextPlan& plan) {
  if (tests.empty()) return;
  prognosis::JoinedData joined =
      prognosis::joined_data(state.source, tests, prognosis::Repeated::another);
  const auto before = read(state.source), after = read(joined.source);
  const auto posterior_of = [](const Study& study) {
    const PosteriorStudy& own = require_posterior_study(study);
    return Posterior(own.parameters, own.likelihood(own.data_rows));
  };
  const prognosis::Reweighted moved =
      prognosis::reweighted(state.posterior, posterior_of(*before), posterior_of(*after));
  if (!prognosis::resolves(moved))
    throw InputError(fmt::format(
        "--tests: these tests move the posterior of {} so far that its nodes no longer resolve it "
        "(effective number {:.0f}); fit them first: wearwell update {} TESTS -o NEW",
        result, moved.effective, result));
  plan.tests_done = joined.counted;
  plan.kept = moved.kept;
  plan.notes.insert(plan.notes.end(), joined.notes.begin(), joined.notes.end());
  state.posterior = moved.draws;
  state.source = std::move(joined.source);
}

// Nodes of the posterior in ascending order of the goal.
struct Nodes {
  Points values;
  std::vector<double> weights;
};

Nodes in_order_of_goal(const ThinnedPosterior& few, const GoalValues& goal, NextPlan& plan) {
  std::vector<std::size_t> order(few.weights.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return goal.value[a] < goal.value[b]; });
  Nodes nodes{Points(few.values.rows(), few.values.cols()), {}};
  for (std::size_t i = 0; i < order.size(); ++i) {
    nodes.values.row(static_cast<Index>(i)) = few.values.row(static_cast<Index>(order[i]));
    nodes.weights.push_back(few.weights[order[i]]);
    plan.points.goal.push_back(goal.value[order[i]]);
  }
  plan.points.weight = nodes.weights;
  return nodes;
}

// As the study reports it, over its whole posterior.
void find_present(const WeightedDraws& posterior, NextPlan& plan) {
  plan.nodes = plan.now = goal_spread(plan.points.goal, plan.points.weight);
  if (!plan.goal.reported) return;
  const auto quantiles = plan.goal.reported(posterior);
  if (!quantiles) return;
  std::vector<double> at;
  for (const double si : *quantiles) {
    const double value = from_si(plan.goal.unit, si);
    at.push_back(plan.logarithmic ? std::log(value) : value);
    if (!std::isfinite(at.back())) return;
  }
  plan.now.low = at[0], plan.now.median = at[1], plan.now.high = at[2];
  constexpr double most = 0.05;
  const double off = std::abs(plan.nodes.width() / plan.now.width() - 1);
  if (off > most)
    plan.checks.push_back(
        {"nodes", Verdict::warn,
         fmt::format("the {} nodes of the plan give the goal an interval that is {:.1f} % {} than "
                     "that of the whole posterior",
                     plan.points.goal.size(), 100 * off,
                     plan.nodes.width() > plan.now.width() ? "wider" : "narrower"),
         "Relative gains change less; for more digits use --nodes 3000."});
}

// Candidates with the same conditions and stop share the outcomes of one specimen.
std::vector<std::size_t> different_tests(const std::vector<Candidate>& all,
                                         std::vector<PlannedTest>& tests) {
  std::map<std::pair<std::size_t, double>, std::size_t> known;
  std::vector<std::size_t> test_of;
  for (const Candidate& each : all) {
    const auto [at, fresh] =
        known.emplace(std::pair{each.row, each.stop.value_or(-1)}, tests.size());
    if (fresh) tests.push_back({each.row, each.stop});
    test_of.push_back(at->second);
  }
  return test_of;
}

Gain gain_of_tests(const NextPlan& plan, std::span<const Tested> tests,
                   const NestedSettings& settings) {
  Batch batch;
  for (const Tested& each : tests) {
    batch.outcomes.push_back(plan.judged[each.candidate].outcomes);
    batch.specimens.push_back(each.specimens);
  }
  return gain_of_batch(plan.points, batch, settings);
}

void find_gains(const NextQuestion& question, NextPlan& plan) {
  const NestedSettings settings{question.samples, question.seed};
  plan.gain_together = [settings](const NextPlan& of, std::span<const Tested> tests) {
    return gain_of_tests(of, tests, settings);
  };
  tbb::parallel_for(std::size_t{0}, plan.judged.size(), [&](std::size_t i) {
    Judged& each = plan.judged[i];
    const Tested test[] = {{i, each.candidate.specimens}};
    each.gain = each.candidate.specimens == 1 ? gain_of_one(plan.points, *each.outcomes)
                                              : gain_of_tests(plan, test, settings);
  });
}

void find_loss(const NextQuestion& question, const Points& nodes, NextPlan& plan) {
  plan.loss = decision_loss(question, plan.goal, nodes, plan.points);
  if (!plan.currency.empty() && !plan.loss->currency.empty() &&
      plan.currency != plan.loss->currency)
    throw InputError(
        fmt::format("--failure-cost is in {}, and the costs of candidates in {}; give "
                    "both in one currency",
                    printable(plan.loss->currency), printable(plan.currency)));
  if (plan.currency.empty()) plan.currency = plan.loss->currency;
}

Candidates candidates_of(const NextQuestion& question, const TestStudy& study) {
  const std::vector<int> specimens =
      question.specimens.empty() ? std::vector<int>{1} : specimen_counts(question.specimens);
  const std::optional<std::string> cost =
      question.cost.empty() ? std::nullopt : std::optional(question.cost);
  return read_candidates(study,
                         question.candidates ? *question.candidates : grid_table(question.grid),
                         cost, specimens);
}

// Readings of one unit are dependent, so that what several add is not that of one by one.
void refuse_together(const NextQuestion& question, const TestStudy& study,
                     const Candidates& candidates) {
  const bool together = question.batch > 1 || question.budget || !question.until.empty();
  if (!together) return;
  for (const Candidate& each : candidates.all)
    if (!each.unit.empty())
      throw InputError(fmt::format(
          "{}: {} '{}' is in the data of the study, and its readings depend on each other; leave "
          "out {}, or leave the cell empty for a new {}",
          row_of(candidates.conditions, each.row), study.factor_noun, printable(each.unit),
          question.batch > 1 ? "--batch"
          : question.budget  ? "--budget"
                             : "--until",
          study.factor_noun));
}

// Whether a name speaks of this unit: "B10 of machine 3".
bool is_of(const std::string& name, const std::string& unit) {
  for (std::size_t at = name.find(unit); at != name.npos; at = name.find(unit, at + 1)) {
    const std::size_t end = at + unit.size();
    if (end == name.size() || name[end] == ' ' || name[end] == ',') return true;
  }
  return false;
}

// A goal is a number at each node. That of a unit changes at each node with a reading of the unit.
void refuse_goal_of_unit(const Goal& goal, const TestStudy& study, const Candidates& candidates) {
  for (const Candidate& each : candidates.all) {
    const std::string unit = fmt::format("{} {}", study.roles.noun, each.unit);
    if (each.unit.empty() || !is_of(goal.name, unit)) continue;
    throw InputError(fmt::format(
        "{}: a reading of {} changes what is known of its own life beyond the population; choose a "
        "goal of the population (B10 of a new {}), or see wearwell decide --inspect-after",
        row_of(candidates.conditions, each.row), printable(unit), study.roles.noun));
  }
}

NextPlan plan_of(prognosis::CarriedState state, const std::string& result, const ReadStudy& read,
                 const NextQuestion& question) {
  check_question(question);
  NextPlan plan;
  plan.trusted = state.trusted;
  take_tests(question.tests, result, read, state, plan);
  const auto whole = read(state.source);
  const PosteriorStudy& own = require_posterior_study(*whole);
  std::vector<std::string> names;
  for (const Parameter& each : own.parameters) names.push_back(each.name);
  prognosis::require_parameters(state, names);
  plan.title = own.title;
  plan.goal = goal_of(own, question.goal);
  const TestStudy study = test_study(state.source, read, question.measure);
  Candidates candidates = candidates_of(question, study);
  refuse_together(question, study, candidates);
  refuse_goal_of_unit(plan.goal, study, candidates);
  plan.currency = candidates.currency;
  plan.notes.insert(plan.notes.end(), candidates.notes.begin(), candidates.notes.end());
  if (question.use_cost && !study.is_life)
    throw InputError("--use-cost: the tests of this study are not lives, and take no known time");
  if (study.is_life) plan.use_unit = study.measured_unit.text;

  if (has_new_levels(study, candidates.conditions))
    plan.notes.push_back(
        "effects of levels that the table does not name are integrated over: each test is at a "
        "level of its own");
  const int most = study.own->is_slow() || has_new_levels(study, candidates.conditions)
                       ? std::min(question.nodes, nodes_of_slow)
                       : question.nodes;
  const ThinnedPosterior few(state.posterior, static_cast<std::size_t>(most));
  const GoalValues goal = goal_values(plan.goal, few.values, few.weights);
  plan.logarithmic = goal.logarithmic;
  if (!question.until.empty())
    plan.target =
        Target{question.until, target_width(question.until, plan.goal.unit, plan.logarithmic)};
  const Nodes nodes = in_order_of_goal(few, goal, plan);
  find_present(state.posterior, plan);
  if (!(plan.nodes.sd > 0))
    throw InputError(fmt::format("--goal: {} is known already: it is the same under all parameters",
                                 plan.goal.name));
  if (question.by == "loss") find_loss(question, nodes.values, plan);
  std::vector<PlannedTest> tests;
  const std::vector<std::size_t> test_of = different_tests(candidates.all, tests);
  plan.outcomes =
      possible_outcomes(study, candidates.conditions, tests, nodes.values, nodes.weights);
  for (std::size_t i = 0; i < candidates.all.size(); ++i) {
    Judged each;
    each.candidate = candidates.all[i];
    each.outcomes = &plan.outcomes[test_of[i]];
    plan.judged.push_back(std::move(each));
  }
  plan.conditions = study.conditions;
  plan.condition_values = std::move(candidates.conditions);
  return plan;
}

}  // namespace

double NextPlan::in_unit(double goal_value) const {
  return logarithmic ? std::exp(goal_value) : goal_value;
}

Answer next_test(prognosis::CarriedState state, const std::string& result, const ReadStudy& read,
                 const NextQuestion& question) {
  NextPlan plan = plan_of(std::move(state), result, read, question);
  find_gains(question, plan);
  rank_candidates(question, plan);
  const Judged& best = plan.judged.front();
  plan.typical =
      typical_posterior(plan.points, {{best.outcomes}, {best.candidate.specimens}},
                        {question.samples, question.seed}, std::sqrt(best.gain.variance));
  return answer_of_ranked(std::move(plan), question);
}

}  // namespace wearwell::plan
