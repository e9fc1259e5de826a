#pragma once

#include <map>
#include <string>

#include "wearwell/infer/fit.h"
#include "wearwell/models/bearing/bearing_data.h"
#include "wearwell/models/bearing/bearing_predictions.h"
#include "wearwell/models/bearing/wear_fit.h"
#include "wearwell/study/plots.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// The depth of the predicted bearing against its revolutions. Inspections of other bearings are
/// placed where their p_a n is reached under its pressure.
void add_bearing_history(const bearing::WearModel& model, const BearingData& data,
                         const PredictedBearing& drawn, double k, PosteriorStudy& study);

/// The chart of wear numbers with the data (Figs. 4 and 5 of Ligterink and de Gee 1996), and the
/// scar of the predicted bearing.
std::map<std::string, std::vector<html::Figure>> bearing_figures(const BearingData& data,
                                                                 const PredictedBearing& drawn,
                                                                 const Fit& fit);

}  // namespace wearwell
