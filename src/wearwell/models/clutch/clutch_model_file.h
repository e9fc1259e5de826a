#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "wearwell/models/clutch/cycle_sum.h"
#include "wearwell/models/clutch/wear_model.h"

namespace wearwell::clutch {

/// model.json (docs/reference/clutch.md): everything in SI, temperatures in degrees Celsius.
/// Writing and reading is lossless.
nlohmann::ordered_json to_json(const WearModel& model);
/// Throws InputError that names the file and the missing or invalid part.
WearModel read_model(const std::filesystem::path& file);
/// The same for its text; `name` stands in messages.
WearModel read_model_text(const std::string& text, const std::filesystem::path& name);

/// With its SHA-1. Throws as read_model does, and if the model is not in a file.
struct IdentifiedModel {
  WearModel model;
  std::string id;
};
IdentifiedModel read_identified_model(const std::filesystem::path& path);

/// Partly worn plates, to continue from; `model` is the SHA-1 of the model file.
std::string state_text(const std::vector<PlateWear>& plates, const std::string& model);
/// Throws InputError if the file is not a state, belongs to another model, or was made with another
/// number of replicates.
std::vector<PlateWear> read_state(const std::filesystem::path& file, const std::string& model,
                                  std::size_t replicates);

}  // namespace wearwell::clutch
