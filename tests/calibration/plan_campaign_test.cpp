// Campaigns of fatigue tests whose next test is each time the best candidate of `plan next`, beside
// campaigns with the same tests at equally spaced stresses in turn: how wide the interval of B10 is
// after so many tests, and how many tests planning saves at equal width. Truths are drawn from the
// priors of examples/spring/sensible.toml. Prints the table of docs/explanation/validation.md.
// WEARWELL_REPLICATIONS says how many campaigns.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <mutex>
#include <numeric>
#include <sstream>

#include "calibration/shares.h"
#include "plan/grid_posterior.h"
#include "wearwell/base/rng.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/models/fatigue/sn_law.h"
#include "wearwell/plan/planning_study.h"

namespace wearwell::plan {
namespace {

constexpr std::uint64_t seed = 20261126;
constexpr std::array<double, 6> alternating = {220, 240, 260, 280, 300, 320};  // MPa
constexpr double mean_stress = 1000;                                           // MPa
constexpr double stop = 1e7, unit = 1e5;                                       // cycles
// Equal spacing: each six tests have all levels, and the first four the whole range.
constexpr std::array<std::size_t, alternating.size()> in_turn = {5, 0, 3, 1, 4, 2};
constexpr std::size_t first = 4, most_planned = 16, most_spaced = 24;
constexpr double level = 0.9;
// Most posteriors take about 10,000; one with little scatter about the line takes more.
constexpr long most_evaluations = 4'000'000;
constexpr const char* goal_text = "B10 at softer spring";

Table tests_of_grid() {
  return table_of(
      "levels", {numbers_column("alternating_stress_MPa", {alternating.begin(), alternating.end()}),
                 numbers_column("mean_stress_MPa", std::vector<double>(6, mean_stress)),
                 numbers_column("stop [cycles]", std::vector<double>(6, stop))});
}

// Without the types, whose lives can only be asked for once they are tested.
Source spring_study() {
  std::ifstream file(PROJECT_SOURCE_DIR "/examples/spring/sensible.toml");
  Source source{TextFile{"sensible.toml", ""}};
  for (std::string line; std::getline(file, line);)
    if (!line.starts_with("types ")) source.study.text += line + "\n";
  return source;
}

// The k-th specimen of a level has the same life in all campaigns of a truth.
struct Specimens {
  std::vector<double> truth;
  std::array<std::vector<TestOutcome>, alternating.size()> of_level;
};

// Drawn until three of the first tests fail: who sees only run-outs begins again at higher stress.
// What is selected by is data of both campaigns, so the posterior is that without selection.
Specimens specimens_of(const std::vector<Parameter>& parameters, int index) {
  constexpr int fewest_failures = 3;
  Rng rng(seed, static_cast<std::uint64_t>(index));
  const fatigue::SnLaw law;  // Basquin, Goodman, log10-normal
  while (true) {
    Specimens specimens;
    for (const Parameter& each : parameters)
      specimens.truth.push_back(quantile(each.prior, rng.uniform()));
    const double* const x = specimens.truth.data();
    for (std::size_t k = 0; k < most_spaced; ++k) {
      for (std::size_t l = 0; l < alternating.size(); ++l) {
        const fatigue::Stress stress{alternating[l] * 1e6, mean_stress * 1e6};
        const double log10_life =
            law.log10_life(x, law.log10_reversed(x, stress)) + x[law.sigma_index()] * rng.normal();
        const bool runout = log10_life > std::log10(stop);
        specimens.of_level[l].push_back(
            {(runout ? stop : std::pow(10, log10_life)) / unit, runout});
      }
    }
    int failures = 0;
    for (std::size_t i = 0; i < first; ++i)
      failures += !specimens.of_level[in_turn[i]].front().runout;
    if (failures >= fewest_failures) return specimens;
  }
}

// Numbers of tests after which the intervals of a campaign are computed.
constexpr std::size_t every = 2;
bool counts(std::size_t tests) {
  return (tests - first) % every == 0;
}

struct Campaign {
  std::vector<GoalInterval> intervals;  // after `first`, `first` + `every`, ... tests
  std::vector<std::size_t> levels;      // of its tests
  std::vector<TestOutcome> outcomes;
  std::string failure;  // of the quadrature; then without the rest of its intervals

