#include "wearwell/models/bearing/commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/option_value.h"
#include "wearwell/models/bearing/chart_command.h"
#include "wearwell/models/bearing/options.h"
#include "wearwell/models/bearing/profile_command.h"
#include "wearwell/models/bearing/scar.h"
#include "wearwell/models/bearing/solve.h"
#include "wearwell/present/number.h"
#include "wearwell/present/plain.h"

// Longer than others: five questions with one kind of answer; texts, options and margins belong to all.
namespace wearwell {
namespace bearing {
namespace {

using std::numbers::pi;

constexpr int min_draws = 100, max_draws = 10'000'000;
constexpr double small_margin = 0.1;      // of the limit; below, the margin is called small
constexpr double small_clearance = 0.01;  // sigma; the paper's charts end at 0.002
constexpr double large_amplification = 5;

/// What one subcommand answers.
struct Question {
  const char* command;
  const char* title;
  Quantity wanted;
  const char* si;
  const char* unit;  ///< of the answer when none is asked for
  const char* help;
  std::vector<Input> unused;
  const char* example;
};

struct Options {
  BearingOptions bearing;
  std::string unit;
  std::string limit;
  int draws = 100'000;
  std::uint64_t seed = 1;
  bool json = false;
};

struct Interval {
  double q05 = 0, q50 = 0, q95 = 0;  ///< SI
  double b10 = 0;                    ///< of a life: reached before in one draw of ten
  int redrawn = 0;                   ///< impossible draws, which were drawn again
  double beyond_limit = 0;           ///< share of the draws above the limit
};

double quantile(const std::vector<double>& sorted, double p) {
  const double at = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const auto above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], at - static_cast<double>(below));
}

/// What to write instead of normal laws that are so wide that a good part of them is not positive;
/// empty when there is none.
std::string use_a_lognormal(const UncertainBearing& uncertain) {
  constexpr double widest =
      1.0 / 3;  // of the mean: beyond, more than one in a thousand is negative
  std::string advice;
  for (const auto& [option, value] : uncertain.given) {
    if (value.law != Uncertain::Law::normal || !(value.sd > widest * value.mean)) continue;
    const std::string amount = fmt::format("{:.6g}{}", from_si(value.unit, value.mean),
                                           value.unit.text == "1" ? "" : " " + value.unit.text);
    advice += fmt::format(
        "; use a lognormal for {}, which is positive and has {:.3g} % for its "
        "standard deviation: '{} x/ {:.2g}'",
        option->flag, 100 * value.sd / value.mean, amount, equal_factor(value));
  }
  return advice;
}

/// Carries the uncertainty of the inputs to the answer, one random stream per option, so that an
/// input keeps its draws whatever else is uncertain.
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
        throw InputError(
            fmt::format("the uncertainties are too wide: most draws are impossible, for example "
                        "{}{}",
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

/// Everything that a subcommand has to say.
struct Answer {
  Question question;
  Unit unit;
  UncertainBearing given;
  Solution solution;
  Bearing sensitivity;
  std::optional<Scar> scar;  ///< in journal radii
  std::optional<Interval> interval;
  std::string margin;  ///< a sentence; empty without a limit
  const Options& options;

  double radius() const { return *given.mean().radius; }
  double in_unit(double si) const { return from_si(unit, si); }
  bool is_life() const {
    return question.wanted == Quantity::revolutions || question.wanted == Quantity::time;
  }
};

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

/// How far the depth stays from its limit, and what else may happen before it is reached.
std::string margin_statement(const Answer& a, double limit) {
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
        "{:.3g} % higher would use it up.",
        100 * margin, a.options.limit, margin < small_margin ? ", a small margin" : "",
        100 * reserve);
  } else {
    text = fmt::format(
        "The depth is {:.3g} % above the limit of {}: rate, pressure or revolutions must be {:.3g} "
        "% "
        "lower.",
        -100 * margin, a.options.limit, -100 * reserve);
  }
  if (a.interval)
    text += fmt::format(" It exceeds the limit in {:.3g} % of the draws.",
                        100 * a.interval->beyond_limit);
  return text;
}

std::vector<std::string> warnings(const Answer& a) {
  std::vector<std::string> result;
  const Bearing mean = a.given.mean();
  const Solution& s = a.solution;
  if (mean.scar_width) {
    const double amplification =
        depth_from_scar(s.sigma, *mean.scar_width / *mean.radius).amplification;
    if (s.sigma < small_clearance || amplification > large_amplification) {
      result.push_back(fmt::format(
          "the scar width is a bad measure of the depth at a clearance/radius of {:.3g}: an "
          "error of 1 % in the width is one of {:.3g} % in the depth (amplification factor "
          "{:.4g}); measure the depth itself",
          s.sigma, amplification, amplification));
    }
  }
  if (const double widest = widest_depth(s.sigma); a.scar && s.delta > widest) {
    result.push_back(fmt::format(
        "beyond a depth of {:.4g} mm the journal has sunk in by more than its widest place "
        "and leaves a slot; the worn area here is that of the journal's circle alone, "
        "which is less",
        widest * a.radius() * 1e3));
  }
  if (a.interval && a.interval->redrawn > 0) {
    result.push_back(fmt::format(
        "{} impossible draws (a negative size, a depth beyond the geometry), {:.2g} % of all, were "
        "drawn again, so the interval is that of the possible ones{}",
        a.interval->redrawn, 100.0 * a.interval->redrawn / (a.interval->redrawn + a.options.draws),
        use_a_lognormal(a.given)));
  }
  return result;
}

nlohmann::ordered_json json_of(const Answer& a) {
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

// Computed from numbers that were given, not estimated: so many digits, without zeros at their end.
std::string digits(double x, int count) {
  return numbers_in_words(fmt::format("{:.{}g}", x, count), Script::terminal);
}

void print_text(const Answer& a) {
  const Solution& s = a.solution;
  fmt::print("{}: {} {}\n", a.question.title, digits(a.in_unit(s.value), 6), a.unit.text);
  if (a.interval) {
    fmt::print("{} {} (90 %), median {} ({} draws, seed {})\n",
               plain_range(a.in_unit(a.interval->q05), a.in_unit(a.interval->q95)), a.unit.text,
               plain_number(a.in_unit(a.interval->q50)), plain_given(a.options.draws),
               a.options.seed);
    if (a.is_life())
      fmt::print("B10 life: {} {}: one in ten reaches the depth before that\n",
                 plain_number(a.in_unit(a.interval->b10)), a.unit.text);
  }
  fmt::print("\n");
  print_row("sigma = clearance/radius", digits(s.sigma, 10));
  print_row("delta = depth/radius", digits(s.delta, 10));
  print_row("wear number p_a k n", digits(s.wear_number, 10));
  if (a.question.wanted != Quantity::depth)
    print_row("depth", fmt::format("{:.6g} mm", s.delta * a.radius() * 1e3));
  if (a.scar) {
    print_row("scar width", fmt::format("{:.6g} mm", a.scar->width * a.radius() * 1e3));
    print_row("centre angle of the scar",
              fmt::format("{:.4g} deg", a.scar->centre_angle * 180 / pi));
  }
  if (const Bearing mean = a.given.mean(); a.question.wanted == Quantity::time)
    print_row("revolutions", digits(s.value * *mean.speed, 6));
  fmt::print("\nChange of the {} when an input grows by 1 %:\n", a.question.command);
  std::size_t width = 0;
  for (const auto& g : a.given.given) width = std::max(width, g.value.text.size());
  for (const auto& g : a.given.given) {
    fmt::print("  {:<14}{:<{}}{:+.4g} %\n", g.option->flag + 2, g.value.text, width + 3,
               *(a.sensitivity.*(g.option->input)));
  }
  if (!a.margin.empty()) fmt::print("\n{}\n", a.margin);
}

Answer answer_of(Question question, const Options& options) {
  if (question.wanted == Quantity::revolutions && !options.bearing.text(&Bearing::speed).empty()) {
    question.wanted = Quantity::time;
    question.si = "s";
    question.unit = "h";
  }
  if (options.draws < min_draws || options.draws > max_draws) {
    throw InputError(
        fmt::format("--draws is {}; it must be {} to {}", options.draws, min_draws, max_draws));
  }
  const Unit unit = answer_unit(question, options.unit);
  const std::optional<double> limit = read_limit(options.limit);
  const UncertainBearing given = options.bearing.read();
  const Bearing mean = given.mean();
  Answer answer{.question = question,
                .unit = unit,
                .given = given,
                .solution = solve(question.wanted, mean),
                .sensitivity = sensitivity(question.wanted, mean),
                .scar = std::nullopt,
                .interval = std::nullopt,
                .margin = "",
                .options = options};
  if (given.contact == Contact::stationary)
    answer.scar = scar(answer.solution.sigma, answer.solution.delta);
  if (!given.is_exact())
    answer.interval = propagate(question.wanted, given, limit, options.draws, options.seed);
  if (limit) answer.margin = margin_statement(answer, *limit);
  return answer;
}

void run(const Question& question, const Options& options) {
  const Answer answer = answer_of(question, options);
  for (const std::string& warning : warnings(answer)) fmt::print(stderr, "warning: {}\n", warning);
  if (options.json) {
    fmt::print("{}\n", printable_json(json_of(answer).dump(2)));
    if (!answer.margin.empty()) fmt::print(stderr, "{}\n", answer.margin);
  } else {
    print_text(answer);
  }
}

const std::vector<Question>& questions() {
  using B = Bearing;
  static const std::vector<Question> list = {
      {"rate",
       "Wear rate k",
       Quantity::rate,
       "m^3/(N m)",
       "m^3/(N m)",
       "the wear rate k from a measured depth",
       {&B::rate},
       "wearwell bearing rate --contact stationary --radius '20 mm' --clearance '20 um' \\\n"
       "    --depth '0.100 +- 0.005 mm' --pressure '1 MPa' --revolutions 1e5"},
      {"depth",
       "Wear depth d",
       Quantity::depth,
       "m",
       "mm",
       "the wear depth after so many revolutions",
       {&B::depth, &B::scar_width},
       "wearwell bearing depth --contact stationary --radius '10 mm' --clearance '20 um' \\\n"
       "    --rate '1e-16 m^3/(N m)' --pressure '2 MPa' --revolutions 1e6 --limit '20 um'"},
      {"pressure",
       "Allowable pressure p_a",
       Quantity::pressure,
       "Pa",
       "MPa",
       "the apparent pressure that wears no deeper than the depth",
       {&B::pressure, &B::force, &B::length},
       "wearwell bearing pressure --contact bushing --radius '10 mm' --clearance '20 um' \\\n"
       "    --depth '50 um' --rate '~ lognormal(1e-16 m^3/(N m), 2e-17 m^3/(N m))' \\\n"
       "    --speed '60 rpm' --time '5000 h'"},
      {"length",
       "Required length L",
       Quantity::length,
       "m",
       "mm",
       "the bearing length that a force needs to wear no deeper than the depth",
       {&B::pressure, &B::length},
       "wearwell bearing length --contact stationary --radius '10 mm' --clearance '20 um' \\\n"
       "    --depth '20 um' --rate '1e-16 m^3/(N m)' --force '800 N' --revolutions 1e6"},
      {"life",
       "Life",
       Quantity::revolutions,
       "rev",
       "revolutions",
       "how long until the depth is reached: in revolutions, or in time with --speed",
       {&B::revolutions, &B::time},
       "wearwell bearing life --contact journal --radius '10 mm' --clearance '20 um' \\\n"
       "    --depth '50 +- 5 um' --rate '1e-16 m^3/(N m) +- 10 %' --pressure '2 MPa' --speed '60 "
       "rpm'"},
  };
  return list;
}

}  // namespace

Told answer(const std::string& command, const Asked& asked) {
  std::vector<std::string> names;
  for (const Question& each : questions()) names.emplace_back(each.command);
  const auto question = std::find(names.begin(), names.end(), command);
  if (question == names.end()) throw std::logic_error("no question " + command);
  Options options;
  options.bearing.contact = asked.contact;
  std::vector<std::string> flags;
  for (const InputOption& each : input_options) flags.emplace_back(each.flag + 2);
  for (const auto& [name, text] : asked.inputs) {
    const auto flag = std::find(flags.begin(), flags.end(), name);
    if (flag == flags.end()) {
      throw InputError(fmt::format("a bearing has no '{}'{}: {}", name, did_you_mean(name, flags),
                                   fmt::join(flags, ", ")));
    }
    options.bearing.texts[static_cast<std::size_t>(flag - flags.begin())] = text;
  }
  options.unit = asked.unit;
  options.limit = asked.limit;
  options.draws = asked.draws;
  options.seed = asked.seed;
  const Answer told =
      answer_of(questions()[static_cast<std::size_t>(question - names.begin())], options);
  return {json_of(told), warnings(told), told.margin};
}

}  // namespace bearing

