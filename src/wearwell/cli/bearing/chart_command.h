#pragma once

namespace CLI {
class App;
}

namespace wearwell::bearing {

/// Adds `chart`: wear number against depth for several clearances, as CSV.
void add_chart_command(CLI::App& bearing);

}  // namespace wearwell::bearing
