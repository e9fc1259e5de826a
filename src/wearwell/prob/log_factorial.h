#pragma once

namespace wearwell {

/// ln k! of a whole number k >= 0, from a table where k is small.
double log_factorial(double k);

}  // namespace wearwell
