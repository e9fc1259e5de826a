#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/base/unit.h"
#include "wearwell/bayes/observation.h"
#include "wearwell/input/source.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/joint/archard.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::joint {

/// The inspections of a joint, with what is needed to speak of them in the user's terms.
struct JointData {
  Inspections inspections;  ///< SI
  std::vector<double> cycles;
  Unit volume_unit;
  std::optional<double> work_per_cycle;  ///< J, where it is constant
  std::string work_text;
  std::optional<PointwiseTable> pointwise;
  std::vector<DataColumn> columns;
  TableLayout layout;
  std::string name;  ///< of the joint, as its readings come under it: "joint" unless the study says
};

/// Work and volume from whichever sources the study names (docs/reference/joint.md): columns, one constant, a
/// profile of one cycle, pin positions. Throws InputError where none or two are given, and where a
/// row cannot be.
JointData read_joint_data(const TomlReader& root, const Source& source, ObservationFamily family);

}  // namespace wearwell::joint
