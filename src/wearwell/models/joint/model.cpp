#include "wearwell/models/joint/model.h"

#include "wearwell/models/joint/joint_keys.h"
#include "wearwell/models/joint/joint_scaffold.h"
#include "wearwell/models/joint/joint_study.h"
#include "wearwell/models/joint/joint_tracker.h"

namespace wearwell {
namespace resource {

std::string_view joint_study();
std::string_view joint_data();

}  // namespace resource

namespace joint {

Model model() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::joint_study},
                                            {"joint_wear.csv", resource::joint_data}};
  return {.key = "archard-joint",
          .preset = "joint",
          .example = example,
          .read =
              [](const TomlReader& root, const Source& source) {
                return read_posterior_study(root, source, read_joint_study);
              },
          .keys = study_keys,
          .scaffold = scaffold,
          .track = track_joint};
}

}  // namespace joint
}  // namespace wearwell
