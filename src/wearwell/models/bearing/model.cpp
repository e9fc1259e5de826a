#include "wearwell/models/bearing/model.h"

#include "wearwell/models/bearing/bearing_first.h"
#include "wearwell/models/bearing/bearing_keys.h"
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
          .trade = "bearing",
          .example = example,
          .read =
              [](const TomlReader& root, const Source& source) {
                return read_posterior_study(root, source, read_bearing_study);
              },
          .keys = study_keys,
          .first_study = first_study,
          .track = track_bearings};
}

}  // namespace bearing
}  // namespace wearwell
