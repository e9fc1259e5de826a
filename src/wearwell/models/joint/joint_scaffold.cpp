#include "wearwell/models/joint/joint_scaffold.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/study/column_values.h"

namespace wearwell::joint {

std::optional<Scaffold> scaffold(ColumnRoles& roles) {
  if (!roles.has({"volume"}) || !roles.has({"cycles"})) return {};
  const auto volume = roles.take("volume", {"volume"});
  const auto cycles = roles.take("cycles", {"cycles"});
  const auto work = roles.take("work", {"work"});
  const auto force = work ? std::nullopt : roles.take("force", {"force"});
  const auto slip = force ? roles.take("slip", {"distance"}) : std::nullopt;
  roles.refuse_status();
  std::string columns = ColumnRoles::line("cycles", *cycles) + ColumnRoles::line("volume", *volume);
  if (work) columns += ColumnRoles::line("work", *work);
  if (force && slip)
    columns += ColumnRoles::line("force", *force) + ColumnRoles::line("slip", *slip);
  std::string conditions;
  if (!work && !slip) {
    conditions = "\n[conditions]\n" +
                 roles.unstated_line("work_per_cycle",
                                     "friction work of one cycle, force times slip", "5 N m");
  }
  const auto values = values_of(roles.table(), *cycles->column);
  const double last = values.empty() ? 1 : *std::max_element(values.begin(), values.end());
  return roles.study(
      "wear of a joint: worn volume against cycles", ReadingFit::specific,
      fmt::format(
          "title = {0}\n"
          "model = \"archard-joint\"\n\n"
          "{1}[data.columns]\n"
          "{2}{3}\n"
          "[likelihood]\n"
          "family = \"normal\"\n\n"
          "# Without [prior] weak defaults apply (docs/reference/priors.md). Replace them with "
          "what you know of k:\n"
          "# [prior]\n"
          "# k = {{ distribution = \"lognormal\", median = \"1e-5 mm^3/(N m)\", log_sd = 2 }}\n\n"
          "[predict]\n"
          "{4}",
          toml_text("Wear of a joint, from " + roles.file()), roles.data_section(), columns,
          conditions,
          slip || work
              ? "# work_per_cycle = \"5 N m\"             # of future cycles: needed for cycles = "
                "[...] and limit = \"...\"\n"
              : fmt::format(
                    "cycles = [{:.0f}]{}\n"
                    "# limit = \"100 mm^3\"                  # failure threshold: adds the life\n"
                    "# risk  = \"1 %\"                       # adds the time of the next "
                    "inspection\n",
                    2 * last, "                         # twice the largest in the data")));
}

}  // namespace wearwell::joint
