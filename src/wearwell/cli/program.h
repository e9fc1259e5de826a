#pragma once

#include "wearwell/study/model.h"

namespace wearwell {

/// The program `wearwell` with these models: reads the command line, does what it asks, and returns
/// the exit code. Standard output is flushed, and whether all of it arrived is part of the answer.
int run_program(int argc, char** argv, Models models);

}  // namespace wearwell
