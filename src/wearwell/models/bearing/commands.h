#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace wearwell {

/// Adds `wearwell bearing rate|depth|pressure|length|life|chart`. A subcommand runs while the
/// command line is parsed: it prints its answer on standard output and its warnings on standard
/// error, or throws InputError.
void add_bearing_command(CLI::App& app, int& exit_code);

namespace bearing {

/// What such a command is asked, as it is written on the command line.
struct Asked {
  std::string contact;
  std::map<std::string, std::string> inputs;  ///< "radius" and "20 mm +- 1 %", ...
  std::string unit = {}, limit = {};
  int draws = 100'000;
  std::uint64_t seed = 1;
};
struct Told {
  nlohmann::ordered_json json;  ///< as with --json
  std::vector<std::string> warnings;
  std::string margin;  ///< a sentence; empty without a limit
};
/// `command`: "rate", "depth", "pressure", "length" or "life". Throws InputError.
Told answer(const std::string& command, const Asked& asked);

}  // namespace bearing
}  // namespace wearwell
