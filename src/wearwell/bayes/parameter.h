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
  Unit unit;                 ///< in which it is reported: the one its prior is written in
  std::string distribution;  ///< the prior's name as in the study file
  Distribution prior;
  double start = 1;  ///< a plausible value inside the support, SI, where searches start
  double scale = 1;  ///< the size of a plausible change, SI, > 0
  double natural_lower =
      -std::numeric_limits<double>::infinity();  ///< bound set by physics, not by belief
  double natural_upper = std::numeric_limits<double>::infinity();
  bool is_default = false;  ///< nobody stated the prior: it is the model's own
  bool of_model =
      false;  ///< of one unit, in standard terms: its law is part of the model, no belief
};

}  // namespace wearwell
