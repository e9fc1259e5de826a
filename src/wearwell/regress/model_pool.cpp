#include "wearwell/regress/model_pool.h"

#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

long long tie_class(double score) {
  return std::llround(std::log(score) * 1e10);
}

}  // namespace

bool better(const ScoredModel& a, const ScoredModel& b) {
  const auto class_a = tie_class(a.score), class_b = tie_class(b.score);
  if (class_a != class_b) return class_a < class_b;
  if (a.size != b.size) return a.size < b.size;
  const TermSet differ = a.set ^ b.set;
  return (a.set & differ & (~differ + 1)) != 0;
}

ModelPool::ModelPool(const SearchProblem& problem, const Settings& settings)
    : problem_(problem), settings_(settings), by_size_(problem.terms + 1) {
  update_limits();
}

void ModelPool::insert(TermSet set, int size) {
  const auto error = exact_error(problem_, set);
  if (!error) return;
  const ScoredModel model{set, size, *error, problem_.score.of(*error, size)};
  if (model.score == infinity || model.score > settings_.at_most) return;
  const std::lock_guard lock(mutex_);
  if (auto& best = by_size_[size]; !sizes_frozen_ && (!best || better(model, *best))) best = model;
  const auto place = std::lower_bound(models_.begin(), models_.end(), model, better);
  const bool known = place != models_.end() && place->set == set;
  if (!known) models_.insert(place, model);

  std::size_t wanted = settings_.keep;
  if (settings_.near > 0) {
    const double most = problem_.score.worse_by(models_.front().score, settings_.near);
    while (wanted < models_.size() && models_[wanted].score <= most) ++wanted;
    if (wanted > settings_.most) truncated_ = true;
    wanted = std::max(settings_.keep, std::min(wanted, settings_.most));
  }
  if (models_.size() > wanted) models_.resize(wanted);
  update_limits();
}

double ModelPool::threshold() const {
  if (models_.size() < settings_.keep) return settings_.at_most;
  const double last = models_.back().score;
  if (settings_.near == 0 || models_.size() >= settings_.most) return last;
  return std::min(settings_.at_most,
                  std::max(last, problem_.score.worse_by(models_.front().score, settings_.near)));
}

void ModelPool::update_limits() {
  const double all = threshold();
  // Models larger than the last exact fit can at best be exact, too, and lose the tie.
  const bool exact = settings_.near == 0 && models_.size() >= settings_.keep &&
                     models_.back().error <= problem_.least_error;
  const int largest = exact ? models_.back().size : problem_.terms;
  for (int size = 0; size <= problem_.terms; ++size) {
    double cut = -infinity, worth = -infinity;
    if (size > 0) {
      const auto& best = by_size_[size];
      const double of_all = size > largest ? -infinity : problem_.score.error_at(all, size);
      const double of_size = !problem_.score.admits(size) ? -infinity
                             : best                       ? best->error
                                                          : infinity;
      const double of_any = std::max(of_all, of_size);
      worth = (sizes_frozen_ ? of_all : of_any) * (1 + bound_slack);
      cut = (settings_.every_size ? of_any : of_all) * (1 + bound_slack);
    }
    limit_[size].store(cut, std::memory_order_relaxed);
    interest_[size].store(worth, std::memory_order_relaxed);
  }
}

double ModelPool::best_score() const {
  const std::lock_guard lock(mutex_);
  return models_.empty() ? infinity : models_.front().score;
}

std::vector<ScoredModel> ModelPool::best() const {
  const std::lock_guard lock(mutex_);
  return models_;
}

std::vector<std::optional<ScoredModel>> ModelPool::best_by_size() const {
  const std::lock_guard lock(mutex_);
  auto best = by_size_;
  for (const auto& model : models_) {
    auto& other = best[model.size];
    if (!other || better(model, *other)) other = model;
  }
  return best;
}

void ModelPool::end_seeding() {
  const std::lock_guard lock(mutex_);
  sizes_frozen_ = !settings_.every_size;
  update_limits();
}

}  // namespace wearwell
