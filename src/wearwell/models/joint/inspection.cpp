#include "wearwell/models/joint/inspection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/physics/circle_area.h"

namespace wearwell::joint {

double work_per_cycle(const std::vector<double>& force, const std::vector<double>& slip_increment,
                      WorkRule rule) {
  double work = 0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    const double before = force[i == 0 ? force.size() - 1 : i - 1];
    work +=
        (rule == WorkRule::rectangle ? force[i] : 0.5 * (before + force[i])) * slip_increment[i];
  }
  if (!(work > 0)) {
    throw InputError(fmt::format("the work of one cycle is {:.6g} J; it must be positive", work));
  }
  return work;
}

WornVolume worn_volume(const PinGeometry& geometry, const std::vector<double>& cycles,
                       const std::vector<double>& dx, const std::vector<double>& dy) {
  WornVolume worn;
  std::vector<double> count;
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    const auto found = std::find(worn.cycles.begin(), worn.cycles.end(), cycles[i]);
    const auto at = static_cast<std::size_t>(found - worn.cycles.begin());
    if (found == worn.cycles.end()) {
      worn.cycles.push_back(cycles[i]);
      worn.volume.push_back(0);
      count.push_back(0);
    }
    worn.volume[at] += geometry.length * area_outside(geometry.pin_radius, geometry.bushing_radius,
                                                      std::hypot(dx[i], dy[i]));
    ++count[at];
  }
  for (std::size_t i = 0; i < count.size(); ++i) worn.volume[i] /= count[i];
  return worn;
}

}  // namespace wearwell::joint
