#pragma once

#include <stdexcept>

#include "wearwell/models/formula_model/formula_process.h"

namespace wearwell::formula_model {

inline const ProcessForm& form_of(Process process, bool by_sd = false) {
  for (const ProcessForm& each : process_forms()) {
    if (each.process == process && each.by_sd == by_sd) return each;
  }
  throw std::logic_error("no such form");
}

}  // namespace wearwell::formula_model
