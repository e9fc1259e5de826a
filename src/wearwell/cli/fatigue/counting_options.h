#pragma once

#include <string>

#include "wearwell/models/fatigue/counting_choice.h"

namespace CLI {
class App;
}

namespace wearwell::fatigue {

/// --column, --unit, --method and --residual. `of_signal` precedes the help of options that apply
/// to signals only.
void add_counting_options(CLI::App& command, CountingChoice& options, const std::string& of_signal);

}  // namespace wearwell::fatigue
