#pragma once

#include "wearwell/study/model.h"

namespace wearwell {

/// The program `wearwell` with these models: reads the command line, runs the command, and returns
/// the exit code: 0 done, 1 done but not trusted, 2 the request or the data is wrong, 3 the machine
/// failed. It throws nothing. Standard output is flushed; output that is lost is a failure of the
/// machine.
int run_program(int argc, char** argv, Models models);

}  // namespace wearwell
