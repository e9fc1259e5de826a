#pragma once

#include "wearwell/infer/exact.h"

namespace wearwell {

/// The posterior of four parameters on a lattice: the trapezoidal rule, which converges
/// exponentially for a smooth density that falls off on the whole space (Trefethen and Weideman
/// 2014). It uses the coordinates of a RidgeMap, in which a funnel is round, sheared so that no
/// layer of cells shares the value of a parameter; or those of the covariance, with lines along the
/// parameter that the others determine best. A coarse lattice selects the better one. There
/// parameters between two bounds are Gaussianized, so that tails like exp(-|z|) become normal. One
/// direction is integrated along lines about their own modes. The lattice of the other three is
/// filled outward from the mode as long as there is density, and each axis is refined separately
/// until the error is below `tolerance`. Where a coarse lattice shows long tails, steps along these
/// axes grow exponentially beyond the central mass (u = far sinh(v/far), even in v). The error is
/// estimated from the decay of the Fourier transform of density and moments, given by sums over
/// every second and every fourth node along every axis and diagonal, and from the mass of the
/// outermost shells. Cells contain the parabola through the log density of their neighbours.
///
/// Limits: density and moments converge exponentially, cells by the fourth power of the step, so
/// that quantiles keep an error of some thousandths of a standard deviation (two hundredths on a
/// curved ridge). A tolerance below 1e-3, used for curves, has finer steps than its sums require. A
/// parameter between two bounds has long tails on the real line; with four of them the evaluations
/// end at an estimated error of up to 5e-3, which is accepted and stated in `error`.
///
/// Without `cells` nodes represent only themselves, which saves nine tenths of the later cost.
ExactPosterior integrate_on_lattice(const Posterior& posterior, const Whitening& whitening,
                                    const ExactSettings& settings);

}  // namespace wearwell
