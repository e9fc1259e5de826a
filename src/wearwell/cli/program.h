#pragma once

#include "wearwell/study/model.h"

namespace wearwell {

/// The program `wearwell` with these models: reads the command line, runs the command and returns
/// the exit code. Flushes standard output; incomplete output is an error.
int run_program(int argc, char** argv, Models models);

}  // namespace wearwell
