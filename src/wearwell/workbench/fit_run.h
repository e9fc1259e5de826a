#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "wearwell/workbench/session.h"

namespace wearwell::workbench {

/// Runs a study of the folder on its own thread and writes STUDY-results beside it, as `wearwell
/// fit` does. `accept` gets the text that will be fitted, and throws to refuse it. Throws InputError
/// if a run has not ended or the name is not a study of the folder; later problems are in
/// `Session::fit`.
void start_fit(Session& session, const std::string& study,
               const std::function<void(const std::string&)>& accept);

/// Asks the run to stop; nothing is written then.
void stop_fit(Session& session);

/// The caller holds the session's mutex.
nlohmann::ordered_json progress_json(const FitProgress& fit);

}  // namespace wearwell::workbench
