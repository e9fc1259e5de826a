#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/math/constants.h"
#include "wearwell/plan/next_plan.h"

namespace wearwell::plan {
namespace {

std::optional<double> cost_of(const Candidate& candidate, const Gain& gain,
                              const NextQuestion& question) {
  if (candidate.cost) return candidate.cost;
  if (!question.specimen_cost && !question.use_cost) return {};
  return candidate.specimens *
         (question.specimen_cost.value_or(0) + question.use_cost.value_or(0) * gain.use);
}

double gain_by(const std::string& by, const NextPlan& plan, const Gain& gain) {
  if (by == "information") return gain.information;
  if (by == "loss") return plan.loss->share(gain.saved);
  return 1 - std::sqrt(gain.variance) / plan.nodes.sd;
}

// Whether what a test saves in the whole use of the fleet is worth its cost.
void find_worth_of_saving(NextPlan& plan) {
  const DecisionLoss& loss = *plan.loss;
  const Judged* best = nullptr;
  double most = -infinity;
  constexpr double least = 1e-6;  // of the present cost
  bool any = false;
  for (const Judged& each : plan.judged) {
    any = any || each.gain.saved - 2 * each.gain.saved_error > least * loss.now;
    const double net = loss.saved(each.gain.saved) - each.cost.value_or(0);
    if (net > most) most = net, best = &each;
  }
  if (!any) {
    plan.worth_it = false;
    plan.why_not = "No candidate is expected to change the age of replacement.";
  } else if (loss.fleet_use > 0 && best->cost && !(most > 0)) {
    plan.worth_it = false;
    plan.why_not = fmt::format(
        "No candidate is worth its cost: the nearest, {}, is expected to save {:.4g} and costs "
        "{:.4g}.",
        best->candidate.name, loss.saved(best->gain.saved), *best->cost);
  }
}

// Whether the best is worth doing.
void find_worth(const NextQuestion& question, NextPlan& plan) {
  if (plan.loss) return find_worth_of_saving(plan);
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
void find_further_tests(NextPlan& plan) {
  Target& target = *plan.target;
  const double wanted = target.width / plan.now.width() * plan.nodes.sd;
  const auto width_after = [&](int n) {
    const Tested tests[] = {{0, n}};
    return std::sqrt(plan.gain_together(plan, tests).variance);
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
    coarse += each.outcomes && each.outcomes->defect > 1e-3;
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

}  // namespace

void check_question(const NextQuestion& question) {
  if (question.candidates.has_value() == !question.grid.empty())
    throw InputError("give either --candidates, a table, or --grid");
  if (question.goal.empty())
    throw InputError("--goal is missing: what are the tests to determine?");
  if (question.by != "variance" && question.by != "information" && question.by != "loss")
    throw InputError(
        fmt::format("--by: '{}' must be variance, information or loss", printable(question.by)));
  if (question.by != "loss")
    for (const auto& [option, text] : {std::pair{"--failure-cost", &question.failure_cost},
                                       {"--replacement-cost", &question.replacement_cost},
                                       {"--fleet-use", &question.fleet_use}})
      if (!text->empty()) throw InputError(fmt::format("{}: belongs to --by loss", option));
  if (question.by == "loss" && question.value)
    throw InputError("--value: is of narrowing; --by loss compares costs, by --fleet-use");
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

void rank_candidates(const NextQuestion& question, NextPlan& plan) {
  const double variance = plan.nodes.sd * plan.nodes.sd;
  for (Judged& each : plan.judged) {
    each.variance_share = each.gain.variance / variance;
    each.narrowing = 1 - std::sqrt(each.variance_share);
    each.narrowing_error =
        0.5 * each.gain.variance_error / variance / std::sqrt(each.variance_share) +
        (each.outcomes ? each.outcomes->defect : 0);
    each.cost = cost_of(each.candidate, each.gain, question);
    each.score = gain_by(question.by, plan, each.gain) / each.cost.value_or(1);
  }
  std::stable_sort(plan.judged.begin(), plan.judged.end(),
                   [](const Judged& a, const Judged& b) { return a.score > b.score; });
}

Answer answer_of_ranked(NextPlan plan, const NextQuestion& question) {
  add_checks(plan);
  find_worth(question, plan);
  if (question.batch > 1 || question.budget) plan.batch = choose_batch(plan, question);
  if (plan.target) {
    plan.target->reached = plan.now.width() <= plan.target->width;
    if (!plan.target->reached) find_further_tests(plan);
  }
  return answer_of(plan, question);
}

}  // namespace wearwell::plan
