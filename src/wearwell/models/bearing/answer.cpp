#include "wearwell/models/bearing/answer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/input/option_value.h"

namespace wearwell::bearing {
namespace {

constexpr int min_draws = 100, max_draws = 10'000'000;
constexpr double small_margin = 0.1;      // of the limit; a smaller margin is reported as small
constexpr double small_clearance = 0.01;  // sigma; the paper's charts end at 0.002
constexpr double large_amplification = 5;

double quantile(const std::vector<double>& sorted, double p) {
  const double at = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const auto above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], at - static_cast<double>(below));
}

/// What to write instead of normal distributions so wide that a considerable part is not positive;
/// empty if there is none.
std::string use_a_lognormal(const UncertainBearing& uncertain) {
  constexpr double widest =
      1.0 / 3;  // of the mean: with a larger sd more than one in a thousand is negative
  std::string advice;
  for (const auto& [option, value] : uncertain.given) {
    if (value.distribution != Uncertain::Distribution::normal || !(value.sd > widest * value.mean))
      continue;
    const std::string amount = fmt::format("{:.6g}{}", from_si(value.unit, value.mean),
                                           value.unit.text == "1" ? "" : " " + value.unit.text);
    advice += fmt::format(
        "; use a lognormal for {}, which is positive and has a standard deviation of {:.3g} %: '{} "
        "x/ {:.2g}'",
        option->flag, 100 * value.sd / value.mean, amount, equal_factor(value));
  }
  return advice;
}

/// Propagates the uncertainty of the inputs to the answer, with one random stream per option, so
/// that the draws of an input do not depend on the other inputs.
Interval propagate(Quantity wanted, const UncertainBearing& uncertain, std::optional<double> limit,
                   int draws, std::uint64_t seed) {
  std::vector<Rng> streams;
  for (const auto& g : uncertain.given)
    streams.emplace_back(seed, static_cast<std::uint64_t>(g.option - input_options.data()));
  Interval result;
  std::vector<double> answers;
  answers.reserve(static_cast<std::size_t>(draws));
  Bearing drawn;
  drawn.contact = uncertain.contact;
  while (answers.size() < static_cast<std::size_t>(draws)) {
    for (std::size_t i = 0; i < streams.size(); ++i)
      drawn.*(uncertain.given[i].option->input) =
          uncertain.given[i].option->factor * draw(uncertain.given[i].value, streams[i]);
    try {
      answers.push_back(solve(wanted, drawn).value);
    } catch (const InputError& error) {
      if (++result.redrawn > draws) {
        throw InputError(fmt::format(
            "the uncertainties are too wide: most draws are impossible, for example {}{}",
            error.what(), use_a_lognormal(uncertain)));
      }
    }
  }
  std::sort(answers.begin(), answers.end());
  result.q05 = quantile(answers, 0.05);
  result.q50 = quantile(answers, 0.50);
  result.q95 = quantile(answers, 0.95);
  result.b10 = quantile(answers, 0.10);
  if (limit) {
    const auto above = answers.end() - std::upper_bound(answers.begin(), answers.end(), *limit);
    result.beyond_limit = static_cast<double>(above) / draws;
  }
  return result;
}

Unit answer_unit(const Question& question, const std::string& asked) {
  try {
    return read_unit(asked.empty() ? question.unit : asked, question.si);
  } catch (const InputError& error) {
    throw InputError(fmt::format("--unit: {}", error.what()));
  }
}

std::optional<double> read_limit(const std::string& text) {
  if (text.empty()) return std::nullopt;
  return option_value("--limit", text, "m", Allowed::positive);
}

