#pragma once

#include "wearwell/infer/exact.h"

namespace wearwell {

/// The posterior of four parameters on a lattice: the trapezoidal rule, which converges
/// exponentially for a smooth density that falls off on the whole space (Trefethen and Weideman
/// 2014). The parameter that the others hold closest is integrated out along its own line, about
/// its conditional mode, so that a narrow ridge may bend; the lattice of the other three is filled
/// outward from the mode as long as there is density, and refined until its two half lattices agree
/// to `tolerance`.
ExactPosterior integrate_on_lattice(const Posterior& posterior, const Whitening& whitening,
                                    const ExactSettings& settings);

}  // namespace wearwell
