#include "wearwell/models/ownlaw/model.h"

#include "wearwell/models/ownlaw/life_first.h"
#include "wearwell/models/ownlaw/own_keys.h"
#include "wearwell/models/ownlaw/own_study.h"
#include "wearwell/models/ownlaw/own_tracker.h"
#include "wearwell/models/ownlaw/path_first.h"
#include "wearwell/models/ownlaw/simulated_fleet.h"

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
std::string_view fleet_study();
std::string_view fleet_data();
std::string_view fleet_monitor();

}  // namespace resource

namespace ownlaw {

namespace {

using FirstOf = std::optional<FirstStudy> (*)(ColumnRoles&);

Model law_with(std::string_view trade, std::span<const ExampleFile> example,
               FirstOf first_study = nullptr) {
  return {.key = "law",
          .trade = trade,
          .example = example,
          .read =
              [](const TomlReader& root, const Source& source) {
                return read_posterior_study(root, source, read_law_study);
              },
          .keys = law_keys,
          .first_study = first_study,
          .track = track_units};
}

// Made when they are wanted: the same whenever that is.
const SimulatedFleet& fleet_of_example() {
  static const SimulatedFleet fleet = simulate_fleet(1, 200);
  return fleet;
}
std::string_view fleet_readings() {
  static const std::string text = readings_jsonl(fleet_of_example());
  return text;
}
std::string_view fleet_truth() {
  static const std::string text = truth_csv(fleet_of_example());
  return text;
}

}  // namespace

Model model() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::law_study},
                                            {"wear.csv", resource::law_data}};
  return law_with("law", example, first_wear_study);
}

Model life() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::life_study},
                                            {"bearings.csv", resource::life_data}};
  return law_with("life", example, first_life_study);
}

Model accelerated() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::accelerated_study},
                                            {"device_a.csv", resource::accelerated_data}};
  return law_with("accelerated", example, first_accelerated_study);
}

Model degradation() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::degradation_study},
                                            {"laser.csv", resource::degradation_data}};
  return law_with("degradation", example, first_degradation_study);
}

Model fleet() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::fleet_study},
                                            {"learned.csv", resource::fleet_data},
                                            {"monitor.toml", resource::fleet_monitor},
                                            {"readings.jsonl", fleet_readings},
                                            {"truth.csv", fleet_truth}};
  return law_with("fleet", example);
}

}  // namespace ownlaw
}  // namespace wearwell
