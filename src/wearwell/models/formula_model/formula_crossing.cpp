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

void Continuation::find(PathAt& behind, Crossing& ahead, double now, std::span<const double> z,
                        std::size_t effects, std::size_t count) {
  level.resize(count);
  place.resize(count);
  const std::vector<double> nows(std::min(count, Path::most), now);
  for (std::size_t begin = 0; begin < count; begin += Path::most) {
    const std::size_t n = std::min(Path::most, count - begin);
    const double* own = effects > 0 ? &z[begin * effects] : nullptr;
    behind.evaluate(n, own, nows.data());
    for (std::size_t i = 0; i < n; ++i) level[begin + i] = behind.output(0, i);
    ahead.solve(n, own, &level[begin], &place[begin]);
  }
}

}  // namespace wearwell::formula_model
