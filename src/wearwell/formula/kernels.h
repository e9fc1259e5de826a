#pragma once

#include <cstddef>

#include "wearwell/formula/words.h"

namespace wearwell::formula {

/// y = op(a, b, c) for n rows. A uniform argument is a single number. `extra` is a constant of the
/// operation: the exponent of whole_power.
using Forward = void (*)(const double* a, const double* b, const double* c, double* y,
                         std::size_t n, double extra);

/// For an operation with values y and adjoints g: the contributions to the adjoints of its
/// arguments, in ga, gb, gc if not null. If bit i of `first` is set, the adjoint of argument i is
/// assigned, otherwise added to. A zero adjoint gives a zero contribution for any slope, so a
/// branch not taken leaves no NaN.
using Reverse = void (*)(const double* a, const double* b, const double* c, const double* y,
                         const double* g, double* ga, double* gb, double* gc, std::size_t n,
                         double extra, unsigned first);

struct Kernels {
  Forward forward = nullptr;
  Reverse reverse = nullptr;  ///< null for comparisons, which have no derivatives
};

/// The kernels of an operation with one to three arguments; those in `uniform` (bit i for argument
/// i) are single numbers. Results are identical on every machine, because wider vectors do the same
/// operations. Sums over rows use eight lanes.
Kernels kernels_of(Op op, unsigned uniform);

/// One value.
double value_of(Op op, double a, double b, double c, double extra);

}  // namespace wearwell::formula
