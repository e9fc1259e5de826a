#include "wearwell/plan/demonstration_question.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/prognosis/quantity_like.h"

namespace wearwell::plan {
namespace {

constexpr std::size_t most_allowed = 1000;
// Nodes of a prior: probabilities to pass are steep in the shape, which needs many.
constexpr int shape_nodes = 48;

std::size_t read_allowed(const std::string& word, const std::string& whole) {
  std::size_t value = 0;
  const char* end = word.data() + word.size();
  const auto [at, error] = std::from_chars(word.data(), end, value);
  if (word.empty() || error != std::errc() || at != end || value > most_allowed)
    throw InputError(fmt::format(
        "--failures: '{}' must be a whole number from 0 to {}, or several like '0 to 3'",
        printable(whole), most_allowed));
  return value;
}

std::vector<std::size_t> read_failures(const std::string& text) {
  const std::size_t middle = text.find(" to ");
  if (middle == std::string::npos) return {read_allowed(text, text)};
  const std::size_t low = read_allowed(text.substr(0, middle), text),
                    high = read_allowed(text.substr(middle + 4), text);
  if (low > high || high - low > 10)
    throw InputError(fmt::format("--failures: '{}' must ascend and span 10 at most", text));
  std::vector<std::size_t> all;
  for (std::size_t f = low; f <= high; ++f) all.push_back(f);
  return all;
}

StandardDistribution standard_of(const std::string& name) {
  static const std::vector<std::string> names = {"weibull", "lognormal", "loglogistic"};
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end())
    throw InputError(fmt::format("--distribution: '{}' is unknown; it is one of {}{}",
                                 printable(name), fmt::join(names, ", "),
                                 did_you_mean(name, names)));
  static constexpr StandardDistribution standards[] = {StandardDistribution::smallest_extreme_value,
                                                       StandardDistribution::normal,
                                                       StandardDistribution::logistic};
  return standards[at - names.begin()];
}

void read_spread(const DemonstrateQuestion& question, DemonstrationGoal& goal) {
  goal.scatter.distribution = standard_of(question.distribution);
  if (goal.weibull() && !question.sigma.empty())
    throw InputError("--sigma: a Weibull distribution has a --shape");
  if (!goal.weibull() && !question.shape.empty())
    throw InputError(
        fmt::format("--shape: a {} distribution has a --sigma", question.distribution));
  if (!goal.weibull() && question.sigma.empty())
    throw InputError(
        fmt::format("--distribution {}: needs --sigma, the scale of the natural logarithm of life",
                    question.distribution));
  const std::string& text = goal.weibull() ? question.shape : question.sigma;
  if (text.empty()) return;
  goal.spread = read_planning_value(goal.weibull() ? "--shape" : "--sigma", text);
  if (!goal.spread->uncertain) {
    goal.scatter = goal.scatter_at(0);
    return;
  }
  for (const NormalNode& node : normal_nodes(shape_nodes))
    goal.scatter.scales.push_back({goal.scale(goal.spread->at(node.z)), node.weight});
}

void check_lengths(const DemonstrationGoal& goal) {
  if (goal.time && !goal.spread && *goal.time < 1)
    throw InputError(
        "--time: a test shorter than the life to show needs --shape: without it nothing links the "
        "two");
  if (!goal.specimens) return;
  if (*goal.specimens < 1 || *goal.specimens > 10'000'000)
    throw InputError("--specimens: must lie between 1 and 10 000 000");
  if (*goal.specimens <= goal.failures.back())
    throw InputError(fmt::format(
        "--specimens: {} specimens always pass a test that allows {} failures; allow fewer",
        *goal.specimens, goal.failures.back()));
}

void check_groups(const DemonstrateQuestion& question, const DemonstrationGoal& goal) {
  const std::size_t groups = *goal.groups;
  if (groups < 1 || groups > 1000)
    throw InputError("--sudden-death: must be a number of groups from 1 to 1000");
  if (!goal.weibull())
    throw InputError(
        "--sudden-death: needs Weibull lives; only their smallest of a group is of the same "
        "family");
  if (!goal.spread || goal.spread->uncertain)
    throw InputError(
        "--sudden-death: needs --shape as a number: the exposure of a test depends on it");
  if (goal.time)
    throw InputError("--sudden-death: each group runs to its first failure; leave out --time");
  if (question.failures != "0")
    throw InputError("--sudden-death: each group has one failure; leave out --failures");
  if (goal.specimens && *goal.specimens % groups != 0)
    throw InputError(fmt::format("--specimens: {} specimens do not make {} groups of equal size",
                                 *goal.specimens, groups));
}

}  // namespace

Scatter DemonstrationGoal::scatter_at(double z) const {
  return {scatter.distribution, {{scale(spread->at(z)), 1}}};
}

DemonstrationGoal read_demonstration(const DemonstrateQuestion& question) {
  DemonstrationGoal goal;
  goal.goal = read_life_point("GOAL", question.goal, ">=");
  goal.confidence = read_probability("--confidence", question.confidence);
  goal.failures = read_failures(question.failures);
  goal.distribution = question.distribution;
  read_spread(question, goal);
  goal.specimens = question.specimens;
  goal.groups = question.sudden_death;
  if (!question.time.empty()) {
    const double time = prognosis::quantity_like("--time", question.time, goal.goal.unit);
    if (!(time > 0))
      throw InputError(fmt::format("--time: '{}' must be positive", printable(question.time)));
    goal.time = time / goal.goal.life;
  }
  for (const std::string& text : question.truth) {
    LifePoint truth = read_life_point("--true", text, "=", &goal.goal.unit);
    if (!goal.spread && std::abs(truth.life / goal.goal.life - 1) > 1e-12)
      throw InputError(fmt::format(
          "--true: '{}' needs --shape: without it only the reliability at the life to show counts, "
          "like 'reliability = 98 % at {:.6g} {}'",
          printable(text), from_si(goal.goal.unit, goal.goal.life), goal.goal.unit.text));
    goal.truth.push_back(std::move(truth));
  }
  check_lengths(goal);
  if (goal.groups) check_groups(question, goal);
  return goal;
}

}  // namespace wearwell::plan
