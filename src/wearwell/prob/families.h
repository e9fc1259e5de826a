#pragma once

#include "wearwell/prob/beta.h"
#include "wearwell/prob/binomial.h"
#include "wearwell/prob/birnbaum_saunders.h"
#include "wearwell/prob/exponential.h"
#include "wearwell/prob/exponentiated_weibull.h"
#include "wearwell/prob/family_functions.h"
#include "wearwell/prob/flat.h"
#include "wearwell/prob/frechet.h"
#include "wearwell/prob/gamma.h"
#include "wearwell/prob/generalized_gamma.h"
#include "wearwell/prob/half_cauchy.h"
#include "wearwell/prob/half_normal.h"
#include "wearwell/prob/inverse_gamma.h"
#include "wearwell/prob/inverse_gaussian.h"
#include "wearwell/prob/jeffreys.h"
#include "wearwell/prob/largest_extreme_value.h"
#include "wearwell/prob/loglogistic.h"
#include "wearwell/prob/lognormal.h"
#include "wearwell/prob/normal.h"
#include "wearwell/prob/poisson.h"
#include "wearwell/prob/smallest_extreme_value.h"
#include "wearwell/prob/student_t.h"
#include "wearwell/prob/weibull.h"

namespace wearwell::families {

template <class... F>
struct FamilyList {
  static constexpr std::size_t size = sizeof...(F);
};

/// All families; first those named in ResponseFamily, in its order.
using Families = FamilyList<  //
    Normal, Lognormal, LognormalOfMoments, Log10Normal, StudentT, Weibull, SmallestExtremeValue,
    LargestExtremeValue, Exponential, Gamma, Loglogistic, InverseGaussian, Poisson, Binomial, Flat,
    Uniform, HalfNormal, HalfCauchy, InverseGamma, Beta, Jeffreys,
    GeneralizedGamma,      //
    BirnbaumSaunders,      //
    ExponentiatedWeibull,  //
    Frechet>;

template <class F>
inline constexpr bool takes_threshold = F::positive && !F::counted && !F::prior_only;

/// Calls visit.operator()<F>(i) for each family F, i its ResponseFamily; those with a threshold
/// come last, `Families::size` after the same family without one.
template <class Visit>
constexpr void for_each_family(const Visit& visit) {
  [&visit]<class... F>(FamilyList<F...>) {
    std::size_t i = 0;
    (visit.template operator()<F>(i++), ...);
    const auto beyond = [&visit]<class One>(std::size_t at) {
      if constexpr (takes_threshold<One>) visit.template operator()<WithThreshold<One>>(at);
    };
    (beyond.template operator()<F>(i++), ...);
  }(Families());
}

/// One entry for each family, by its ResponseFamily; empty if there is no version with a threshold.
template <class Entry>
using FamilyTable = std::array<Entry, 2 * Families::size>;

}  // namespace wearwell::families
