#pragma once

#include <CLI/CLI.hpp>
#include <memory>

#include "wearwell/study/model.h"

namespace wearwell {

/// All commands of the program for these models; the exit code of the command goes to `exit_code`.
std::unique_ptr<CLI::App> make_app(Models models, int& exit_code);

}  // namespace wearwell
