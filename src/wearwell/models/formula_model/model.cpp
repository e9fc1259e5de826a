#include "wearwell/models/formula_model/model.h"

#include "wearwell/models/formula_model/formula_keys.h"
#include "wearwell/models/formula_model/formula_study.h"
#include "wearwell/models/formula_model/formula_tracker.h"
#include "wearwell/models/formula_model/life_scaffold.h"
#include "wearwell/models/formula_model/path_scaffold.h"
#include "wearwell/models/formula_model/response_scaffold.h"
#include "wearwell/models/formula_model/simulated_fleet.h"

namespace wearwell {
namespace resource {

std::string_view formula_study();
std::string_view formula_data();
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

namespace formula_model {

namespace {

using FirstOf = std::optional<Scaffold> (*)(ColumnRoles&);

Model preset_with(std::string_view preset, std::span<const ExampleFile> example,
                  FirstOf scaffold = nullptr) {
  return {.key = "formula",
          .preset = preset,
          .example = example,
          .read =
              [](const TomlReader& root, const Source& source) {
                return read_posterior_study(root, source, read_formula_study);
              },
          .keys = formula_keys,
          .scaffold = scaffold,
          .track = track_units};
}

// A table with a response is one of conditions, whatever else it measures.
std::optional<Scaffold> first_formula_study(ColumnRoles& roles) {
  return roles.has({"response"}) ? response_scaffold(roles) : wear_scaffold(roles);
}

// Computed on demand, with the same result at any time.
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
  static constexpr ExampleFile example[] = {{"study.toml", resource::formula_study},
                                            {"wear.csv", resource::formula_data}};
  return preset_with("formula", example, first_formula_study);
}

Model life() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::life_study},
                                            {"bearings.csv", resource::life_data}};
  return preset_with("life", example, first_life_study);
}

Model accelerated() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::accelerated_study},
                                            {"device_a.csv", resource::accelerated_data}};
  return preset_with("accelerated", example, first_accelerated_study);
}

Model degradation() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::degradation_study},
                                            {"laser.csv", resource::degradation_data}};
  return preset_with("degradation", example, first_degradation_study);
}

Model fleet() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::fleet_study},
                                            {"learned.csv", resource::fleet_data},
                                            {"monitor.toml", resource::fleet_monitor},
                                            {"readings.jsonl", fleet_readings},
                                            {"truth.csv", fleet_truth}};
  return preset_with("fleet", example);
}

}  // namespace formula_model
}  // namespace wearwell
