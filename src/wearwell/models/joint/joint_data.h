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

/// The inspections of a joint, with the names and units for messages.
struct JointData {
  Inspections inspections;  ///< SI
  std::vector<double> cycles;
  Unit volume_unit;
  std::optional<double> work_per_cycle;  ///< J, if it is constant
  std::string work_text;
  std::optional<PointwiseTable> pointwise;
  std::vector<DataColumn> columns;
  TableLayout layout;
  std::string name;  ///< name of the joint, as its readings have it; default "joint"
};

/// Work and volume from the sources that the study names (docs/reference/joint.md): columns, one
/// constant, a profile of one cycle, pin positions. Throws InputError if none or two are given, and
/// for an impossible row.
JointData read_joint_data(const TomlReader& root, const Source& source, ObservationFamily family);

}  // namespace wearwell::joint
