#include "wearwell/models/bearing/model.h"

#include "wearwell/models/bearing/bearing_keys.h"
#include "wearwell/models/bearing/bearing_scaffold.h"
#include "wearwell/models/bearing/bearing_study.h"
#include "wearwell/models/bearing/bearing_tracker.h"

namespace wearwell {
namespace resource {

std::string_view bearing_study();
std::string_view bearing_data();

}  // namespace resource

namespace bearing {

Model model() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::bearing_study},
                                            {"inspections.csv", resource::bearing_data}};
  return {.key = "bearing-wear",
          .preset = "bearing",
          .example = example,
          .read =
              [](const TomlReader& root, const Source& source) {
                return read_posterior_study(root, source, read_bearing_study);
              },
          .keys = study_keys,
          .scaffold = scaffold,
          .track = track_bearings};
}

}  // namespace bearing
}  // namespace wearwell
