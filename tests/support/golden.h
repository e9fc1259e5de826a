#pragma once

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace wearwell {

/// Fields of the rows of a file in tests/golden, without the header.
inline std::vector<std::vector<std::string>> read_golden(const std::string& name) {
  std::ifstream file(PROJECT_SOURCE_DIR "/tests/golden/" + name);
  std::vector<std::vector<std::string>> rows;
  std::string line;
  for (std::getline(file, line); std::getline(file, line);) {
    std::istringstream fields(line);
    rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

}  // namespace wearwell
