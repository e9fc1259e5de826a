#include "wearwell/cli/bearing/bearing_options.h"

#include <fmt/format.h>

#include <algorithm>

namespace wearwell::bearing {

void add_inputs(CLI::App& command, BearingInputs& inputs, const std::vector<Input>& hidden) {
  command
      .add_option("--contact", inputs.contact, "Stationary, journal or bushing: which part wears")
      ->type_name("NAME");
  for (std::size_t i = 0; i < input_options.size(); ++i) {
    const InputOption& o = input_options[i];
    CLI::Option* added =
        command.add_option(o.flag, inputs.texts[i], o.help)
            ->type_name(may_be_plain(o.si) ? "NUMBER" : fmt::format("'NUMBER {}'", o.si));
    if (std::find(hidden.begin(), hidden.end(), o.input) != hidden.end()) added->group("");
  }
}

void print_row(const char* name, const std::string& value) {
  fmt::print("  {:<32}{}\n", name, value);
}

}  // namespace wearwell::bearing
