#pragma once

namespace CLI {
class App;
}

namespace wearwell::clutch {

/// `wearwell clutch design|simulate|features|predict|life|compare|sql`.
void add_clutch_commands(CLI::App& app, int& exit_code);

}  // namespace wearwell::clutch
