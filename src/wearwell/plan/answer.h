#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "wearwell/present/section.h"

namespace wearwell::plan {

/// The answer to a question about tests or inspections to come, ready to show.
struct Answer {
  std::string title;                            ///< of the page
  std::string text;                             ///< for a terminal
  std::vector<present::Section> sections = {};  ///< of the page; its tables are files too
  nlohmann::ordered_json json = {};             ///< plan.json
  bool trusted = true;                          ///< the fit that it rests on
};

}  // namespace wearwell::plan
