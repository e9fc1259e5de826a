#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "wearwell/infer/check.h"
#include "wearwell/models/fatigue/averaged_design.h"
#include "wearwell/present/section.h"

namespace wearwell::fatigue {

/// A design curve averaged over models, with what is needed to describe it.
struct AveragedDesignReport {
  ModelsToAverage from;
  DesignQuestion question;
  std::vector<DesignPoint> points;
  bool shown_all =
      false;  ///< on a terminal: each stress, rather than the first, the middle and the last
};

/// Cautions: stresses beyond the tested range, studies that are not trusted, weight that is spread.
std::vector<Check> averaged_design_checks(const AveragedDesignReport& report);

std::string averaged_design_text(const AveragedDesignReport& report);
std::vector<present::Section> averaged_design_sections(const AveragedDesignReport& report);
nlohmann::ordered_json averaged_design_json(const AveragedDesignReport& report);

}  // namespace wearwell::fatigue
