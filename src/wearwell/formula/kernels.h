#pragma once

#include <cstddef>

#include "wearwell/formula/words.h"

namespace wearwell::formula {

/// y = op(a, b, c) for n rows. An argument that is uniform is one number. `extra` is what the
/// operation knows beside its arguments: the exponent of whole_power.
using Forward = void (*)(const double* a, const double* b, const double* c, double* y,
                         std::size_t n, double extra);

/// Of an operation with values y and adjoints g: what it gives to its arguments, in ga, gb, gc, where
/// these are not null. Bit i of `first` says that argument i of several rows holds nothing yet and
/// is set; otherwise it is added to. Where an adjoint is 0, so is what it gives, whatever the slope:
/// a branch that was not taken leaves no NaN.
using Reverse = void (*)(const double* a, const double* b, const double* c, const double* y,
                         const double* g, double* ga, double* gb, double* gc, std::size_t n,
                         double extra, unsigned first);

struct Kernels {
  Forward forward = nullptr;
  Reverse reverse = nullptr;  ///< null where nothing is given: comparisons
};

/// The kernels of an operation with one to three arguments, of which those in `uniform` (bit i for
/// argument i) are one number. The same bits on every machine: vectors of another width, the same
/// operations. Sums over rows run in eight lanes.
Kernels kernels_of(Op op, unsigned uniform);

/// One value.
double value_of(Op op, double a, double b, double c, double extra);

}  // namespace wearwell::formula
