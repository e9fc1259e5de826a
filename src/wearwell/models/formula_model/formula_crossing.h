#pragma once

#include <span>
#include <vector>

#include "wearwell/models/formula_model/formula_path.h"

namespace wearwell::formula_model {

/// First position where output 0 of a path reaches a level, by unit: from `begin` on, with a first
/// guess of `scale`. `rising` is the direction. Infinite if it never does, `begin` if it has
/// already. A path that continues from a unit's last row is evaluated from there on.
class Crossing {
 public:
  Crossing(const Path& path, bool rising, double begin, double scale);
  PathAt& at() { return at_; }
  void solve(std::size_t count, const double* z, const double* level, double* place);
  double begin() const { return begin_; }
  /// Excess over the level at `begin` (negative: not yet reached), of the last `solve`.
  double ahead(std::size_t i) const { return ahead_[i]; }

 private:
  PathAt at_;
  std::size_t effects_;
  bool rising_;
  double begin_, scale_, ahead_[Path::most] = {};
};

/// If conditions change at position `now`, the path of a unit continues from its value there, at the corresponding position
/// under the new conditions. For units at `z` (effects of each): their values at `now` under the old conditions (`behind`), and
/// the positions where paths under the new ones (`ahead`) have these values. Both paths are at their parameters.
struct Continuation {
  std::vector<double> level, place;
  void find(PathAt& behind, Crossing& ahead, double now, std::span<const double> z,
            std::size_t effects, std::size_t count);
};

}  // namespace wearwell::formula_model
