#pragma once

#include "wearwell/models/formula_model/model.h"

namespace wearwell {

/// The formula model alone: its tests need no other preset.
inline Models formula_models() {
  static const Model models[] = {formula_model::model()};
  return models;
}

}  // namespace wearwell
