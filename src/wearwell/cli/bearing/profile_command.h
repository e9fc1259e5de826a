#pragma once

namespace CLI {
class App;
}

namespace wearwell::bearing {

/// Adds `profile`: worn area and wear rate from surface profiles before and after.
void add_profile_command(CLI::App& bearing);

}  // namespace wearwell::bearing
