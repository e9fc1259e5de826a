#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "wearwell/models/bearing/bearing_inputs.h"

namespace wearwell::bearing {

/// Adds --contact and the inputs. Options in `hidden` are parsed so that they can be refused with a
/// reason, but help does not show them. `inputs` must outlive the command.
void add_inputs(CLI::App& command, BearingInputs& inputs, const std::vector<Input>& hidden = {});

/// One line of an answer.
void print_row(const char* name, const std::string& value);

}  // namespace wearwell::bearing
