#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/infer/check.h"
#include "wearwell/present/section.h"
#include "wearwell/prognosis/decisions.h"
#include "wearwell/prognosis/information.h"

namespace wearwell::prognosis {

/// The value of another reading of one unit.
struct WorthReport {
  std::string unit, column;  ///< unit and quantity
  Unit reading_unit;
  double after = 0;  ///< from now, SI
  std::vector<Outcome> outcomes;
  InspectionWorth worth;
};

/// Decisions with what is needed to describe them.
struct DecisionsReport {
  KnownLives lives;
  Question question;
  Decisions decisions;
  std::optional<WorthReport> worth = {};
};

/// Assumptions of the decisions that may fail.
std::vector<Check> decision_checks(const DecisionsReport& report);

std::string decisions_text(const DecisionsReport& report);
std::vector<present::Section> decisions_sections(const DecisionsReport& report);
nlohmann::ordered_json decisions_json(const DecisionsReport& report);

}  // namespace wearwell::prognosis
