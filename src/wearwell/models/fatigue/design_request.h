#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/models/fatigue/averaged_design_report.h"

namespace wearwell::fatigue {

/// The options of `wearwell fatigue design`, as a user writes them.
struct DesignRequest {
  std::vector<std::string> stresses = {};  ///< "300 MPa"; empty: levels across the tested range
  std::string mean_stress = {}, stress_ratio = {};
  std::optional<double> reliability = {}, confidence = {};  ///< shares
};

/// Design curves of these models. Throws InputError that names the option; Cancelled.
AveragedDesignReport averaged_design_of(const DesignRequest& request, ModelsToAverage models,
                                        const std::stop_token& stop = {});

/// Whether no check failed.
bool is_trusted(const AveragedDesignReport& report);

}  // namespace wearwell::fatigue
