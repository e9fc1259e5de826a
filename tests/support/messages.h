#pragma once

#include <cstddef>
#include <sstream>
#include <string>

namespace wearwell {

/// Messages in what a program says: its lines without excerpts, which stand behind a message and are indented.
inline std::size_t messages_in(const std::string& said) {
  std::istringstream lines(said);
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line);) count += !line.starts_with("    ");
  return count;
}

}  // namespace wearwell
