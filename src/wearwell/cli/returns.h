#pragma once

namespace CLI {
class App;
}

namespace wearwell {

/// wearwell returns: counts units sold and returned by month, where their data are, into a returns triangle.
void add_returns_command(CLI::App& app, int& exit_code);

}  // namespace wearwell