  void test(std::size_t l, const Specimens& specimens) {
    const auto used = static_cast<std::size_t>(std::count(levels.begin(), levels.end(), l));
    levels.push_back(l);
    outcomes.push_back(specimens.of_level[l].at(used));
  }
  const GoalInterval& after(std::size_t tests) const {
    return intervals.at((tests - first) / every);
  }
};

// The best candidate of `plan next` for the posterior after these tests.
std::size_t best_next(Source tests, const ExactPosterior& posterior) {
  tests.study = spring_study().study;  // with [predict], which tests are read without
  NextQuestion question;
  question.goal = goal_text;
  question.candidates = tests_of_grid();
  question.nodes = 300;
  question.samples = 16;  // of the typical posterior, which is not used here
  const Answer answer =
      next_test(state_of(tests, posterior.nodes), "campaign", reading(), question);
  return answer.json["candidates"][0]["row"].get<std::size_t>() - 1;
}

Campaign campaign_of(const PlanningStudy& planning, const Goal& goal, const Specimens& specimens,
                     bool planned) {
  Campaign campaign;
  const std::size_t most = planned ? most_planned : most_spaced;
  std::size_t next = in_turn[0];
  while (campaign.levels.size() < most) {
    campaign.test(next, specimens);
    const std::size_t n = campaign.levels.size();
    next = in_turn[n % in_turn.size()];
    if (n < first || (!planned && !counts(n))) continue;
    const Source tests = with_tests(planning, campaign.levels, campaign.outcomes);
    const auto read = planning.tests.read(tests);
    const ExactPosterior posterior =
        tested_posterior(require_posterior_study(*read), most_evaluations);
    if (!posterior.failure.empty()) {
      campaign.failure = fmt::format("after {} tests: {}", n, posterior.failure);
      return campaign;
    }
    if (counts(n)) {
      const auto interval = goal_interval(posterior, goal, level);
      if (!interval) return campaign;
      campaign.intervals.push_back(*interval);
    }
    if (planned && n < most) next = best_next(tests, posterior);
  }
  return campaign;
}

struct Pair {
  Campaign planned, spaced;
  double truth = 0;  // B10, unit of the goal

