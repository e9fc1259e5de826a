#include "wearwell/models/registry.h"

#include "wearwell/models/bearing/model.h"
#include "wearwell/models/clutch/model.h"
#include "wearwell/models/fatigue/model.h"
#include "wearwell/models/formula_model/model.h"
#include "wearwell/models/formula_model/warranty_model.h"
#include "wearwell/models/joint/model.h"
#include "wearwell/models/recurrence/model.h"

namespace wearwell {

Models all_models() {
  static const Model models[] = {
      joint::model(),
      bearing::model(),
      clutch::model(),
      fatigue::model(),
      fatigue::spectrum(),
      fatigue::strain_life(),
      fatigue::staircase(),
      formula_model::model(),
      formula_model::life(),
      formula_model::accelerated(),
      formula_model::degradation(),
      formula_model::fleet(),
      formula_model::warranty(),
      recurrence::model(),
  };
  return models;
}

}  // namespace wearwell
