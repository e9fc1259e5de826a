#include "wearwell/models/recurrence/model.h"

#include "wearwell/models/recurrence/recurrence_keys.h"
#include "wearwell/models/recurrence/recurrence_scaffold.h"
#include "wearwell/models/recurrence/recurrence_study.h"

namespace wearwell {
namespace resource {

std::string_view repairable_study();
std::string_view repairable_data();

}  // namespace resource

namespace recurrence {

Model model() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::repairable_study},
                                            {"valve_seats.csv", resource::repairable_data}};
  return {.key = "repairable",
          .preset = "repairable",
          .example = example,
          .read =
              [](const TomlReader& root, const Source& source) {
                return read_posterior_study(root, source, read_recurrence_study);
              },
          .keys = study_keys,
          .scaffold = scaffold};
}

}  // namespace recurrence
}  // namespace wearwell
