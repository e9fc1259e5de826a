#pragma once

#include <string>

namespace wearwell {

/// A number for a terminal, to so many digits: "0.7759", "304400", "7.759e-10".
std::string plain_number(double x, int digits = 4);

}  // namespace wearwell
