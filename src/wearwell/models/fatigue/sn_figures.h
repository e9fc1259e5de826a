#pragma once

#include <map>
#include <string>

#include "wearwell/infer/fit.h"
#include "wearwell/models/fatigue/sn_data.h"
#include "wearwell/models/fatigue/sn_law.h"
#include "wearwell/models/fatigue/sn_predictions.h"
#include "wearwell/study/plots.h"

namespace wearwell {

/// The stress quantity for axes: "stress", "strain", "force" or "load".
const char* driver_word(const fatigue::SnLaw& law, const SnData& data);

/// The S-N curve with its bands, the lives of each stress with its tests (Fig. 8 of Heo et al.
/// 2011), and the Haigh diagram of one life.
std::map<std::string, std::vector<html::Figure>> sn_figures(const fatigue::SnLaw& law,
                                                            const SnData& data,
                                                            const SnPredictions& predictions,
                                                            const Fit& fit);

}  // namespace wearwell
