#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "wearwell/plan/next_plan.h"

namespace wearwell::plan {
namespace {

// Larger sets of candidates are cut to those with the highest gain, and gain per cost.
constexpr std::size_t most_considered = 60;

std::vector<std::size_t> shortlist_of(const NextPlan& plan) {
  const std::size_t n = plan.judged.size();
  std::vector<std::size_t> by_gain(n);
  for (std::size_t i = 0; i < n; ++i) by_gain[i] = i;
  std::stable_sort(by_gain.begin(), by_gain.end(), [&](std::size_t a, std::size_t b) {
    return plan.judged[a].narrowing > plan.judged[b].narrowing;
  });
  std::set<std::size_t> chosen;
  for (std::size_t i = 0; i < n && chosen.size() < most_considered; ++i) {
    chosen.insert(i);  // the ranking is by gain per cost
    if (chosen.size() < most_considered) chosen.insert(by_gain[i]);
  }
  return {chosen.begin(), chosen.end()};
}

class BatchChoice {
 public:
  BatchChoice(const NextPlan& plan, const NextQuestion& question)
      : plan_(plan), question_(question), considered_(shortlist_of(plan)) {}

  ChosenBatch choose() {
    const auto most = static_cast<std::size_t>(question_.batch > 1 ? question_.batch : 100);
    std::vector<std::size_t> chosen;
    while (chosen.size() < most && add_best(chosen)) {
    }
    constexpr int most_passes = 3;
    for (int pass = 0; pass < most_passes && exchange(chosen); ++pass) {
    }
    ChosenBatch batch;
    batch.chosen = chosen;
    std::sort(batch.chosen.begin(), batch.chosen.end());
    batch.shortlist = considered_.size();
    if (chosen.empty()) return batch;
    batch.gain = gain_of(chosen);
    batch.narrowing = 1 - std::sqrt(batch.gain.variance) / plan_.nodes.sd;
    batch.narrowing_error =
        0.5 * batch.gain.variance_error / (std::sqrt(batch.gain.variance) * plan_.nodes.sd);
    if (plan_.judged.front().cost) batch.cost = cost(chosen);
    return batch;
  }

 private:
  double cost(const std::vector<std::size_t>& chosen) const {
    double sum = 0;
    for (const std::size_t each : chosen) sum += plan_.judged[each].cost.value_or(0);
    return sum;
  }

  bool affordable(const std::vector<std::size_t>& chosen) const {
    return !question_.budget || cost(chosen) <= *question_.budget * (1 + 1e-12);
  }

  Gain gain_of(std::vector<std::size_t> chosen) const {
    std::sort(chosen.begin(), chosen.end());  // the same numbers for the same set
    std::vector<Tested> tests;
    for (const std::size_t each : chosen)
      tests.push_back({each, plan_.judged[each].candidate.specimens});
    return plan_.gain_together(plan_, tests);
  }

  // What is to be small.
  double left(const Gain& gain) const {
    if (question_.by == "information") return -gain.information;
    if (question_.by == "loss") return 1 - plan_.loss->share(gain.saved);
    return std::sqrt(gain.variance) / plan_.nodes.sd;
  }

  double left_now() const { return question_.by == "information" ? 0 : 1; }

  bool add_best(std::vector<std::size_t>& chosen) const {
    constexpr double least = 1e-4;
    const double before = chosen.empty() ? left_now() : left(gain_of(chosen));
    std::vector<double> score(considered_.size(), 0.0);
    tbb::parallel_for(std::size_t{0}, considered_.size(), [&](std::size_t i) {
      std::vector<std::size_t> more = chosen;
      more.push_back(considered_[i]);
      if (!affordable(more)) return;
      const double drop = before - left(gain_of(more));
      if (drop > least) score[i] = drop / plan_.judged[considered_[i]].cost.value_or(1);
    });
    const auto best = std::max_element(score.begin(), score.end());
    if (!(*best > 0)) return false;
    chosen.push_back(considered_[static_cast<std::size_t>(best - score.begin())]);
    return true;
  }

  // Replaces members one by one where that helps; whether any was replaced.
  bool exchange(std::vector<std::size_t>& chosen) const {
    if (chosen.size() < 2) return false;
    constexpr double least = 1e-3;
    bool changed = false;
    double now = left(gain_of(chosen));
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      std::vector<double> after(considered_.size(), now);
      tbb::parallel_for(std::size_t{0}, considered_.size(), [&](std::size_t i) {
        std::vector<std::size_t> other = chosen;
        other[k] = considered_[i];
        if (considered_[i] != chosen[k] && affordable(other)) after[i] = left(gain_of(other));
      });
      const auto best = std::min_element(after.begin(), after.end());
      if (!(*best < now - least)) continue;
      chosen[k] = considered_[static_cast<std::size_t>(best - after.begin())];
      now = *best;
      changed = true;
    }
    return changed;
  }

  const NextPlan& plan_;
  const NextQuestion& question_;
  std::vector<std::size_t> considered_;
};

}  // namespace

ChosenBatch choose_batch(const NextPlan& plan, const NextQuestion& question) {
  return BatchChoice(plan, question).choose();
}

}  // namespace wearwell::plan
