#pragma once

#include <limits>
#include <string>

#include "wearwell/base/unit.h"
#include "wearwell/prob/distribution.h"

namespace wearwell {

/// One unknown of a model. Its numbers are in SI, or plain where `si` is "1".
struct Parameter {
  std::string name;
  std::string si;            ///< its SI unit
  Unit unit;                 ///< unit of reports: that of its prior
  std::string distribution;  ///< the prior's name in the study file
  Distribution prior;
  double start = 1;  ///< a plausible value inside the support, SI, where searches start
  double scale = 1;  ///< the size of a plausible change, SI, > 0
  double natural_lower =
      -std::numeric_limits<double>::infinity();  ///< physical bound, not a prior belief
  double natural_upper = std::numeric_limits<double>::infinity();
  bool is_default = false;  ///< the prior is the model's default
  bool of_model =
      false;  ///< standardized random effect of one unit; its distribution is part of the model
};

}  // namespace wearwell
