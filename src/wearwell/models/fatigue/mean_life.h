#pragma once

#include "wearwell/models/fatigue/sn_law.h"

namespace wearwell::fatigue {

/// The mean of lives [cycles] about a center (MixedLife::add): log10 of cycles, for the normal family cycles. Of lognormal
/// lives 10^center exp(s^2/2) with s = sigma ln 10, of Weibull lives 10^center Gamma(1 + s). Infinite if life has no end.
double mean_life(LifeFamily family, double center, double sigma);

/// The share of that mean that comes from lives beyond `life` [cycles]: E[N; N > life]/E[N].
double share_of_mean_beyond(LifeFamily family, double center, double sigma, double life);

}  // namespace wearwell::fatigue