  bool resolved() const {
    return planned.intervals.size() == (most_planned - first) / every + 1 &&
           spaced.intervals.size() == (most_spaced - first) / every + 1;
  }
};

// ln of the width of ln B10 after n tests.
double log_width(const GoalInterval& interval) {
  return std::log(std::log(interval.high / interval.low));
}
double planned_at(const Pair& pair, std::size_t n) {
  return log_width(pair.planned.after(n));
}
double spaced_at(const Pair& pair, std::size_t n) {
  return log_width(pair.spaced.after(n));
}

// A line for each campaign, so that a run that is stopped has shown what it found.
void print(int index, const Pair& pair) {
  std::string line = fmt::format("campaign {}; levels", index);
  for (const std::size_t l : pair.planned.levels) line += fmt::format(" {}", alternating[l]);
  line += fmt::format("; ln B10 {:.4f}", std::log(pair.truth));
  for (const Campaign* each : {&pair.planned, &pair.spaced}) {
    const auto runouts = std::count_if(each->outcomes.begin(), each->outcomes.end(),
                                       [](const TestOutcome& outcome) { return outcome.runout; });
    line +=
        fmt::format("; {}: run-outs {};", each == &pair.planned ? "planned" : "in turn", runouts);
    for (const GoalInterval& of : each->intervals)
      line += fmt::format(" {:.4f} {:.4f}", std::log(of.low), std::log(of.high));
    line += each->failure.empty() ? "" : "; " + each->failure;
  }
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

std::vector<Pair> simulate(int count) {
  const PlanningStudy planning = planning_study(spring_study(), reading(), tests_of_grid(), "");
  const Goal goal = goal_of(planning.study(), goal_text);
  std::vector<Pair> pairs(static_cast<std::size_t>(count));
  std::mutex printing;
  const auto run = [&](int i) {
    const Specimens specimens = specimens_of(planning.study().parameters, i);
    Pair& pair = pairs[static_cast<std::size_t>(i)];
    pair.truth = from_si(goal.unit, goal.value(specimens.truth.data()));
    pair.planned = campaign_of(planning, goal, specimens, true);
    pair.spaced = campaign_of(planning, goal, specimens, false);
    const std::lock_guard lock(printing);
    print(i, pair);
  };
  // In blocks: a run that is stopped has the first campaigns.
  constexpr int block = 10;
  for (int begin = 0; begin < count; begin += block)
    tbb::parallel_for(begin, std::min(begin + block, count),
                      [&](int i) { tbb::this_task_arena::isolate([&] { run(i); }); });
  return pairs;
}

struct Mean {
  double value = 0, error = 0;
};

template <class Of>
Mean mean(const std::vector<Pair>& pairs, const Of& of) {
  double sum = 0, squares = 0;
  for (const Pair& each : pairs) sum += of(each), squares += of(each) * of(each);
  const auto n = static_cast<double>(pairs.size());
  return {sum / n, std::sqrt(std::max(0.0, squares / n - sum / n * sum / n) / (n - 1))};
}

// How many tests equal spacing needs, on average over these campaigns, for the width after n planned
// ones, less n: linear in ln n between the numbers tried, and beyond them.
double saved(const std::vector<Pair>& pairs, std::span<const std::size_t> chosen, std::size_t n) {
  const auto sum = [&](const auto& of, std::size_t at) {
    double all = 0;
    for (const std::size_t i : chosen) all += of(pairs[i], at);
    return all;
  };
  const double wanted = sum(planned_at, n);
  std::size_t upper = first + every;
  while (upper < most_spaced && sum(spaced_at, upper) > wanted) upper += every;
  // Beyond: along a chord over which the noise of single steps averages.
  constexpr std::size_t chord = 8;
  const bool beyond = upper == most_spaced && sum(spaced_at, upper) > wanted;
  const std::size_t lower = upper - (beyond ? chord : every);
  const double a = sum(spaced_at, lower), b = sum(spaced_at, upper);
  const double ln_lower = std::log(static_cast<double>(lower));
  const double ln_upper = std::log(static_cast<double>(upper));
  return std::exp(ln_lower + (wanted - a) / (b - a) * (ln_upper - ln_lower)) -
         static_cast<double>(n);
}

// With its standard error by bootstrap over campaigns.
Mean tests_saved(const std::vector<Pair>& pairs, std::size_t n) {
  std::vector<std::size_t> chosen(pairs.size());
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  const double estimate = saved(pairs, chosen, n);
  constexpr int resamples = 1000;
  double sum = 0, squares = 0;
  for (int r = 0; r < resamples; ++r) {
    Rng rng(seed + 1, static_cast<std::uint64_t>(r));
    for (std::size_t& each : chosen)
      each = static_cast<std::size_t>(rng.uniform() * static_cast<double>(pairs.size()));
    const double value = saved(pairs, chosen, n);
    sum += value, squares += value * value;
  }
  const double center = sum / resamples;
  return {estimate, std::sqrt(std::max(0.0, squares / resamples - center * center))};
}

int misses(const std::vector<Pair>& pairs, const Campaign Pair::*arm, std::size_t n) {
  return static_cast<int>(std::count_if(pairs.begin(), pairs.end(), [&](const Pair& each) {
    const GoalInterval& interval = (each.*arm).after(n);
    return each.truth < interval.low || each.truth > interval.high;
  }));
}

void print_table(const std::vector<Pair>& pairs) {
  fmt::print("tests, factor planned, factor in turn, ratio of ln factor, its standard error\n");
  for (std::size_t n = first; n <= most_spaced; n += every) {
    const Mean in_turn_of = mean(pairs, [&](const Pair& each) { return spaced_at(each, n); });
    if (n > most_planned) {
      fmt::print("{} | | {:.3f}\n", n, std::exp(std::exp(in_turn_of.value)));
      continue;
    }
    const Mean planned_of = mean(pairs, [&](const Pair& each) { return planned_at(each, n); });
    const Mean ratio =
        mean(pairs, [&](const Pair& each) { return planned_at(each, n) - spaced_at(each, n); });
    fmt::print(
        "{} | {:.3f} (ln {:.3f} +- {:.1f} %) | {:.3f} (ln {:.3f} +- {:.1f} %) | {:.3f} +- {:.3f}\n",
        n, std::exp(std::exp(planned_of.value)), std::exp(planned_of.value), 100 * planned_of.error,
        std::exp(std::exp(in_turn_of.value)), std::exp(in_turn_of.value), 100 * in_turn_of.error,
        std::exp(ratio.value), std::exp(ratio.value) * ratio.error);
  }
}

TEST(PlanCampaign, PlannedOneByOneBesideEqualSpacing) {
  std::vector<Pair> pairs = simulate(replications(20));
  const auto all = pairs.size();
  std::erase_if(pairs, [](const Pair& each) { return !each.resolved(); });
  fmt::print("{} campaigns, {} of them not resolved by quadrature\n", all, all - pairs.size());
  ASSERT_GE(pairs.size(), all * 9 / 10);
  print_table(pairs);
  const auto count = static_cast<int>(pairs.size());
  constexpr double sure = 3;  // standard errors
  for (const std::size_t n : {std::size_t{8}, std::size_t{12}, most_planned}) {
    // After the last ones equal spacing may need more tests than were simulated.
    if (n < most_planned) {
      const Mean of = tests_saved(pairs, n);
      fmt::print("{} planned tests save {:.1f} +- {:.1f}\n", n, of.value, of.error);
    }
    const Mean ratio =
        mean(pairs, [&](const Pair& each) { return planned_at(each, n) - spaced_at(each, n); });
    EXPECT_LT(ratio.value, sure * ratio.error) << n << " tests";
    // Truths are drawn from the priors, so the intervals contain 90 % of them; that tests are
    // chosen by earlier results does not matter.
    const int by_plan = misses(pairs, &Pair::planned, n), by_turn = misses(pairs, &Pair::spaced, n);
    fmt::print("{} tests: the interval misses the true B10 {} times planned, {} times in turn\n", n,
               by_plan, by_turn);
    expect_share(by_plan, count, 1 - level, "planned");
    expect_share(by_turn, count, 1 - level, "in turn");
  }
}

}  // namespace
}  // namespace wearwell::plan
