#pragma once

#include "wearwell/models/formula_model/formula_path.h"

namespace wearwell::formula_model {

/// Where output 0 of a path first reaches a level, by unit: from `begin` on, with a first guess of
/// `scale`. `rising` says from which side. Infinite where it never does, `begin` where it has. A path
/// that goes on from a unit's last row is looked at from there on.
class Crossing {
 public:
  Crossing(const Path& path, bool rising, double begin, double scale);
  PathAt& at() { return at_; }
  void solve(std::size_t count, const double* z, const double* level, double* place);
  double begin() const { return begin_; }
  /// How far the level was passed at `begin` (negative: not yet), of the last `solve`.
  double ahead(std::size_t i) const { return ahead_[i]; }

 private:
  PathAt at_;
  std::size_t effects_;
  bool rising_;
  double begin_, scale_, ahead_[Path::most] = {};
};

}  // namespace wearwell::formula_model
