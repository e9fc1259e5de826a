#include "wearwell/models/fatigue/sn_first.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wearwell::fatigue {
namespace {

using Found = std::optional<HeadingGuesses::Found>;

bool differs(const HeadingGuesses::Found& found) {
  const auto values = values_of(*found.column);
  return !values.empty() && *std::max_element(values.begin(), values.end()) -
                                    *std::min_element(values.begin(), values.end()) >
                                1e-9 * std::abs(values.front());
}

}  // namespace

std::optional<FirstStudy> first_study(const Table& table, const std::string& file) {
  HeadingGuesses headings(table);
  // The extremes and the mean first: the plain word "stress" is part of their names.
  const Found lowest = headings.take("min_stress", "Pa", "MPa",
                                     {"min stress", "minimum stress", "lower stress", "stress min",
                                      "smin", "s min", "unterspannung", "sigma min", "sigma u"});
  const Found highest = headings.take("max_stress", "Pa", "MPa",
                                      {"max stress", "maximum stress", "upper stress", "stress max",
                                       "smax", "s max", "oberspannung", "sigma max", "sigma o"});
  const Found mean = headings.take("mean_stress", "Pa", "MPa",
                                   {"mean stress", "stress mean", "mittelspannung", "sm", "s m",
                                    "sigma m", "contrainte moyenne"});
  const Found ratio = headings.take(
      "stress_ratio", "1", "1", {"stress ratio", "r ratio", "r", "spannungsverhältnis", "ratio"});
  const Found amplitude = headings.take(
      "alternating_stress", "Pa", "MPa",
      {"stress amplitude", "alternating stress", "amplitude", "spannungsamplitude", "sa", "s a",
       "sigma a", "ausschlagspannung", "stress", "spannung", "contrainte", "tensione", "s"});
  const Found life = headings.take(
      "life", "cycle", "1",
      {"cycles to failure", "life", "lives", "cycles", "cycle", "bruchlastspielzahl",
       "schwingspielzahl", "lastspiele", "lastwechsel", "zyklen", "nf", "n f", "n", "cicli"});
  const bool extremes = highest && lowest;
  if (!life || !(extremes || amplitude)) return {};
  const Found status = headings.take("status", "1", "1",
                                     {"status", "outcome", "result", "runout", "run out",
                                      "durchläufer", "censored", "failure", "failed", "bruch"},
                                     false);
  const Found count = headings.take("count", "1", "1", {"count", "number of specimens", "anzahl"});
  const Found label = headings.take(
      "label", "1", "1", {"type", "series", "batch", "material", "typ", "charge", "serie"}, false);

  std::string columns;
  bool means = false;
  if (extremes) {
    columns =
        HeadingGuesses::line("max_stress", *highest) + HeadingGuesses::line("min_stress", *lowest);
    means = true;
  } else {
    columns = HeadingGuesses::line("alternating_stress", *amplitude);
    if (mean) columns += HeadingGuesses::line("mean_stress", *mean);
    if (!mean && ratio) columns += HeadingGuesses::line("stress_ratio", *ratio);
    means = (mean && differs(*mean)) || (!mean && ratio && differs(*ratio));
  }
  columns += HeadingGuesses::line("life", *life);
  if (status) columns += HeadingGuesses::line("status", *status);
  if (count) columns += HeadingGuesses::line("count", *count);
  if (label) columns += HeadingGuesses::line("label", *label);
  if (!status)
    headings.guesses.emplace_back(
        "no column says which tests were stopped unbroken: all count as failures");

  return headings.study(fmt::format(
      "title = {}\n"
      "model = \"sn\"\n\n"
      "[data]\nfile = {}\n[data.columns]\n{}\n"
      "[law]\nmean_stress = \"{}\"{}\n\n"
      "# Without [prior] weak defaults hold (docs/priors.md). What you know makes a better "
      "answer:\n"
      "# [prior]\n# b = {{ law = \"normal\", mean = -0.1, sd = 0.03 }}\n{}\n"
      "[predict]\n"
      "{}# b_lives = [1, 10]                       # when 1 and 10 % have failed\n"
      "# required_life = \"1e6 cycles\"            # which alternating stress lets\n"
      "# reliability = [\"90 %\"]                  # such a share outlast that?\n",
      toml_text("S-N curve, from " + file), toml_text(file), columns, means ? "goodman" : "none",
      means ? "                   # or gerber, soderberg, morrow, swt, walker, none"
            : "                      # all tests at one mean stress or ratio",
      means ? "# log10_Sut = { law = \"normal\", mean = \"3 log10(MPa)\", sd = 0.02 }    # the "
              "strength of a tensile test\n"
            : "",
      "types = \"all\"                            # lives under every stress that was tested\n"));
}

}  // namespace wearwell::fatigue
