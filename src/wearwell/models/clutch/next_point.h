#pragma once

#include <filesystem>

#include "wearwell/models/clutch/wear_model.h"
#include "wearwell/plan/next_question.h"

namespace wearwell::clutch {

/// Which operating point to run next, so that a wear rate or a life elsewhere is known better. The
/// goal is "wear rate at POINT" or "life at POINT", POINT like "slip_speed = 1700 rpm, torque = 50
/// N m, temperature = 170 degC, closing_time = 2.15 s". A candidate has these four, `cycles` (its
/// number of closings) and optionally `volume_sd`, the standard deviation of its measured volume.
/// Each specimen is a new plate.
///
/// The coefficients of the map are normal about the fit with its covariance, and the wear rate of a
/// candidate scatters by sigma_w/sqrt(cycles), by the factor of its plate and by `volume_sd`, so
/// that the gain has a closed form (plan/linear_gain.h). Exponents, choice of terms and run-in are
/// those of the fit; a check compares with the replicates, where all of them vary. Throws
/// InputError that names option, row or column.
plan::Answer next_point(const WearModel& model, bool trusted, const plan::NextQuestion& question);

/// The same for a folder of results, which has model.json.
plan::Answer next_point(const std::filesystem::path& result, const plan::NextQuestion& question);

/// Whether a folder of results is of a clutch.
bool is_clutch_result(const std::filesystem::path& result);

}  // namespace wearwell::clutch
