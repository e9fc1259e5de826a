#pragma once

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/bearing/bearing_data.h"
#include "wearwell/models/bearing/depth_function.h"
#include "wearwell/models/bearing/wear_fit.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// The measured depth after the revolutions of `duty`; searches start at the wear rate `k`.
PredictionRequest depth_request(const bearing::WearModel& model, const BearingData& data,
                                const bearing::Duty& duty, double k,
                                std::optional<double> measured);

/// The bearing of [predict], for the figures of a report.
struct PredictedBearing {
  /// Revolutions: the largest requested or, if more, the last inspected.
  bearing::Duty duty;
  std::optional<double> limit;  ///< allowable depth, m
};

/// Reads [predict]: a bearing as in [conditions], or as given there. Adds predictions and
/// quantities to the study. Throws InputError.
PredictedBearing read_bearing_predictions(const TomlReader& predict,
                                          const bearing::WearModel& model, const BearingData& data,
                                          double k, PosteriorStudy& study);

}  // namespace wearwell
