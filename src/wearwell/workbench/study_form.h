#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "wearwell/study/model.h"

namespace wearwell::workbench {

/// A study's text as a form, and its check. {keys: [{path, value, text, line, meaning, example}], formulas (formulas_view.h),
/// and either description, what `wearwell check` prints, or problem with line and column where the
/// message names them}. `text`: whether the value is a text, shown without its quotes. A text that
/// is not TOML has no keys. `file`: where the study stands or will stand; tables are beside it.
nlohmann::ordered_json checked_study(const std::filesystem::path& file, const std::string& text,
                                     Models models);

/// The form without the check, which reads the tables: keys, or the problem of a text that is not TOML.
nlohmann::ordered_json study_form(const std::filesystem::path& file, const std::string& text,
                                  Models models);

/// The value of a key as the form shows it. Throws InputError if the study has no such key.
std::string value_of(const std::string& text, const std::string& path);

/// The text with another value of a key, everything else as it was. `value` is TOML; of a key whose
/// value is a text it is the text itself. Throws InputError if the study has no such key, or if the
/// value changes other keys.
std::string with_value(const std::string& text, const std::string& path, const std::string& value);

}  // namespace wearwell::workbench