void add_bearing_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand(
      "bearing", "Journal bearings: wear rate, depth, allowable pressure, length and life");
  command->require_subcommand(1);
  for (const bearing::Question& question : bearing::questions()) {
    CLI::App* sub = command->add_subcommand(question.command, question.help);
    const auto options = std::make_shared<bearing::Options>();
    options->bearing.add_to(*sub, question.unused);
    sub->add_option("--unit", options->unit, "unit of the answer")->type_name("UNIT");
    if (question.wanted == bearing::Quantity::depth) {
      sub->add_option("--limit", options->limit, "allowable depth: states the margin to it")
          ->type_name("'NUMBER m'");
    }
    sub->add_option("--draws", options->draws, "random draws for the interval")
        ->type_name("N")
        ->capture_default_str();
    sub->add_option("--seed", options->seed, "seed of the draws")
        ->check(seed_number())
        ->type_name("N")
        ->capture_default_str();
    sub->add_flag("--json", options->json, "print one JSON object");
    sub->footer(fmt::format(
        "Every value has a unit, and may have an uncertainty, which then gives an interval:\n"
        "  '0.100 +- 0.005 mm' (standard deviation), '1 MPa +- 5 %',\n"
        "  '~ lognormal(0.1 mm, 0.005 mm)' (mean, standard deviation), '~ uniform(90 um, 110 "
        "um)',\n"
        "  '1e-16 m^3/(N m) x/ 2' (lognormal: two in three between half and twice that)\n\n"
        "Example:\n  {}",
        question.example));
    sub->callback([&question, options] { bearing::run(question, *options); });
  }
  bearing::add_chart_command(*command);
  bearing::add_profile_command(*command);
}

}  // namespace wearwell
