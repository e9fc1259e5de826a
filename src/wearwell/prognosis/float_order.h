#pragma once

#include <bit>
#include <cstdint>

namespace wearwell::prognosis {

/// Integers in the order of the floating-point numbers with the same bits; not for NaN.
inline std::uint64_t order_of(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value + 0.0);  // no -0
  constexpr std::uint64_t sign = std::uint64_t{1} << 63;
  return bits & sign ? ~bits : bits | sign;
}

}  // namespace wearwell::prognosis
