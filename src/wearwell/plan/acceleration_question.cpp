#include "wearwell/plan/acceleration_question.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <tuple>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/input/option_value.h"
#include "wearwell/plan/life_requirement.h"
#include "wearwell/prognosis/quantity_like.h"

namespace wearwell::plan {
namespace {

std::size_t choice_of(const std::string& option, const std::string& word,
                      const std::vector<std::string>& words) {
  const auto at = std::find(words.begin(), words.end(), word);
  if (at == words.end())
    throw InputError(fmt::format("{}: '{}' is unknown; it is one of {}{}", option, printable(word),
                                 fmt::join(words, ", "), did_you_mean(word, words)));
  return static_cast<std::size_t>(at - words.begin());
}

const std::string& required_option(const std::string& option, const std::string& text,
                                   const char* like) {
  if (text.empty())
    throw InputError(fmt::format("{}: is missing; give it, like '{}'", option, like));
  return text;
}

double goal_share(const std::string& text) {
  double percent = 0;
  const char* end = text.data() + text.size();
  const bool named = text.size() > 1 && std::string_view("BbLl").find(text[0]) != std::string::npos;
  const auto [at, error] = std::from_chars(text.data() + named, end, percent);
  if (!named || error != std::errc() || at != end || !(percent > 0 && percent < 100))
    throw InputError(
        fmt::format("--goal: '{}' is unknown; a goal is a B-life between B0 and B100, like 'B10'",
                    printable(text)));
  return percent / 100;
}

NamedValue spread_of(const AccelerateQuestion& question) {
  if (question.shape.empty() == question.sigma.empty())
    throw InputError("--shape, --sigma: give one of them, the planning value of the scatter");
  if (!question.sigma.empty())
    return {"sigma", "--sigma", read_planning_value("--sigma", question.sigma)};
  if (question.family != "weibull")
    throw InputError(fmt::format("--shape: a {} distribution has a --sigma", question.family));
  return {"shape", "--shape", read_planning_value("--shape", question.shape)};
}

// A stress in SI: a temperature, or a quantity of the dimension of the highest stress.
double read_stress(const AccelerationTest& test, const std::string& option,
                   const std::string& text) {
  return is_of_temperature(test.relation)
             ? option_value(option, text, "K")
             : prognosis::quantity_like(option, text, test.stress_unit);
}

void read_stresses(const AccelerateQuestion& question, AccelerationTest& test) {
  required_option("--use", question.use, "50 degC");
  required_option("--highest", question.highest, "120 degC");
  if (is_of_temperature(test.relation)) option_value("--highest", question.highest, "K");
  test.stress_unit = read_any_quantity("--highest", question.highest).unit;
  test.highest = read_stress(test, "--highest", question.highest);
  test.use = read_stress(test, "--use", question.use);
  if (test.relation != Relation::linear && !(test.use > 0))
    throw InputError(fmt::format("--use: '{}' must be positive", printable(question.use)));
  if (!(test.use < test.highest))
    throw InputError(
        fmt::format("--use: '{}' must be below --highest '{}'; an accelerated test is "
                    "above the use condition",
                    printable(question.use), printable(question.highest)));
  const auto level = [&](const std::string& option, const std::string& text) {
    const double xi = test.xi(read_stress(test, option, text));
    if (!(xi >= 0 && xi < 0.99))
      throw InputError(
          fmt::format("{}: '{}' must lie from --use to below --highest", option, printable(text)));
    return xi;
  };
  if (!question.lowest.empty()) test.lowest_xi = level("--lowest", question.lowest);
  if (!question.low.empty()) test.low_xi = level("--low", question.low);
  if (test.low_xi >= 0 && test.low_xi < test.lowest_xi)
    throw InputError("--low: is below --lowest");
}

// "365 d, 250 d, 183 d": of the lower, the middle and the highest level.
void read_stops(AccelerationTest& test) {
  const std::string& text = test.question.stop;
  if (text.empty()) return;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::size_t first = std::min(text.find_first_not_of(' ', begin), end);
    test.stops.push_back(prognosis::quantity_like("--stop", text.substr(first, end - first),
                                                  test.time_unit, Allowed::positive));
    begin = end + 1;
  }
  if (test.stops.size() != 3)
    throw InputError(fmt::format(
        "--stop: '{}' has {} time{}; it has three, of the lower, the middle and the highest level, "
        "like '365 d, 250 d, 183 d' (the plan with two levels uses the first and the last)",
        printable(text), test.stops.size(), test.stops.size() == 1 ? "" : "s"));
}

NamedValue life_value(AccelerationTest& test) {
  std::string text = test.question.life_at_highest;
  if (const std::size_t sign = text.find('='); sign != std::string::npos) {
    std::string name = text.substr(0, sign);
    while (!name.empty() && name.back() == ' ') name.pop_back();
    try {
      test.life_share = goal_share(name);
    } catch (const InputError&) {
      throw InputError(
          fmt::format("--life-at-highest: '{}' must be like '60 d' (the median) or "
                      "'B10 = 20 d'",
                      printable(text)));
    }
    text = text.substr(std::min(text.find_first_not_of(' ', sign + 1), text.size()));
  }
  try {
    return {fmt::format("B{:.6g} at the highest stress", 100 * test.life_share),
            "--life-at-highest",
            read_planning_quantity("--life-at-highest", text, test.time_unit.text),
            test.time_unit.text, 1 / test.time_unit.scale};
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}; write it in the dimension of --until", error.what()));
  }
}

