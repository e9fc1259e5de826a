#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "wearwell/infer/check.h"
#include "wearwell/models/fatigue/load_cycles.h"
#include "wearwell/models/fatigue/load_life.h"
#include "wearwell/present/section.h"

namespace wearwell::fatigue {

/// A life under a history with what is needed to describe it.
struct LoadLifeReport {
  SnResult result;
  Block block;
  LoadCycles cycles;     ///< the rule of damage accumulation
  double reduction = 0;  ///< relative change of the damage with fewer classes
  LoadQuestion question;
  LoadLife life;
  std::string unit = "blocks";  ///< unit of lives, and its amount per block
  double per_block = 1;
};

const std::vector<std::string>& miner_rule_names();

/// Cautions: cycles outside the tested range, a study that is not trusted.
std::vector<Check> load_life_checks(const LoadLifeReport& report);

std::string load_life_text(const LoadLifeReport& report);
std::vector<present::Section> load_life_sections(const LoadLifeReport& report);
nlohmann::ordered_json load_life_json(const LoadLifeReport& report);

}  // namespace wearwell::fatigue