/// The margin of the depth to its limit, and the probability of exceeding it.
std::string margin_statement(const Answer& a, const std::string& text_of_limit, double limit) {
  const Solution& s = a.solution;
  const double margin = 1 - s.value / limit;
  double reserve = 0;
  try {
    reserve = wear_number(a.given.contact, s.sigma, limit / a.radius()) / s.wear_number - 1;
  } catch (const InputError& error) {
    throw InputError(fmt::format("--limit: {}", error.what()));
  }
  std::string text;
  if (margin > 0) {
    text = fmt::format(
        "The depth is {:.3g} % below the limit of {}{}; a rate, pressure or number of revolutions "
        "{:.3g} % higher would reach it.",
        100 * margin, text_of_limit, margin < small_margin ? ", a small margin" : "",
        100 * reserve);
  } else {
    text = fmt::format(
        "The depth is {:.3g} % above the limit of {}: rate, pressure or revolutions must be {:.3g} "
        "% "
        "lower.",
        -100 * margin, text_of_limit, -100 * reserve);
  }
  if (a.interval)
    text += fmt::format(" It exceeds the limit in {:.3g} % of the draws.",
                        100 * a.interval->beyond_limit);
  return text;
}

}  // namespace

const std::vector<Question>& questions() {
  using B = Bearing;
  static const std::vector<Question> list = {
      {"rate",
       "Wear rate k",
       Quantity::rate,
       "m^3/(N m)",
       "m^3/(N m)",
       "The wear rate k from a measured depth",
       {&B::rate},
       "wearwell bearing rate --contact stationary --radius '20 mm' --clearance '20 um' \\\n"
       "    --depth '0.100 +- 0.005 mm' --pressure '1 MPa' --revolutions 1e5"},
      {"depth",
       "Wear depth d",
       Quantity::depth,
       "m",
       "mm",
       "The wear depth after a number of revolutions",
       {&B::depth, &B::scar_width},
       "wearwell bearing depth --contact stationary --radius '10 mm' --clearance '20 um' \\\n"
       "    --rate '1e-16 m^3/(N m)' --pressure '2 MPa' --revolutions 1e6 --limit '20 um'"},
      {"pressure",
       "Allowable pressure p_a",
       Quantity::pressure,
       "Pa",
       "MPa",
       "The apparent pressure at which wear stays within the depth",
       {&B::pressure, &B::force, &B::length},
       "wearwell bearing pressure --contact bushing --radius '10 mm' --clearance '20 um' \\\n"
       "    --depth '50 um' --rate '~ lognormal(1e-16 m^3/(N m), 2e-17 m^3/(N m))' \\\n"
       "    --speed '60 rpm' --time '5000 h'"},
      {"length",
       "Required length L",
       Quantity::length,
       "m",
       "mm",
       "The bearing length at which wear under a force stays within the depth",
       {&B::pressure, &B::length},
       "wearwell bearing length --contact stationary --radius '10 mm' --clearance '20 um' \\\n"
       "    --depth '20 um' --rate '1e-16 m^3/(N m)' --force '800 N' --revolutions 1e6"},
      {"life",
       "Life",
       Quantity::revolutions,
       "rev",
       "revolutions",
       "The life until the depth is reached: in revolutions, or in time with --speed",
       {&B::revolutions, &B::time},
       "wearwell bearing life --contact journal --radius '10 mm' --clearance '20 um' \\\n"
       "    --depth '50 +- 5 um' --rate '1e-16 m^3/(N m) +- 10 %' --pressure '2 MPa' --speed '60 "
       "rpm'"},
  };
  return list;
}

Answer answer(Question question, const Asked& asked) {
  if (question.wanted == Quantity::revolutions && !asked.inputs.text(&Bearing::speed).empty()) {
    question.wanted = Quantity::time;
    question.si = "s";
    question.unit = "h";
  }
  if (asked.draws < min_draws || asked.draws > max_draws) {
    throw InputError(
        fmt::format("--draws is {}; it must be {} to {}", asked.draws, min_draws, max_draws));
  }
  const Unit unit = answer_unit(question, asked.unit);
  const std::optional<double> limit = read_limit(asked.limit);
  const UncertainBearing given = asked.inputs.read();
  const Bearing mean = given.mean();
  Answer found{.question = question,
               .unit = unit,
               .given = given,
               .solution = solve(question.wanted, mean),
               .sensitivity = sensitivity(question.wanted, mean),
               .scar = std::nullopt,
               .interval = std::nullopt,
               .margin = "",
               .draws = asked.draws,
               .seed = asked.seed};
  if (given.contact == Contact::stationary)
    found.scar = scar(found.solution.sigma, found.solution.delta);
  if (!given.is_exact())
    found.interval = propagate(question.wanted, given, limit, asked.draws, asked.seed);
  if (limit) found.margin = margin_statement(found, asked.limit, *limit);
  return found;
}

