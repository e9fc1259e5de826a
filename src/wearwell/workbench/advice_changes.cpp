#include "wearwell/workbench/advice_changes.h"

#include <string_view>
#include <utility>

#include "wearwell/infer/fit_check.h"
#include "wearwell/infer/residual_shape.h"

namespace wearwell::workbench {
namespace {

// Of lives. One sentence may be that of two shapes.
std::vector<std::string> changes_of_shape(const std::string& advice) {
  const std::pair<ResidualShape, std::vector<std::string>> shapes[] = {
      {ResidualShape::two_groups, {"mixture"}},
      {ResidualShape::long_lower, {"mixture", "families"}},
      {ResidualShape::long_upper, {"share", "families"}}};
  Remedies lives;
  lives.life = true;
  for (const auto& [shape, changes] : shapes) {
    if (advice.find(advice_on(shape, lives)) != advice.npos) return changes;
  }
  return {};
}

}  // namespace

std::vector<std::string> advised_changes(const std::string& advice) {
  constexpr std::string_view key = "family = \"";
  std::vector<std::string> changes = changes_of_shape(advice);
  for (std::size_t at = 0; (at = advice.find(key, at)) != advice.npos;) {
    at += key.size();
    const std::size_t end = advice.find('"', at);
    if (end == advice.npos) break;
    changes.push_back("family " + advice.substr(at, end - at));
  }
  return changes;
}

}  // namespace wearwell::workbench
