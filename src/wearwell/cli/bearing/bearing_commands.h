#pragma once

namespace CLI {
class App;
}

namespace wearwell::bearing {

/// Adds `wearwell bearing rate|depth|pressure|length|life|chart|profile`. A subcommand runs while the
/// command line is parsed: it prints its answer on standard output and its warnings on standard
/// error, or throws InputError.
void add_bearing_command(CLI::App& app);

}  // namespace wearwell::bearing
