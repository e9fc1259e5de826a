#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/models/formula_model/formula_asked.h"
#include "wearwell/models/formula_model/formula_lives.h"
#include "wearwell/study/life_levels.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::formula_model {

/// Requests on lives to a threshold, in addition to the life of a new unit and the remaining useful
/// life of each unit.
struct LimitWishes {
  LifeLevels levels;
  std::optional<Quantity> survived;  ///< lives then count from this point, given survival to it
  bool mean = false;                 ///< the mean life, and the mean remaining useful life
};

/// Reads them, and sets the shares and the survived point of `path`. Throws InputError.
LimitWishes read_limit_wishes(const Asked& asked, LimitedPath& path);

/// The quantities that follow from lives to a threshold: lives, survival and B-lives of a new unit
/// and of each unit of the study.
class LimitGroup {
 public:
  LimitGroup(const Asked& asked, const std::string& name, const Quantity& limit,
             std::shared_ptr<const LimitedPath> path, LimitWishes wishes);

  const std::vector<QuantityRequest>& requests() const { return requests_; }
  /// Of each request, SI. `coarse`: the same lives over fewer points of the posterior, to estimate
  /// the error.
  std::vector<QuantityQuantiles> answers(const LimitedLives& lives,
                                         const std::optional<LimitedLives>& coarse) const;
  /// Of each life among the requests.
  std::vector<PredictiveLife> predictive(const LimitedLives& lives,
                                         const std::optional<LimitedLives>& coarse) const;

 private:
  struct Remaining;
  std::vector<Remaining> remaining(const LimitedLives& lives) const;
  std::vector<QuantityQuantiles> answers(const LimitedLives& lives) const;
  double begin_of(std::size_t u) const;
  void add_mean(const QuantityRequest& life, bool next, const std::string& noun);
  void add_life(const std::string& name, const std::string& of, const std::string& at,
                const Unit& unit);

  std::vector<QuantityRequest> requests_;
  std::shared_ptr<const LimitedPath> path_;
  LimitWishes wishes_;
};

}  // namespace wearwell::formula_model
