#include "wearwell/models/registry.h"

#include "wearwell/models/bearing/model.h"
#include "wearwell/models/clutch/model.h"
#include "wearwell/models/fatigue/model.h"
#include "wearwell/models/joint/model.h"
#include "wearwell/models/ownlaw/model.h"

namespace wearwell {

Models all_models() {
  static const Model models[] = {
      joint::model(),      bearing::model(),       clutch::model(),       fatigue::model(),
      fatigue::spectrum(), fatigue::strain_life(), fatigue::staircase(),  ownlaw::model(),
      ownlaw::life(),      ownlaw::accelerated(),  ownlaw::degradation(), ownlaw::fleet(),
  };
  return models;
}

}  // namespace wearwell
