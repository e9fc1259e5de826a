#pragma once

#include <vector>

#include "wearwell/infer/loo.h"

namespace wearwell {

/// Weights, summing to 1, of the mixture of models that predicts each observation best from all
/// others: the sum over observations of log sum_k w_k exp(elpd_k) is highest (stacking of
/// predictive distributions: Yao, Vehtari, Simpson, Gelman 2018, Bayesian Analysis 13, 917-1007).
/// Models with equal predictions share their weight equally. Throws std::invalid_argument if the
/// models leave out different observations.
std::vector<double> model_weights(const std::vector<const Loo*>& models);

}  // namespace wearwell
