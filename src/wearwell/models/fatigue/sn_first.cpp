#include "wearwell/models/fatigue/sn_first.h"

#include <fmt/format.h>

#include "wearwell/study/column_values.h"

namespace wearwell::fatigue {
namespace {

using Found = std::optional<ColumnRoles::Found>;

// Columns of all tests: lives, outcomes, numbers of equal tests; into `columns`.
bool take_lives(ColumnRoles& roles, std::string& columns) {
  const Found life = roles.take("life", {"life", "cycles"});
  if (!life || life->si != "cycle") return false;
  columns += ColumnRoles::line("life", *life);
  const auto status = roles.take_status(true);
  if (status) columns += *status;
  if (const Found count = roles.take("count", {"count"}))
    columns += ColumnRoles::line("count", *count);
  if (const Found label = roles.take("label", {"label"}))
    columns += ColumnRoles::line("label", *label);
  if (has_open_ends(*life->column)) {
    roles.taken.push_back(
        fmt::format("status: '>' in column '{}' is a run-out", life->column->name));
  } else if (!status) {
    roles.guesses.emplace_back(
        "no column tells which tests were stopped unbroken: all count as failures");
  }
  return true;
}

// Without lives in the table there is no S-N curve.
bool has_lives(const ColumnRoles& roles) {
  const Found life = roles.find({"life", "cycles"});
  return life && life->si == "cycle";
}

constexpr const char* asked =
    "types = \"all\"                            # lives under every tested stress\n";

}  // namespace

std::optional<Scaffold> scaffold(ColumnRoles& roles) {
  const bool extremes = roles.has({"max_stress"}) && roles.has({"min_stress"});
  if (!has_lives(roles) || !(extremes || roles.has({"alternating_stress"}))) return {};
  std::string columns;
  bool means = extremes;
  if (extremes) {
    columns = ColumnRoles::line("max_stress", *roles.take("max_stress", {"max_stress"})) +
              ColumnRoles::line("min_stress", *roles.take("min_stress", {"min_stress"}));
  } else {
    const Found amplitude = roles.take("alternating_stress", {"alternating_stress"});
    const Found mean = roles.take("mean_stress", {"mean_stress"});
    const Found ratio = mean ? std::nullopt : roles.take("stress_ratio", {"stress_ratio"});
    columns = ColumnRoles::line("alternating_stress", *amplitude);
    if (mean) columns += ColumnRoles::line("mean_stress", *mean);
    if (ratio) columns += ColumnRoles::line("stress_ratio", *ratio);
    means = (mean && differs(roles.table(), *mean->column)) ||
            (ratio && differs(roles.table(), *ratio->column));
  }
  if (!take_lives(roles, columns)) return {};

  return roles.study(
      "S-N curve: cycles to failure under stresses", ReadingFit::specific,
      fmt::format(
          "title = {}\n"
          "model = \"sn\"\n\n"
          "{}[data.columns]\n"
          "{}\n"
          "[law]                                   # the simplest curve: Basquin's; others: curve "
          "= \"knee\", fatigue_limit = \"random\" (docs/reference/fatigue.md)\n"
          "mean_stress = \"{}\"{}\n\n"
          "# Without [prior] weak defaults apply (docs/reference/priors.md). Replace them with "
          "what you know:\n"
          "# [prior]\n"
          "# b = {{ distribution = \"normal\", mean = -0.1, sd = 0.03 }}\n"
          "{}\n"
          "[predict]\n"
          "{}# b_lives = [1, 10]                       # lives at which 1 and 10 % have failed\n"
          "# required_life = \"1e6 cycles\"            # adds the allowable alternating stress\n"
          "# reliability = [\"90 %\"]                  # at which this share outlasts the life\n",
          toml_text("S-N curve, from " + roles.file()), roles.data_section(), columns,
          means ? "goodman" : "none",
          means ? "                   # or gerber, soderberg, morrow, swt, walker, none"
                : "                      # all tests at one mean stress or ratio",
          means ? "# log10_Sut = { distribution = \"normal\", mean = \"3 log10(MPa)\", sd = 0.02 } "
                  "   # "
                  "strength from a tensile test\n"
                : "",
          asked));
}

std::optional<Scaffold> first_strain_study(ColumnRoles& roles) {
  if (!has_lives(roles) || !roles.has({"strain"})) return {};
  const Found strain = roles.take("alternating_stress", {"strain"});
  std::string columns = ColumnRoles::line("alternating_stress", *strain);
  if (!take_lives(roles, columns)) return {};
  return roles.study(
      "strain-life curve: cycles to failure under strains", ReadingFit::specific,
      fmt::format(
          "title = {}\n"
          "model = \"sn\"\n\n"
          "{}[data.columns]    # alternating_stress holds the strain amplitude\n"
          "{}\n"
          "[law]\n"
          "mean_stress = \"none\"\n"
          "curve = \"strain-life\"                   # sigma_f'/E (2N)^b + eps_f' (2N)^c\n\n"
          "# Without [prior] weak defaults for metals apply (docs/reference/priors.md).\n\n"
          "[predict]\n"
          "{}",
          toml_text("Strain-life curve, from " + roles.file()), roles.data_section(), columns,
          asked));
}

std::optional<Scaffold> first_staircase(ColumnRoles& roles) {
  if (!roles.has({"alternating_stress"}) || roles.has({"life", "cycles", "time"})) return {};
  const Found stress = roles.take("alternating_stress", {"alternating_stress"});
  const auto status = roles.take_status(true);
  if (!status) return {};
  std::string columns = ColumnRoles::line("alternating_stress", *stress) + *status;
  if (const Found count = roles.take("count", {"count"}))
    columns += ColumnRoles::line("count", *count);
  return roles.study(
      "fatigue limit: failures and run-outs under stresses", ReadingFit::specific,
      fmt::format("title = {}\n"
                  "model = \"staircase\"\n\n"
                  "{}[data.columns]\n"
                  "{}\n"
                  "# Without [prior] weak defaults apply (docs/reference/priors.md).\n\n"
                  "[predict]\n"
                  "reliability    = [\"50 %\", \"90 %\"]        # adds the stress that this share "
                  "survives\n"
                  "credible_level = 0.9                     # of the lower bound\n",
                  toml_text("Fatigue limit, from " + roles.file()), roles.data_section(), columns));
}

}  // namespace wearwell::fatigue
