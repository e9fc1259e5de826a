#include "wearwell/plan/goal.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <regex>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/prognosis/named_life.h"

namespace wearwell::plan {

using prognosis::distribution_at;
using prognosis::life_named;
using prognosis::named_lives;
using prognosis::NamedLife;
using prognosis::without_new;

namespace {

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

WeightedDraws one_point(const double* x, std::size_t count) {
  WeightedDraws one;
  one.values = Eigen::Map<const Points>(x, 1, static_cast<Eigen::Index>(count));
  one.weights = Eigen::VectorXd::Ones(1);
  return one;
}

std::string full_name(const QuantityRequest& request) {
  std::string name = request.name;
  if (!request.of.empty()) name += " of " + request.of;
  if (!request.at.empty()) name += " " + request.at;
  return name;
}

std::string prediction_name(const PredictionRequest& request) {
  return fmt::format("{} at {:.6g} {}", request.quantity, request.at,
                     request.at_unit.empty() ? request.at_name : request.at_unit);
}

// The study's own quantity of that percentage, whose quantiles are over the whole posterior.
std::function<std::optional<std::vector<double>>(const WeightedDraws&)> reported_b_life(
    const NamedLife& life, double percent) {
  const std::string name = lower(fmt::format("B{:.6g} life", percent));
  for (std::size_t i = 0; i < life.group->requests.size(); ++i) {
    const QuantityRequest& each = life.group->requests[i];
    if (lower(each.name) != name || without_new(each.of) != without_new(life.request->of) ||
        each.at != life.request->at)
      continue;
    return [group = life.group, i](const WeightedDraws& draws) {
      const QuantityQuantiles q = group->from_draws(draws)[i];
      return std::optional(std::vector<double>{q.q05, q.q50, q.q95});
    };
  }
  return {};
}

Goal b_life(const PosteriorStudy& study, const NamedLife& life, double percent) {
  Goal goal{
      fmt::format("B{:.6g} of {}", percent, without_new(life.request->of)), life.request->unit, {}};
  if (!life.request->at.empty() && !life.request->at.starts_with("at "))
    goal.name += " " + life.request->at;
  goal.value = [life, share = percent / 100, count = study.parameters.size()](const double* x) {
    return distribution_at(life, {x, count}).quantile(share);
  };
  goal.reported = reported_b_life(life, percent);
  goal.lives = [life](std::span<const double> x) { return distribution_at(life, x); };
  return goal;
}

struct BLife {
  double percent;
  std::string where;
};

std::optional<BLife> b_life_in(const std::string& text) {
  static const std::regex form(
      R"(^\s*b\s*([0-9]+(?:\.[0-9]+)?)(?:\s+life)?(?:\s+(?:at|of|for)\s+(.+?))?\s*$)",
      std::regex::icase);
  std::smatch match;
  if (!std::regex_match(text, match, form)) return {};
  const std::string number = match[1];
  BLife found{0, match[2]};
  std::from_chars(number.data(), number.data() + number.size(), found.percent);
  return found;
}

Goal parameter_goal(const Parameter& parameter, std::size_t index) {
  Goal goal{parameter.name, parameter.unit, {}};
  goal.value = [index](const double* x) { return x[index]; };
  goal.reported = [index](const WeightedDraws& draws) {
    const QuantityDistribution all(draws, [index](const double* x) { return x[index]; });
    return std::optional(
        std::vector<double>{all.quantile(0.05), all.quantile(0.5), all.quantile(0.95)});
  };
  return goal;
}

Goal group_goal(const PosteriorStudy& study, const QuantityGroup& group, std::size_t index) {
  const QuantityRequest& request = group.requests[index];
  Goal goal{full_name(request), request.unit, {}};
  goal.value = [&group, index, count = study.parameters.size()](const double* x) {
    return group.from_draws(one_point(x, count))[index].q50;
  };
  goal.reported = [&group, index](const WeightedDraws& draws) {
    const QuantityQuantiles q = group.from_draws(draws)[index];
    return std::optional(std::vector<double>{q.q05, q.q50, q.q95});
  };
  return goal;
}

Goal function_goal(std::string name, const Unit& unit, const Function& value) {
  Goal goal{std::move(name), unit, value};
  goal.reported = [value](const WeightedDraws& draws) {
    const QuantityDistribution all(draws, value);
    return std::optional(
        std::vector<double>{all.quantile(0.05), all.quantile(0.5), all.quantile(0.95)});
  };
  return goal;
}

struct NamedGoal {
  std::string name, of;  // `of` with its name is another name
  std::function<Goal()> make;
};

// All but lives at any percentage.
std::vector<NamedGoal> named_goals(const PosteriorStudy& study) {
  std::vector<NamedGoal> all;
  for (const QuantityGroup& group : study.quantity_groups) {
    for (std::size_t i = 0; i < group.requests.size(); ++i) {
      const QuantityRequest& each = group.requests[i];
      if (each.is_life || b_life_in(each.name)) continue;  // as "B10 of NAME"
      all.push_back({full_name(each), each.name,
                     [&study, &group, i] { return group_goal(study, group, i); }});
    }
  }
  for (const QuantityRequest& each : study.quantities) {
    if (!each.value || !each.driver || each.scatter) continue;
    all.push_back({full_name(each), each.name, [&each] {
                     return function_goal(full_name(each), each.unit, [&each](const double* x) {
                       return each.value(each.driver(x));
                     });
                   }});
  }
  for (const PredictionRequest& each : study.predictions) {
    if (each.with_item) continue;  // of one unit seen, whose own unknowns are not nodes
    all.push_back({prediction_name(each), each.quantity,
                   [&each] { return function_goal(prediction_name(each), each.unit, each.mean); }});
  }
  for (std::size_t i = 0; i < study.parameters.size(); ++i)
    all.push_back({study.parameters[i].name, "",
                   [&study, i] { return parameter_goal(study.parameters[i], i); }});
  return all;
}

}  // namespace

std::vector<std::string> known_goals(const PosteriorStudy& study) {
  std::vector<std::string> names;
  for (const NamedLife& each : named_lives(study))
    names.push_back(fmt::format("B10 of {}", without_new(each.request->of)));
  if (study.life) names.push_back("life");
  for (const NamedGoal& each : named_goals(study)) names.push_back(each.name);
  std::vector<std::string> once;
  for (std::string& each : names)
    if (std::find(once.begin(), once.end(), each) == once.end()) once.push_back(std::move(each));
  return once;
}

Goal goal_of(const PosteriorStudy& study, const std::string& text) {
  const auto asked = b_life_in(text);
  const bool is_b_life =
      asked && std::none_of(study.parameters.begin(), study.parameters.end(),
                            [&](const Parameter& each) { return each.name == text; });
  const bool of_one = study.life && (is_b_life || lower(text) == "life");
  if (is_b_life && !(asked->percent > 0 && asked->percent < 100))
    throw InputError(
        fmt::format("--goal: '{}': the percentage must lie between 0 and 100", printable(text)));
  if (of_one) {
    // The life of one joint follows from the parameters: all percentages are the same.
    Goal goal{
        "life of " + (study.life->of.empty() ? std::string("joint") : without_new(study.life->of)),
        study.life->unit,
        {}};
    if (is_b_life) goal.name = fmt::format("B{:.6g} {}", asked->percent, goal.name);
    const double share = is_b_life ? asked->percent / 100 : 0.5;
    goal.value = [&study, share, unit = study.life->unit](const double* x) {
      // Lives of this request are in their unit.
      return to_si(unit,
                   study.life->distribution(one_point(x, study.parameters.size())).quantile(share));
    };
    return goal;
  }
  const std::vector<NamedLife> lives = named_lives(study);
  if (is_b_life && !lives.empty())
    return b_life(study, life_named(lives, asked->where, "--goal"), asked->percent);
  if (is_b_life)
    throw InputError(fmt::format(
        "--goal: '{}': the study has no life: [predict] needs a limit, or for lives and S-N tests "
        "b_lives or a stress. Its goals are: {}",
        printable(text), fmt::join(known_goals(study), "; ")));
  const std::string wanted = lower(text);
  std::vector<const NamedGoal*> exact, partial;
  const std::vector<NamedGoal> all = named_goals(study);
  for (const NamedGoal& each : all) {
    const std::string name = lower(each.name);
    if (name == wanted) exact.push_back(&each);
    if (lower(each.of) == wanted || name.starts_with(wanted + " ")) partial.push_back(&each);
  }
  if (!exact.empty()) return exact.front()->make();
  if (partial.size() == 1) return partial.front()->make();
  const std::vector<std::string> known = known_goals(study);
  if (partial.size() > 1) {
    std::vector<std::string> names;
    for (const NamedGoal* each : partial) names.push_back(each->name);
    throw InputError(fmt::format("--goal: '{}' may be {}; write one of them in full",
                                 printable(text), fmt::join(names, "; or ")));
  }
  std::vector<std::string> near = known;
  for (const NamedGoal& each : all)
    if (!each.of.empty()) near.push_back(each.of);
  throw InputError(fmt::format("--goal: the study has no '{}'; its goals are: {}{}",
                               printable(text), fmt::join(known, "; "), did_you_mean(text, near)));
}

double GoalValues::in_unit(double on_scale) const {
  return logarithmic ? std::exp(on_scale) : on_scale;
}

GoalValues goal_values(const Goal& goal, const Points& nodes, std::span<const double> weights) {
  const auto n = static_cast<std::size_t>(nodes.rows());
  GoalValues values;
  values.value.assign(n, NAN);
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t j) {
    values.value[j] =
        from_si(goal.unit, goal.value(nodes.row(static_cast<Eigen::Index>(j)).data()));
  });
  double missing = 0, sum = 0, mass = 0;
  bool positive = true;
  for (std::size_t j = 0; j < n; ++j) {
    if (!std::isfinite(values.value[j])) {
      missing += weights[j];
      continue;
    }
    positive = positive && values.value[j] > 0;
    sum += weights[j] * values.value[j];
    mass += weights[j];
  }
  constexpr double most_missing = 1e-3;
  if (missing > most_missing)
    throw InputError(fmt::format(
        "--goal: {} has no finite value with a probability of {:.2g} %, so that its uncertainty "
        "has no size; choose a goal that always has one",
        goal.name, 100 * missing));
  const bool logarithm_already = is_logarithm(goal.unit.text);
  values.logarithmic = positive && !logarithm_already;
  for (double& each : values.value) {
    if (!std::isfinite(each)) each = sum / mass;
    if (values.logarithmic) each = std::log(each);
  }
  return values;
}

}  // namespace wearwell::plan
