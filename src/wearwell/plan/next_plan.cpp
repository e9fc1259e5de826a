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
#include "wearwell/predict/thinned_posterior.h"
#include "wearwell/prognosis/new_data.h"
#include "wearwell/prognosis/reweighted.h"
#include "wearwell/study/inference_data.h"

namespace wearwell::plan {
namespace {

using Eigen::Index;

// Nodes of a slow likelihood (integrals within it) are fewer.
constexpr int nodes_of_slow = 150;

void check_question(const NextQuestion& question) {
  if (question.candidates.has_value() == !question.grid.empty())
    throw InputError("give either --candidates, a table, or --grid");
  if (question.goal.empty())
    throw InputError("--goal is missing: what are the tests to determine?");
  if (question.by != "variance" && question.by != "information")
    throw InputError(
        fmt::format("--by: '{}' must be variance or information", printable(question.by)));
  const auto positive = [](const char* option, const std::optional<double>& value) {
    if (value && !(*value > 0 && std::isfinite(*value)))
      throw InputError(fmt::format("{}: {:.6g} must be positive", option, *value));
  };
  positive("--specimen-cost", question.specimen_cost);
  positive("--use-cost", question.use_cost);
  positive("--value", question.value);
  positive("--budget", question.budget);
  const bool costs = !question.cost.empty() || question.specimen_cost || question.use_cost;
  if (!question.cost.empty() && (question.specimen_cost || question.use_cost))
    throw InputError("--cost names a column of costs; leave out --specimen-cost and --use-cost");
  if (!costs && (question.budget || question.value))
    throw InputError(fmt::format("{}: needs costs: --cost COLUMN, --specimen-cost or --use-cost",
                                 question.budget ? "--budget" : "--value"));
  if (!question.grid.empty() && !question.cost.empty())
    throw InputError("--cost: a grid has no column of costs; use --specimen-cost or --use-cost");
  if (question.batch < 1 || question.batch > 100)
    throw InputError(fmt::format("--batch: {} must be 1 to 100", question.batch));
  if (question.samples < 16 || question.samples > 100'000)
    throw InputError(fmt::format("--samples: {} must be 16 to 100000", question.samples));
  if (question.nodes < 50 || question.nodes > 20'000)
    throw InputError(fmt::format("--nodes: {} must be 50 to 20000", question.nodes));
}

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

std::optional<double> cost_of(const Candidate& candidate, const Gain& gain,
                              const NextQuestion& question) {
  if (candidate.cost) return candidate.cost;
  if (!question.specimen_cost && !question.use_cost) return {};
  return candidate.specimens *
         (question.specimen_cost.value_or(0) + question.use_cost.value_or(0) * gain.use);
}

double gain_by(const std::string& by, const NextPlan& plan, const Gain& gain) {
  if (by == "information") return gain.information;
  return 1 - std::sqrt(gain.variance) / plan.nodes.sd;
}

void judge(const NextQuestion& question, NextPlan& plan) {
  const double variance = plan.nodes.sd * plan.nodes.sd;
  tbb::parallel_for(std::size_t{0}, plan.judged.size(), [&](std::size_t i) {
    Judged& each = plan.judged[i];
    each.gain = each.candidate.specimens == 1
                    ? gain_of_one(plan.points, *each.outcomes)
                    : gain_of_batch(plan.points, {{each.outcomes}, {each.candidate.specimens}},
                                    {question.samples, question.seed});
    each.variance_share = each.gain.variance / variance;
    each.narrowing = 1 - std::sqrt(each.variance_share);
    each.narrowing_error =
        0.5 * each.gain.variance_error / variance / std::sqrt(each.variance_share) +
        each.outcomes->defect;
    each.cost = cost_of(each.candidate, each.gain, question);
    each.score = gain_by(question.by, plan, each.gain) / each.cost.value_or(1);
  });
  std::stable_sort(plan.judged.begin(), plan.judged.end(),
                   [](const Judged& a, const Judged& b) { return a.score > b.score; });
}

// Whether the best is worth doing.
void find_worth(const NextQuestion& question, NextPlan& plan) {
  constexpr double least = 1e-3;
  const auto best = std::max_element(
      plan.judged.begin(), plan.judged.end(), [](const Judged& a, const Judged& b) {
        return a.narrowing - 2 * a.narrowing_error < b.narrowing - 2 * b.narrowing_error;
      });
  if (question.by == "variance" && best->narrowing - 2 * best->narrowing_error < least) {
    plan.worth_it = false;
    plan.why_not =
        "No candidate narrows the interval of the goal by more than 0.1 % and twice its error.";
    return;
  }
  if (!question.value) return;
  double most = -infinity;
  const Judged* cheapest = nullptr;
  for (const Judged& each : plan.judged) {
    const double net = *question.value * 100 * each.narrowing - *each.cost;
    if (net > most) most = net, cheapest = &each;
  }
  if (most > 0) return;
  plan.worth_it = false;
  plan.why_not = fmt::format(
      "No candidate is worth its cost: the nearest, {}, narrows the interval by {:.3g} %, worth "
      "{:.4g}, and costs {:.4g}.",
      cheapest->candidate.name, 100 * cheapest->narrowing,
      100 * cheapest->narrowing * *question.value, *cheapest->cost);
}

// The smallest number of specimens of the best candidate whose expected width is small enough.
void find_further_tests(const NextQuestion& question, NextPlan& plan) {
  Target& target = *plan.target;
  const Judged& best = plan.judged.front();
  const double wanted = target.width / plan.now.width() * plan.nodes.sd;
  const auto width_after = [&](int n) {
    return std::sqrt(
        gain_of_batch(plan.points, {{best.outcomes}, {n}}, {question.samples, question.seed})
            .variance);
  };
  int below = 0, enough = 1;
  while (enough <= target.most && width_after(enough) > wanted) {
    below = enough;
    enough *= 2;
  }
  if (enough > target.most) return;
  while (enough - below > 1) {
    const int middle = (below + enough) / 2;
    (width_after(middle) > wanted ? below : enough) = middle;
  }
  target.tests = enough;
}

void add_checks(NextPlan& plan) {
  constexpr double fewest = 20;
  std::size_t few = 0, outside = 0, coarse = 0;
  for (const Judged& each : plan.judged) {
    few += each.gain.effective < fewest;
    outside += !each.candidate.outside.empty();
    coarse += each.outcomes->defect > 1e-3;
  }
  const std::size_t all = plan.judged.size();
  if (few > 0)
    plan.checks.push_back(
        {"resolution", Verdict::warn,
         fmt::format("after {} of {} candidates fewer than {:.0f} nodes carry the posterior", few,
                     all, fewest),
         "Their gains are rough; use more nodes: --nodes 5000."});
  if (coarse > 0)
    plan.checks.push_back(
        {"outcomes", Verdict::warn,
         fmt::format("the integration over outcomes has an error above 0.1 % for {} of {} "
                     "candidates",
                     coarse, all),
         "The error is part of the stated one."});
  if (outside > 0)
    plan.checks.push_back(
        {"extrapolation", Verdict::warn,
         fmt::format("{} of {} candidates lie outside the tested range", outside, all),
         "What they would show, and so their gain, rests on the model. They are marked."});
  if (!plan.trusted)
    plan.checks.push_back({"study", Verdict::fail, "the fit itself is not trusted",
                           "Look at its checks first: wearwell report."});
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
  plan.currency = candidates.currency;
  plan.notes.insert(plan.notes.end(), candidates.notes.begin(), candidates.notes.end());
  if (question.use_cost && !study.is_life)
    throw InputError("--use-cost: the tests of this study are not lives, and take no known time");
  if (study.is_life) plan.use_unit = study.measured_unit.text;

  const int most = study.own->is_slow() ? std::min(question.nodes, nodes_of_slow) : question.nodes;
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
  judge(question, plan);
  add_checks(plan);
  find_worth(question, plan);
  const Judged& best = plan.judged.front();
  plan.typical =
      typical_posterior(plan.points, {{best.outcomes}, {best.candidate.specimens}},
                        {question.samples, question.seed}, std::sqrt(best.gain.variance));
  if (question.batch > 1 || question.budget) plan.batch = choose_batch(plan, question);
  if (plan.target) {
    plan.target->reached = plan.now.width() <= plan.target->width;
    if (!plan.target->reached) find_further_tests(question, plan);
  }
  return answer_of(plan, question);
}

}  // namespace wearwell::plan
