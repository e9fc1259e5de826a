#pragma once

#include <vector>

#include "wearwell/models/clutch/clutch_study.h"
#include "wearwell/present/html.h"

namespace wearwell::clutch {

/// The figures of Haramina et al. (2025).

/// Fig. 6: wear rates during run-in, each relative to its plate, and the fitted curve.
html::Figure run_in_figure(const ClutchResult& r);

/// Fig. 11: the best R2p at every pair of exponents.
html::Figure exponent_figure(const ExponentSearch& search);

/// Figs. 13 and 14: measured against predicted.
html::Figure parity_figure(const ClutchResult& r);

/// Fig. 15, as heat maps: wear rate over slip speed and torque at each temperature.
std::vector<html::Figure> map_figures(const ClutchStudy& study, const ClutchResult& r);

/// Figs. 7 and 17: normal probability plot of scaled residuals.
html::Figure normal_figure(const ClutchResult& r);

/// Fig. 16: size of residuals and the fitted scatter.
html::Figure scatter_figure(const ClutchResult& r);

/// Fig. 18: worn volume along a sequence.
html::Figure sequence_figure(const SequenceResult& s);

/// Fig. 20: relative width of the interval against the wear level.
html::Figure width_figure(const ClutchResult& r);

}  // namespace wearwell::clutch