std::vector<std::string> warnings(const Answer& a) {
  std::vector<std::string> result;
  const Bearing mean = a.given.mean();
  const Solution& s = a.solution;
  if (mean.scar_width) {
    const double amplification =
        depth_from_scar(s.sigma, *mean.scar_width / *mean.radius).amplification;
    if (s.sigma < small_clearance || amplification > large_amplification) {
      result.push_back(
          fmt::format("the scar width is a poor measure of the depth at a clearance/radius of "
                      "{:.3g}: an error of 1 % in the width is one of {:.3g} % in the depth "
                      "(amplification factor {:.4g}); measure the depth directly",
                      s.sigma, amplification, amplification));
    }
  }
  if (const double widest = widest_depth(s.sigma); a.scar && s.delta > widest) {
    result.push_back(fmt::format(
        "beyond a depth of {:.4g} mm the journal has sunk in by more than its largest width and "
        "cuts a slot; the worn area here is that of the journal's circle only, which is less",
        widest * a.radius() * 1e3));
  }
  if (a.interval && a.interval->redrawn > 0) {
    result.push_back(fmt::format(
        "discarded and redrew {} impossible draws (a negative size, a depth beyond the geometry), "
        "{:.2g} % of all; the interval is conditional on possible values{}",
        a.interval->redrawn, 100.0 * a.interval->redrawn / (a.interval->redrawn + a.draws),
        use_a_lognormal(a.given)));
  }
  return result;
}

nlohmann::ordered_json to_json(const Answer& a) {
  nlohmann::ordered_json json;
  json["quantity"] = a.question.command;
  json["contact"] = contact_name(a.given.contact);
  json["value"] = a.in_unit(a.solution.value);
  json["unit"] = a.unit.text;
  json["wear_number"] = a.solution.wear_number;
  json["sigma"] = a.solution.sigma;
  json["delta"] = a.solution.delta;
  json["scar_width"] = nullptr;
  if (a.scar) json["scar_width"] = {{"value", a.scar->width * a.radius() * 1e3}, {"unit", "mm"}};
  json["interval"] = nullptr;
  if (a.interval) {
    json["interval"] = {{"q05", a.in_unit(a.interval->q05)},
                        {"q50", a.in_unit(a.interval->q50)},
                        {"q95", a.in_unit(a.interval->q95)}};
    if (a.is_life()) json["interval"]["b10"] = a.in_unit(a.interval->b10);
  }
  return json;
}

Answer answer(const std::string& question, const std::string& contact,
              const std::map<std::string, std::string>& inputs, Asked asked) {
  std::vector<std::string> names;
  for (const Question& each : questions()) names.emplace_back(each.command);
  const auto found = std::find(names.begin(), names.end(), question);
  if (found == names.end()) throw std::logic_error("no such question " + question);
  asked.inputs.contact = contact;
  std::vector<std::string> flags;
  for (const InputOption& each : input_options) flags.emplace_back(each.flag + 2);
  for (const auto& [name, text] : inputs) {
    const auto flag = std::find(flags.begin(), flags.end(), name);
    if (flag == flags.end()) {
      throw InputError(fmt::format("a bearing has no '{}'{}: {}", name, did_you_mean(name, flags),
                                   fmt::join(flags, ", ")));
    }
    asked.inputs.texts[static_cast<std::size_t>(flag - flags.begin())] = text;
  }
  return answer(questions()[static_cast<std::size_t>(found - names.begin())], asked);
}

}  // namespace wearwell::bearing
