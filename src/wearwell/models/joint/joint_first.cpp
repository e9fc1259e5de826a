#include "wearwell/models/joint/joint_first.h"

#include <fmt/format.h>

#include <algorithm>

namespace wearwell::joint {

std::optional<FirstStudy> first_study(const Table& table, const std::string& file) {
  HeadingGuesses headings(table);
  const auto volume =
      headings.take("volume", "m^3", "mm^3",
                    {"worn volume", "wear volume", "volume loss", "volume", "verschleissvolumen",
                     "verschleißvolumen", "volumen", "usure"});
  const auto cycles = headings.take("cycles", "cycle", "1",
                                    {"cycles", "cycle", "number of cycles", "zyklen", "zyklus",
                                     "lastwechsel", "hübe", "strokes", "cicli", "n"});
  if (!volume || !cycles) return {};
  const auto work =
      headings.take("work", "N m", "J",
                    {"friction work", "work", "energy", "reibarbeit", "reibungsarbeit", "arbeit"});
  auto force = work ? std::nullopt
                    : headings.take("force", "N", "N",
                                    {"normal force", "force", "load", "kraft", "normalkraft",
                                     "charge", "carico"});
  auto slip =
      force ? headings.take("slip", "m", "m",
                            {"sliding distance", "slip", "distance", "gleitweg", "weg", "path"})
            : std::nullopt;
  std::string columns =
      HeadingGuesses::line("cycles", *cycles) + HeadingGuesses::line("volume", *volume);
  if (work) columns += HeadingGuesses::line("work", *work);
  if (force && slip)
    columns += HeadingGuesses::line("force", *force) + HeadingGuesses::line("slip", *slip);
  std::string conditions;
  if (!work && !slip) {
    conditions = "\n[conditions]\n" +
                 headings.unstated_line("work_per_cycle",
                                        "friction work of one cycle, force times slip", "5 N m");
  }
  const auto values = values_of(*cycles->column);
  const double last = values.empty() ? 1 : *std::max_element(values.begin(), values.end());
  return headings.study(fmt::format(
      "title = {0}\n"
      "model = \"archard-joint\"\n\n"
      "[data]\nfile = {1}\n[data.columns]\n{2}{3}\n"
      "[likelihood]\nfamily = \"normal\"\n\n"
      "# Without [prior] weak defaults hold (docs/priors.md). What you know of k makes a better "
      "answer:\n"
      "# [prior]\n# k = {{ law = \"lognormal\", median = \"1e-5 mm^3/(N m)\", log_sd = 2 }}\n\n"
      "[predict]\n{4}",
      toml_text("Wear of a joint, from " + file), toml_text(file), columns, conditions,
      slip || work
          ? "# work_per_cycle = \"5 N m\"             # of cycles to come: then cycles = [...] and "
            "limit = \"...\"\n"
          : fmt::format("cycles = [{:.0f}]{}\n# limit = \"100 mm^3\"                  # when is it "
                        "reached?\n"
                        "# risk  = \"1 %\"                       # and when to inspect again\n",
                        2 * last, "                         # twice what was run")));
}

}  // namespace wearwell::joint
