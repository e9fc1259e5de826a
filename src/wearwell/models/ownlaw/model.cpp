#include "wearwell/models/ownlaw/model.h"

#include "wearwell/models/ownlaw/own_keys.h"
#include "wearwell/models/ownlaw/own_study.h"
#include "wearwell/models/ownlaw/own_tracker.h"

namespace wearwell {
namespace resource {

std::string_view law_study();
std::string_view law_data();
std::string_view life_study();
std::string_view life_data();
std::string_view accelerated_study();
std::string_view accelerated_data();
std::string_view degradation_study();
std::string_view degradation_data();

}  // namespace resource

namespace ownlaw {

namespace {

Model law_with(std::string_view trade, std::span<const ExampleFile> example) {
  return {.key = "law",
          .trade = trade,
          .example = example,
          .read =
              [](const TomlReader& root, const Source& source) {
                return read_posterior_study(root, source, read_law_study);
              },
          .add_commands = nullptr,
          .keys = law_keys,
          .track = track_units};
}

}  // namespace

Model model() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::law_study},
                                            {"wear.csv", resource::law_data}};
  return law_with("law", example);
}

Model life() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::life_study},
                                            {"bearings.csv", resource::life_data}};
  return law_with("life", example);
}

Model accelerated() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::accelerated_study},
                                            {"device_a.csv", resource::accelerated_data}};
  return law_with("accelerated", example);
}

Model degradation() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::degradation_study},
                                            {"laser.csv", resource::degradation_data}};
  return law_with("degradation", example);
}

}  // namespace ownlaw
}  // namespace wearwell
