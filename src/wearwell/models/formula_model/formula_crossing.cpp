#include "wearwell/models/formula_model/formula_crossing.h"

#include "wearwell/models/formula_model/crossing_search.h"

namespace wearwell::formula_model {

Crossing::Crossing(const Path& path, bool rising, double begin, double scale)
    : at_(path),
      effects_(path.model->effects.size()),
      rising_(rising),
      begin_(path.goes_on() ? path.running->begin : begin),
      scale_(scale) {}

void Crossing::solve(std::size_t count, const double* z, const double* level, double* place) {
  at_.stand(count, z);
  search_crossings(
      rising_, begin_, scale_, count, level,
      [&](const double* trial) { at_.evaluate(count, z, trial); },
      [&](std::size_t i) { return at_.output(0, i); }, place, ahead_);
}

}  // namespace wearwell::formula_model