// How steeply life falls, for the relation; another relation's is refused.
std::optional<NamedValue> slope_value(const AccelerationTest& test) {
  const AccelerateQuestion& question = test.question;
  const std::tuple<Relation, const char*, const std::string*, const char*> all[] = {
      {Relation::arrhenius, "--activation-energy", &question.activation_energy,
       "arrhenius or eyring"},
      {Relation::inverse_power, "--exponent", &question.exponent, "inverse-power"},
      {Relation::linear, "--slope", &question.slope, "linear"}};
  std::optional<NamedValue> found;
  for (const auto& [relation, option, text, name] : all) {
    if (text->empty()) continue;
    const bool fits = relation == Relation::arrhenius ? is_of_temperature(test.relation)
                                                      : relation == test.relation;
    if (!fits)
      throw InputError(
          fmt::format("{}: belongs to --relation {}, not {}", option, name, question.relation));
    if (relation == Relation::arrhenius)
      found = {"activation energy", option, read_planning_quantity(option, *text, "J"), "eV",
               1 / electron_volt};
    else
      found = {option + 2, option, read_planning_value(option, *text)};
  }
  return found;
}

// Two planning values of the relation, in the order use, highest, slope.
void read_relation(AccelerationTest& test) {
  const AccelerateQuestion& question = test.question;
  std::vector<NamedValue> found;
  if (!question.failing_at_use.empty())
    found.push_back(
        {"failing at use", "--failing-at-use",
         read_planning_share("--failing-at-use", question.failing_at_use, test.distribution), "%",
         100});
  if (!question.failing_at_highest.empty())
    found.push_back({"failing at highest", "--failing-at-highest",
                     read_planning_share("--failing-at-highest", question.failing_at_highest,
                                         test.distribution),
                     "%", 100});
  if (!question.life_at_highest.empty()) {
    if (!question.failing_at_highest.empty())
      throw InputError(
          "--life-at-highest and --failing-at-highest say the same in two ways; give one");
    found.push_back(life_value(test));
  }
  if (auto slope = slope_value(test)) found.push_back(std::move(*slope));
  if (found.size() != 2)
    throw InputError(
        fmt::format("the line of life needs two planning values, not {}: two of --failing-at-use, "
                    "--failing-at-highest or --life-at-highest, and {}",
                    found.size(),
                    is_of_temperature(test.relation)           ? "--activation-energy"
                    : test.relation == Relation::inverse_power ? "--exponent"
                                                               : "--slope"));
  test.values[1] = std::move(found[0]);
  test.values[2] = std::move(found[1]);
}

void check_line(const AccelerationTest& test, const AccelerationGoal& goal) {
  for (const PlanningPoint& point : goal.points)
    if (!(point.rise > 0 && std::isfinite(point.rise) && std::isfinite(point.at_use)))
      throw InputError(fmt::format(
          "{} and {}: life must fall with stress{}; fewer must fail at the use condition than at "
          "the highest",
          test.values[1].option, test.values[2].option,
          goal.points.size() > 1 ? " over the whole of their intervals" : ""));
}

}  // namespace

AccelerationTest read_acceleration(const AccelerateQuestion& question) {
  static constexpr StandardDistribution standards[] = {StandardDistribution::smallest_extreme_value,
                                                       StandardDistribution::normal,
                                                       StandardDistribution::logistic};
  AccelerationTest test;
  test.question = question;
  test.distribution =
      standards[choice_of("--family", question.family, {"weibull", "lognormal", "loglogistic"})];
  test.relation = static_cast<Relation>(choice_of(
      "--relation", question.relation, {"arrhenius", "eyring", "inverse-power", "linear"}));
  read_stresses(question, test);
  const Quantity until =
      read_any_quantity("--until", required_option("--until", question.until, "183 d"));
  test.until = checked_option("--until", question.until, until.si(), Allowed::positive);
  test.time_unit = until.unit;
  if (const auto unit = parse_unit(until.unit.text); unit && unit->offset != 0)
    throw InputError(fmt::format("--until: '{}' is not a time", printable(question.until)));
  read_stops(test);
  if (question.specimens < 4 || question.specimens > 1'000'000)
    throw InputError("--specimens: must lie between 4 and 1 000 000");
  test.failing = goal_share(question.goal);
  test.middle_share = read_probability("--middle-share", question.middle_share);
  if (test.middle_share > 0.8)
    throw InputError("--middle-share: must be at most 80 %, to leave specimens for the ends");
  if (question.least_failures < 1 || question.least_failures > 1000)
    throw InputError("--least-failures: must lie between 1 and 1000");
  test.values[0] = spread_of(question);
  read_relation(test);
  check_line(test, test.at_medians());
  check_line(test, test.averaged());
  return test;
}

}  // namespace wearwell::plan
