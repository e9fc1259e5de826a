#include "wearwell/cli/fatigue/counting_options.h"

#include <CLI/CLI.hpp>
#include "wearwell/cli/option_rules.h"

namespace wearwell::fatigue {

void add_counting_options(CLI::App& command, CountingChoice& options,
                          const std::string& of_signal) {
  command.add_option("--column", options.signal.column,
                     of_signal + "Heading of the load (default: the only numeric column)");
  command.add_option("--unit", options.signal.unit, "Unit of the load, if its heading has none");
  command.add_option("--method", options.method, of_signal + "How cycles are found")
      ->check(one_of({"three-point", "four-point"}))
      ->capture_default_str();
  command
      .add_option("--residual", options.residual,
                  "Unclosed ranges count as half cycles, or the history is repeated")
      ->check(one_of({"half", "repeat"}))
      ->capture_default_str();
}

}  // namespace wearwell::fatigue
