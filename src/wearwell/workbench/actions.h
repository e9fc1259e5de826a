#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "wearwell/base/error.h"
#include "wearwell/http/target.h"
#include "wearwell/workbench/session.h"

namespace wearwell::workbench {

/// What the page can ask for and do: functions on a session, by path. Each returns JSON and throws
/// InputError.
using Json = nlohmann::ordered_json;

/// {version, folder, files, table, table_number, workbook, study, result, reading, fit}: what is open. `table`:
/// its file. `workbook`: a file whose sheet is still to be chosen.
Json session_json(Session& session);

/// The answer to a GET; null if there is no such path.
using Look = Json (*)(Session& session, const HttpTarget& target);
Look look_of(std::string_view path);

/// The answer to a POST of JSON; null if there is no such path.
using Action = Json (*)(Session& session, const nlohmann::json& wish);
Action action_of(std::string_view path);

/// Writes `bytes` as a new file of the folder, and opens it; `wish` as of `open_file`. A file with other
/// content stays, and is an error. A new file that cannot be read as a table is removed; one whose
/// reading is stopped stays.
Json upload(Session& session, const nlohmann::json& wish, std::string bytes);

/// Opens a study or a result of the folder, or begins to read a table (workbench/table_reading.h).
Json open_file(Session& session, const nlohmann::json& wish);

/// A file has changed since the page read it, or another table or result has been opened.
struct Conflict : InputError {
  using InputError::InputError;
};

}  // namespace wearwell::workbench
