#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>

#include "support/run_command.h"

namespace wearwell::monitor {

inline bool has_protoc() {
  return run_command("command -v protoc").exit_code == 0;
}

/// What Google's encoder makes of a payload in its text form: "timestamp: 5 metrics { name: 'x' }".
inline std::string encoded(const std::string& text) {
  const CommandResult run = run_command("protoc --proto_path='" PROJECT_SOURCE_DIR
                                        "/tests/monitor' --encode=sparkplug.Payload "
                                        "sparkplug_b.proto <<'END'\n" +
                                        text + "\nEND\n");
  if (run.exit_code != 0) throw std::runtime_error(run.err);
  return run.out;
}

/// A metric of a birth certificate, and one of data by its alias; `value` as "double_value: 1.5".
inline std::string born_metric(const std::string& name, int alias, int type,
                               const std::string& value, long long time = 1000) {
  return fmt::format("metrics {{ name: '{}' alias: {} timestamp: {} datatype: {} {} }}\n", name,
                     alias, time, type, value);
}
inline std::string metric(int alias, long long time, const std::string& value) {
  return fmt::format("metrics {{ alias: {} timestamp: {} {} }}\n", alias, time, value);
}
inline std::string number(double value) {
  return fmt::format("double_value: {}", value);
}
inline std::string payload(int sequence, const std::string& metrics, long long time = 1000) {
  return encoded(fmt::format("timestamp: {} seq: {}\n{}", time, sequence, metrics));
}

constexpr int double_type = 10, text_type = 12;

}  // namespace wearwell::monitor
