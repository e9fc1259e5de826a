#pragma once

#include "wearwell/infer/exact.h"

namespace wearwell {

/// The posterior of four parameters on a lattice: the trapezoidal rule, which converges
/// exponentially for a smooth density that falls off on the whole space (Trefethen and Weideman
/// 2014). It stands in the coordinates of a RidgeMap, in which a funnel is round, but askew: no layer
/// of cells shares the value of a parameter; or in those of the covariance, with lines along the
/// parameter that the others hold closest: whichever a coarse lattice finds rounder. There parameters between two bounds
/// are bent, so that tails as exp(-|z|) become normal ones. One direction is
/// integrated out along lines about their own modes; the lattice of the other three is filled
/// outward from the mode as long as there is density, and refined, each axis by itself, until its error is below `tolerance`. That
/// error is estimated: along every axis and diagonal sums over every second and every fourth node tell how the Fourier transform
/// of density and moments falls, hence what it is where the lattice cannot see it; and what the outermost shells hold, how much lies
/// beyond. Cells hold the parabola through the log density of their neighbours.
///
/// Limits: density and moments converge exponentially, cells by the fourth power of the step, so that
/// quantiles keep an error of some thousandths of a standard deviation (two hundredths on a bent
/// ridge): a tolerance below 1e-3, of which curves are told, has steps finer than its sums ask for. A parameter that is cut by two bounds has long tails on the real line; with four of them
/// the evaluations end at an estimated error of up to 5e-3, which is then accepted (`error` says
/// so).
///
/// Without `cells` nodes stand for themselves alone: nine tenths of what follows the lattice is spared.
ExactPosterior integrate_on_lattice(const Posterior& posterior, const Whitening& whitening,
                                    const ExactSettings& settings);

}  // namespace wearwell
