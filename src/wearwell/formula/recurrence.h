#pragma once

#include <cstddef>
#include <cstdint>

namespace wearwell::formula {

/// y[i] = growth[i] y[i - 1] + gain[i] along each path, starting from `beginning` at the path's
/// first row; 0 stays 0 for any growth. `starts` is 1 at the beginning of a path.
struct Recurrence {
  const double* growth = nullptr;
  const double* gain = nullptr;  ///< null for none
  const double* beginning = nullptr;
  bool uniform_beginning = false;
  const std::uint8_t* starts = nullptr;
  std::size_t count = 0;

  bool first(std::size_t i) const { return i == 0 || starts[i] != 0; }
  double begin(std::size_t i) const { return beginning[uniform_beginning ? 0 : i]; }

  void forward(double* y) const {
    for (std::size_t i = 0; i < count; ++i) {
      const double before = first(i) ? begin(i) : y[i - 1];
      y[i] = (before == 0 ? 0 : growth[i] * before) + (gain == nullptr ? 0 : gain[i]);
    }
  }

  /// Adds the contributions of y's adjoints to the adjoints that are not null.
  void reverse(const double* y, const double* adjoint, double* to_growth, double* to_gain,
               double* to_beginning) const {
    double carried = 0;
    for (std::size_t i = count; i-- > 0;) {
      const double given = carried + adjoint[i];
      const double before = first(i) ? begin(i) : y[i - 1];
      if (given != 0 && to_growth != nullptr) to_growth[i] += given * before;
      if (given != 0 && to_gain != nullptr) to_gain[i] += given;
      carried = given == 0 ? 0 : given * growth[i];
      if (!first(i)) continue;
      if (to_beginning != nullptr) to_beginning[uniform_beginning ? 0 : i] += carried;
      carried = 0;
    }
  }
};

}  // namespace wearwell::formula
