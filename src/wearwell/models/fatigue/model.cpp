#include "wearwell/models/fatigue/model.h"

#include "wearwell/models/fatigue/commands.h"
#include "wearwell/models/fatigue/sn_first.h"
#include "wearwell/models/fatigue/sn_keys.h"
#include "wearwell/models/fatigue/sn_study.h"

namespace wearwell {
namespace resource {

std::string_view fatigue_study();
std::string_view fatigue_data();

}  // namespace resource

namespace fatigue {

Model model() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::fatigue_study},
                                            {"tests.csv", resource::fatigue_data}};
  return {.key = "sn",
          .trade = "fatigue",
          .example = example,
          .read =
              [](const TomlReader& root, const Source& source) {
                return read_posterior_study(root, source, read_sn_study);
              },
          .add_commands = add_commands,
          .keys = study_keys,
          .first_study = first_study};
}

}  // namespace fatigue
}  // namespace wearwell
