#pragma once

#include <filesystem>
#include <string>

#include "wearwell/models/fatigue/load_history.h"

namespace wearwell::fatigue {

/// A partly counted history to continue from, with its signal. Writing and reading is lossless.
struct SavedHistory {
  std::string column, unit;
  LoadHistory::State state;
};

std::string state_text(const SavedHistory& saved);
/// Throws InputError that names the file and the missing or invalid part.
SavedHistory read_history_state(const std::filesystem::path& file);

/// "three-point", "four-point"; "half", "repeat".
const char* counting_name(Counting counting);
const char* residual_name(Residual residual);

}  // namespace wearwell::fatigue
