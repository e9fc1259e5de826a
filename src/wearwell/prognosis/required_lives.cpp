#include "wearwell/prognosis/required_lives.h"

#include <fmt/format.h>

#include "wearwell/base/error.h"

namespace wearwell::prognosis {

std::vector<NamedLife> required_lives(const PosteriorStudy& study, const std::string& title) {
  std::vector<NamedLife> lives = named_lives(study);
  if (!lives.empty()) return lives;
  if (study.model == "repairable")
    throw InputError(fmt::format(
        "{}: this study counts the failures of units that are repaired, and has no life of a new "
        "unit. Failures to come, for spare parts and costs, with their interval: [predict] next = "
        "[\"1 year\"] in the study. Replacement ages, warranties and comparisons need lives of the "
        "parts that a repair replaces: a study of these lives (model \"formula\"), or a table with "
        "the column 'life [h]'",
        title));
  throw InputError(fmt::format(
      "{}: the study has no life of a new unit; state one under [predict] (of wear or degradation "
      "a failure threshold, limit)",
      title));
}

}  // namespace wearwell::prognosis
