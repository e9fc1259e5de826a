#include "wearwell/cli/bearing/bearing_commands.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <numbers>
#include <string>

#include "wearwell/base/printable.h"
#include "wearwell/cli/bearing/bearing_options.h"
#include "wearwell/cli/bearing/chart_command.h"
#include "wearwell/cli/bearing/profile_command.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/models/bearing/answer.h"
#include "wearwell/present/number.h"
#include "wearwell/present/plain.h"

namespace wearwell::bearing {
namespace {

using std::numbers::pi;

struct Options {
  Asked asked;
  bool json = false;
};

// Computed from exact inputs, not estimated: full digits without trailing zeros.
std::string digits(double x, int count) {
  return numbers_text(fmt::format("{:.{}g}", x, count), Script::terminal);
}

void print_text(const Answer& a) {
  const Solution& s = a.solution;
  fmt::print("{}: {} {}\n", a.question.title, digits(a.in_unit(s.value), 6), a.unit.text);
  if (a.interval) {
    fmt::print("{} {} (90 %), median {} ({} draws, seed {})\n",
               plain_range(a.in_unit(a.interval->q05), a.in_unit(a.interval->q95)), a.unit.text,
               plain_number(a.in_unit(a.interval->q50)), plain_given(a.draws), a.seed);
    if (a.is_life())
      fmt::print("B10 life: {} {}: one in ten reaches the depth before this time\n",
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
    print_row("center angle of the scar",
              fmt::format("{:.4g} deg", a.scar->centre_angle * 180 / pi));
  }
  if (const Bearing mean = a.given.mean(); a.question.wanted == Quantity::time)
    print_row("revolutions", digits(s.value * *mean.speed, 6));
  fmt::print(
      "\n"
      "Change of the {} when an input grows by 1 %:\n",
      a.question.command);
  std::size_t width = 0;
  for (const auto& g : a.given.given) width = std::max(width, g.value.text.size());
  for (const auto& g : a.given.given) {
    fmt::print("  {:<14}{:<{}}{:+.4g} %\n", g.option->flag + 2, g.value.text, width + 3,
               *(a.sensitivity.*(g.option->input)));
  }
  if (!a.margin.empty()) fmt::print("\n{}\n", a.margin);
}

void run(const Question& question, const Options& options) {
  const Answer found = answer(question, options.asked);
  for (const std::string& warning : warnings(found)) fmt::print(stderr, "warning: {}\n", warning);
  if (options.json) {
    fmt::print("{}\n", printable_json(to_json(found).dump(2)));
    if (!found.margin.empty()) fmt::print(stderr, "{}\n", found.margin);
  } else {
    print_text(found);
  }
}

}  // namespace

void add_bearing_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "bearing", "Journal bearings: wear rate, depth, allowable pressure, length and life");
  command->require_subcommand(1);
  for (const Question& question : questions()) {
    CLI::App* sub = command->add_subcommand(question.command, question.help);
    const auto options = std::make_shared<Options>();
    add_inputs(*sub, options->asked.inputs, question.unused);
    sub->add_option("--unit", options->asked.unit, "Unit of the answer")->type_name("UNIT");
    if (question.wanted == Quantity::depth) {
      sub->add_option("--limit", options->asked.limit, "Allowable depth: reports the margin to it")
          ->type_name("'NUMBER m'");
    }
    sub->add_option("--draws", options->asked.draws, "Random draws for the interval")
        ->type_name("N")
        ->capture_default_str();
    sub->add_option("--seed", options->asked.seed, "Seed of the draws")
        ->check(seed_number())
        ->type_name("N")
        ->capture_default_str();
    sub->add_flag("--json", options->json, "Print one JSON object");
    sub->footer(fmt::format(
        "Every value has a unit. An uncertainty gives the answer an interval:\n"
        "  '0.100 +- 0.005 mm' (standard deviation), '1 MPa +- 5 %',\n"
        "  '~ lognormal(0.1 mm, 0.005 mm)' (mean, standard deviation), '~ uniform(90 um, 110 "
        "um)',\n"
        "  '1e-16 m^3/(N m) x/ 2' (lognormal: two thirds lie between half and twice the median)\n\n"
        "Example:\n"
        "  {}",
        question.example));
    sub->callback([&question, options] { run(question, *options); });
  }
  add_chart_command(*command);
  add_profile_command(*command);
}

}  // namespace wearwell::bearing
