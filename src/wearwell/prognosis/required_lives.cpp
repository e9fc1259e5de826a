#include "wearwell/prognosis/required_lives.h"

#include <fmt/format.h>

#include "wearwell/base/error.h"

namespace wearwell::prognosis {

std::vector<NamedLife> required_lives(const PosteriorStudy& study, const std::string& title) {
  std::vector<NamedLife> lives = named_lives(study);
  if (!lives.empty()) return lives;
  refuse_repairable(study, title);
  throw InputError(fmt::format(
      "{}: the study has no life of a new unit; state one under [predict] (of wear or degradation "
      "a failure threshold, limit)",
      title));
}

void refuse_repairable(const PosteriorStudy& study, const std::string& title) {
  if (study.model != "repairable") return;
  throw InputError(fmt::format(
      "{}: this study counts the failures of units that are repaired, and has no life of a new "
      "unit. Write [predict] next = [\"1 year\"] in the study, and wearwell fit STUDY reports the "
      "failures to come with their interval, for spare parts and costs, and the time to the next "
      "failure. Replacement ages, warranties and comparisons need lives of the parts that a repair "
      "replaces: wearwell new life --from TABLE writes a study of these lives, and wearwell decide "
      "also takes a table with the column 'life [h]'",
      title));
}

}  // namespace wearwell::prognosis
