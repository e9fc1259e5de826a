#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "wearwell/study/scaffold.h"

namespace wearwell {

/// Whether a terminal is there to ask.
bool is_somebody_there();

/// Prints the question and reads a number; throws InputError if the input ends first.
std::size_t read_choice(const TableQuestion& question);

/// The error message: the question, and below it each reading with its command.
std::string as_refusal(const TableQuestion& question, const std::vector<std::string>& commands);

}  // namespace wearwell
