#pragma once

#include <stdexcept>

#include "wearwell/models/ownlaw/own_process.h"

namespace wearwell::ownlaw {

inline const ProcessForm& form_of(Process process, bool by_sd = false) {
  for (const ProcessForm& each : process_forms()) {
    if (each.process == process && each.by_sd == by_sd) return each;
  }
  throw std::logic_error("no such form");
}

}  // namespace wearwell::ownlaw
