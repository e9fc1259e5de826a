#pragma once

#include <array>
#include <atomic>
#include <limits>
#include <mutex>
#include <optional>
#include <vector>

#include "wearwell/regress/search_problem.h"

namespace wearwell {

/// A model whose error was computed by exact_error.
struct ScoredModel {
  TermSet set = 0;
  int size = 0;
  double error = 0;  ///< PRESS (loo) or residual sum of squares
  double score = 0;
};

/// A strict order of all models: by score, where scores within a relative 1e-10 (one step of a
/// logarithmic grid) are ties; then by fewer terms; then by the first term where they differ.
bool better(const ScoredModel& a, const ScoredModel& b);

/// The models that the search keeps, and hence the error above which a branch may be cut. Shared by
/// all threads. The kept models depend only on the set of models offered, not on their order.
class ModelPool {
 public:
  struct Settings {
    std::size_t keep = 1;       ///< number of best models
    double near = 0;            ///< and all within this distance of the best (Score::worse_by)
    std::size_t most = 10'000;  ///< but never more than this
    bool every_size = false;    ///< the best of each size is wanted, however bad
    /// Models of a larger score are not kept.
    double at_most = std::numeric_limits<double>::infinity();
  };

  ModelPool(const SearchProblem& problem, const Settings& settings);

  /// A model of `size` between `lowest` and `highest` terms whose error certainly exceeds this is
  /// not kept. Any thread, no lock.
  double limit(int lowest, int highest) const {
    double most = limit_[lowest].load(std::memory_order_relaxed);
    if (!settings_.every_size) return most;  // decreases with the size
    for (int size = lowest + 1; size <= highest; ++size)
      most = std::max(most, limit_[size].load(std::memory_order_relaxed));
    return most;
  }

  /// A model from the search, with its error as computed there. Keeps it if it is good enough.
  void offer(TermSet set, int size, double error) {
    if (error <= interest_[size].load(std::memory_order_relaxed)) insert(set, size);
  }

  /// From here on, unless `every_size`, the best of each size comes from the best models only:
  /// other models in a search depend on the timing of threads.
  void end_seeding();

  /// Whether errors are PRESS rather than the residual sum of squares.
  bool by_press() const { return problem_.leave_one_out; }

  double best_score() const;  ///< infinity without a model
  /// Best first. At most `keep` without `near`.
  std::vector<ScoredModel> best() const;
  /// The best known of each size, by size; empty if there is none.
  std::vector<std::optional<ScoredModel>> best_by_size() const;
  /// The score up to which every model is kept.
  double threshold() const;
  /// True if more models than `most` are within `near`.
  bool truncated() const { return truncated_ && models_.size() >= settings_.most; }

 private:
  void insert(TermSet set, int size);
  void update_limits();

  const SearchProblem& problem_;
  const Settings settings_;
  mutable std::mutex mutex_;
  std::vector<ScoredModel> models_;  ///< best first
  std::vector<std::optional<ScoredModel>> by_size_;
  bool truncated_ = false;
  bool sizes_frozen_ = false;
  using Limits = std::array<std::atomic<double>, most_search_terms + 1>;
  Limits limit_;     ///< by size: error up to which a branch must be searched
  Limits interest_;  ///< by size: error up to which a model is worth an exact evaluation
};

}  // namespace wearwell
