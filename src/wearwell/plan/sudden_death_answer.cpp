#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/printable.h"
#include "wearwell/plan/demonstration_result.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/plot.h"
#include "wearwell/present/text_table.h"

namespace wearwell::plan {
namespace {

using Json = nlohmann::ordered_json;
namespace colour = plot::colour;

struct SuddenDeath {
  const DemonstrationGoal& goal;
  std::vector<SuddenDeathTest> tests;  ///< one, or one for each of some sizes
  double shape() const { return goal.spread->at(0); }
  double passing(const LifePoint& truth) const {
    return pass_probability(tests.front(), shape(), truth.failing, truth.life / goal.goal.life);
  }
};

SuddenDeath sudden_death_of(const DemonstrationGoal& goal) {
  SuddenDeath result{goal, {}};
  const std::size_t groups = *goal.groups;
  std::vector<std::size_t> sizes = {1, 2, 3, 4, 5, 6, 8, 10, 15, 20};
  if (goal.specimens) sizes = {*goal.specimens / groups};
  for (const std::size_t size : sizes)
    result.tests.push_back(
        sudden_death_test(groups, size, result.shape(), goal.goal.failing, goal.confidence));
  return result;
}

present::Table sizes_table(const SuddenDeath& result) {
  const DemonstrationGoal& goal = result.goal;
  const std::string unit = goal.goal.unit.text, name = b_life_name(goal.goal.failing);
  present::Table table{
      "groups",
      fmt::format("{} groups by their size", *goal.groups),
      {{"group size", "1", present::given},
       {"specimens", "1", present::given},
       {"earliest pass", unit, present::life()},
       {fmt::format("median first failure, {} at the goal", name), unit, present::life()},
       {"which is the B-life", "%", present::digits(4)}}};
  for (const SuddenDeathTest& test : result.tests)
    table.rows.push_back(
        {present::count(test.size), present::count(test.size * test.groups),
         goal.shown(test.earliest),
         goal.shown(median_first_failure(test.size, result.shape(), goal.goal.failing, 1)),
         100 * test.first_failure_share});
  return table;
}

present::Table sudden_death_passes(const SuddenDeath& result) {
  present::Table table{"probability-to-pass",
                       "Probability to pass, if in truth",
                       {{"true life"}, {"passes", "%", present::digits(3)}}};
  for (const LifePoint& truth : true_lives(result.goal))
    table.rows.push_back({truth.text, 100 * result.passing(truth)});
  return table;
}

html::Figure sudden_death_characteristic(const SuddenDeath& result) {
  const DemonstrationGoal& goal = result.goal;
  std::vector<double> x, y;
  double reach = 3;
  for (const LifePoint& truth : goal.truth)
    reach = std::max(reach, 1.2 * truth.life / goal.goal.life);
  for (int i = 0; i <= 120; ++i) {
    const double life = 0.5 * std::pow(reach / 0.5, i / 120.0);
    x.push_back(goal.shown(life));
    y.push_back(100 *
                pass_probability(result.tests.front(), result.shape(), goal.goal.failing, life));
  }
  return {"characteristic", "Operating characteristic",
          "Probability to pass by what is true; it does not depend on the size of the groups.",
          plot::plot("Probability to pass against the true life",
                     {fmt::format("True {} [{}]", b_life_name(goal.goal.failing),
                                  html::unit(goal.goal.unit.text)),
                      true, x.front(), x.back()},
                     {"Probability to pass [%]", false, 0.0, 100.0},
                     {plot::line({{"x", x}, {"y", y}}, {colour::posterior}),
                      plot::vertical_line(goal.shown(1), {colour::limit, "to show", 1, 1.5, true}),
                      plot::horizontal_line(100 * (1 - goal.confidence),
                                            {colour::prior, "consumer's risk", 1, 1.5, true})},
                     300)};
}

html::Figure time_by_size(const SuddenDeath& result) {
  const DemonstrationGoal& goal = result.goal;
  std::vector<double> x, earliest, median;
  for (std::size_t size = 1; size <= 20; ++size) {
    x.push_back(present::count(size));
    earliest.push_back(goal.shown(
        sudden_death_test(*goal.groups, size, result.shape(), goal.goal.failing, goal.confidence)
            .earliest));
    median.push_back(goal.shown(median_first_failure(size, result.shape(), goal.goal.failing, 1)));
  }
  return {"group-size", "Test time by the size of the groups",
          "Time at which the test passes if no group has failed, and the median first failure of a "
          "group if the goal is just met.",
          plot::plot(
              "Test time against the size of the groups", {"Group size", false, 1.0, 20.0},
              {fmt::format("Time [{}]", html::unit(goal.goal.unit.text)), false, 0.0},
              {plot::line({{"x", x}, {"y", earliest}}, {colour::posterior, "earliest pass"}),
               plot::line({{"x", x}, {"y", median}}, {colour::measured, "median first failure"})},
              300)};
}

std::string rule_sentence(const SuddenDeath& result) {
  const SuddenDeathTest& test = result.tests.front();
  const DemonstrationGoal& goal = result.goal;
  const std::string unit = goal.goal.unit.text == "1" ? "" : " " + goal.goal.unit.text;
  return fmt::format(
      "Test {} groups{}, each to its first failure. The test passes as soon as the sum of (t / {}{}"
      ")^{:.4g} over all specimens, those stopped by the failure of another in their group "
      "included, reaches {}.",
      test.groups, result.tests.size() == 1 ? fmt::format(" of {}", test.size) : " of equal size",
      plain_given(goal.shown(1)), unit, result.shape(), plain_number(test.exposure));
}

constexpr const char* sudden_death_note =
    "The first failure of a group of k Weibull lives is Weibull with the same shape and the scale "
    "divided by k^(1/shape). Larger groups shorten the test; they do not change the probability to "
    "pass. The result rests on the shape, which must be known.";

Json sudden_death_json(const SuddenDeath& result) {
  const DemonstrationGoal& goal = result.goal;
  Json json = {
      {"question", "demonstrate"},
      {"goal", goal_json(goal)},
      {"sudden_death", {{"groups", *goal.groups}, {"exposure", result.tests.front().exposure}}}};
  for (const SuddenDeathTest& test : result.tests)
    json["plans"].push_back(
        {{"group_size", test.size},
         {"specimens", test.size * test.groups},
         {"earliest_pass", goal.shown(test.earliest)},
         {"median_first_failure",
          goal.shown(median_first_failure(test.size, result.shape(), goal.goal.failing, 1))},
         {"first_failure_share", test.first_failure_share}});
  json["probability_to_pass"] = Json::array();
  for (const LifePoint& truth : true_lives(goal))
    json["probability_to_pass"].push_back(
        {{"true", truth.text}, {"probability", {result.passing(truth)}}});
  return json;
}

}  // namespace

Answer sudden_death_answer(const DemonstrationGoal& goal) {
  const SuddenDeath result = sudden_death_of(goal);
  const present::Table sizes = sizes_table(result), passes = sudden_death_passes(result);
  const std::string rule = rule_sentence(result);
  present::Section plan{"plan", "Plan"};
  plan.add(present::Prose{rule, true});
  plan.add(present::Prose{html::capital(goal_text(goal)) + "; " + scatter_text(goal) + "."});
  plan.add(present::Prose{sudden_death_note});
  plan.add(present::Figures{{sudden_death_characteristic(result), time_by_size(result)}});
  plan.add(sizes);
  present::Section passing{"passing", "Probability to pass"};
  passing.add(passes);
  const std::string text =
      "Show " + wrapped(printable(goal.goal.text), 0, 2) + wrapped(goal_text(goal), 2, 4) +
      wrapped(printable(scatter_text(goal)), 2, 4) + "\n" + wrapped(rule, 0, 2) +
      wrapped(sudden_death_note, 2, 2) + "\n" + present::text(sizes) + "\n" + present::text(passes);
  return {"Show " + goal.goal.text, text, {plan, passing}, sudden_death_json(result)};
}

}  // namespace wearwell::plan
