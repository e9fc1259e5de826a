#pragma once

#include <cstdint>
#include <vector>

#include "wearwell/regress/frontier.h"
#include "wearwell/regress/model_pool.h"

namespace wearwell {

/// R2 and R2p of every submodel, by number of terms (Haramina et al. 2025, Fig. 12).
struct Cloud {
  static constexpr int bins = 1000;  ///< of equal width on [0, 1]; below 0 counts in the first
  struct Size {
    std::vector<std::uint32_t> r2, r2p;  ///< number of models in each bin; empty if no model
  };
  std::vector<Size> sizes;  ///< by number of terms, from 0
  struct Point {
    float r2, r2p;  ///< NaN if the terms are dependent; r2p -infinity if it is not estimable
  };
  /// On request, every model: bit i of the index is the i-th of the free terms.
  std::vector<Point> points;
  double models = 0;     ///< that could be fitted
  double skipped = 0;    ///< with linearly dependent terms, or without any term
  bool complete = true;  ///< false: stopped early, the rest is missing
};

/// Every model, or only its place in the bins.
enum class CloudKind { none, bins, points };

/// Offers every model of `root` to the pool: depth first, each one orthogonalization away from the
/// previous one. `problem` must be made for loo, even if the pool uses another criterion.
Cloud exhaustive_search(const SearchProblem& problem, ModelPool& pool, const Branch& root,
                        CloudKind kind, SearchControl& control, int threads);

}  // namespace wearwell
