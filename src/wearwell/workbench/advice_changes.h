#pragma once

#include <string>
#include <vector>

namespace wearwell::workbench {

/// The changes of a study that an advice of a check names, as keys: "mixture", "share", "families",
/// "family NAME". The advice is recognized as the sentence of a shape of residuals (infer/residual_shape.h)
/// or by its line of a study, `family = "NAME"`.
std::vector<std::string> advised_changes(const std::string& advice);

}  // namespace wearwell::workbench
