#include "wearwell/study/never_reached.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/present/number.h"
#include "wearwell/present/table.h"

namespace wearwell {

bool is_b_life(const QuantitySummary& quantity) {
  const std::string& name = quantity.name;
  return name.size() > 1 && name.front() == 'B' && name[1] >= '0' && name[1] <= '9' &&
         name.ends_with("life");
}

std::string never_reached(const std::vector<QuantitySummary>& quantities) {
  const auto never = [](const QuantitySummary& each) {
    const QuantityQuantiles& q = each.best();
    const bool any = std::isinf(q.q05) || std::isinf(q.q50) || std::isinf(q.q95) ||
                     std::isinf(q.predictive.value_or(0)) || std::isinf(q.bound.value_or(0)) ||
                     std::isinf(q.upper_bound.value_or(0));
    return is_b_life(each) && any;
  };
  if (std::none_of(quantities.begin(), quantities.end(), never)) return "";
  for (const QuantitySummary& each : quantities) {
    if (each.name != share_failing) continue;
    const QuantityQuantiles& q = each.best();
    return fmt::format("Never reached: at most {:.4g} % fail at all ({:.4g} to {:.4g} %, 90 %).",
                       q.q50, q.q05, q.q95);
  }
  return "Never: this share of all is not reached.";
}

}  // namespace wearwell
