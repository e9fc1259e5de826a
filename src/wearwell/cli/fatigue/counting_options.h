#pragma once

#include <string>

#include "wearwell/models/fatigue/load_history.h"
#include "wearwell/models/fatigue/signal_file.h"

namespace CLI {
class App;
}

namespace wearwell::fatigue {

/// A signal and the counting method, from the options.
struct CountingOptions {
  SignalChoice signal;
  std::string method = "four-point", residual = "half";

  CountingRule rule(double class_width = 0) const;
};

/// --column, --unit, --method and --residual. `of_signal` precedes the help of options that apply
/// to signals only.
void add_counting_options(CLI::App& command, CountingOptions& options,
                          const std::string& of_signal);

}  // namespace wearwell::fatigue
