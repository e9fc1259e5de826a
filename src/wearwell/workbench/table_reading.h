#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "wearwell/workbench/session.h"

namespace wearwell::workbench {

/// Reads a table of the folder on its own thread, so that the page goes on meanwhile. It replaces a
/// reading that has not ended. Returns {kind: "table", table} or {kind: "sheets", file, sheets} if
/// that takes no longer than `Session::patience`, and then throws why it cannot be read; otherwise
/// {kind: "reading", file, number, lines}, the first lines as they stand in a file of text, and
/// `Session::read` has the end. `refused` is called if the table cannot be read.
nlohmann::ordered_json start_reading(Session& session, const std::string& file,
                                     const std::map<std::string, std::string>& settings,
                                     std::function<void()> refused = {});

/// Asks the reading to stop; the table before it stays open.
void stop_reading(Session& session);

/// {state, file, number, seconds, sheets, problem}. The caller holds the session's mutex.
nlohmann::ordered_json reading_json(const ReadProgress& read);

}  // namespace wearwell::workbench
