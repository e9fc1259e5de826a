#include "wearwell/models/fatigue/model.h"

#include "wearwell/models/fatigue/part_tracker.h"
#include "wearwell/models/fatigue/sn_first.h"
#include "wearwell/models/fatigue/sn_keys.h"
#include "wearwell/models/fatigue/sn_study.h"
#include "wearwell/models/fatigue/staircase_study.h"

namespace wearwell {
namespace resource {

std::string_view fatigue_study();
std::string_view fatigue_data();
std::string_view strain_study();
std::string_view strain_data();
std::string_view staircase_study();
std::string_view staircase_data();
std::string_view spectrum_study();
std::string_view spectrum_data();
std::string_view spectrum_loads();

}  // namespace resource

namespace fatigue {

namespace {

std::unique_ptr<const Study> read(const TomlReader& root, const Source& source) {
  return read_posterior_study(root, source, read_sn_study);
}

}  // namespace

Model model() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::fatigue_study},
                                            {"tests.csv", resource::fatigue_data}};
  return {.key = "sn",
          .preset = "fatigue",
          .example = example,
          .read = read,
          .keys = study_keys,
          .scaffold = scaffold,
          .track = track_parts};
}

Model staircase() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::staircase_study},
                                            {"tests.csv", resource::staircase_data}};
  return {.key = "staircase",
          .preset = "staircase",
          .example = example,
          .read =
              [](const TomlReader& root, const Source& source) {
                return read_posterior_study(root, source, read_staircase_study);
              },
          .keys = staircase_keys,
          .scaffold = first_staircase};
}

Model strain_life() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::strain_study},
                                            {"tests.csv", resource::strain_data}};
  return {.key = "sn",
          .preset = "strain-life",
          .example = example,
          .read = read,
          .scaffold = first_strain_study,
          .track = track_parts};
}

Model spectrum() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::spectrum_study},
                                            {"tests.csv", resource::spectrum_data},
                                            {"loads.csv", resource::spectrum_loads}};
  return {
      .key = "sn", .preset = "spectrum", .example = example, .read = read, .track = track_parts};
}

}  // namespace fatigue
}  // namespace wearwell
