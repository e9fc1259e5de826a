#include "wearwell/present/plain.h"

#include <fmt/format.h>

#include <cmath>

namespace wearwell {

std::string plain_number(double x, int digits) {
  if (std::isnan(x)) return "-";
  const double size = std::abs(x), most = 1e9;
  const double whole = std::pow(10.0, digits);
  if (!(size >= whole && size < most)) return fmt::format("{:.{}g}", x, digits);
  const double last = std::pow(10.0, std::floor(std::log10(size)) + 1 - digits);
  return fmt::format("{:.0f}", std::round(x / last) * last);
}

}  // namespace wearwell
