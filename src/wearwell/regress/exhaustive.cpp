#include "wearwell/regress/exhaustive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "wearwell/base/workers.h"
#include "wearwell/regress/submodel.h"

namespace wearwell {
namespace {

/// The models that share the decision on the first free terms.
class Walk {
 public:
  Walk(const SearchProblem& problem, ModelPool& pool, const std::vector<int>& free, CloudKind kind,
       SearchControl& control, std::vector<Cloud::Point>& points)
      : problem_(problem),
        pool_(pool),
        kind_(kind),
        control_(control),
        points_(points),
        path_(free.size() + 1) {
    for (std::size_t i = 0; i < free.size(); ++i) index_bit_[free[i]] = std::size_t{1} << i;
    cloud_.sizes.resize(problem.terms + 1);
  }

  /// All models that contain `fixed` and any of `free`.
  void run(TermSet fixed, TermSet free) {
    Submodel& root = path_[0];
    root.start(problem_, fixed | free);
    std::size_t index = 0;
    for (const int term : terms_of(fixed)) {
      int position = 0;
      while (position < root.count() && root.term(position) != term) ++position;
      if (position == root.count()) return;  // dependent, as is every further model of this branch
      root.join(root, position);
      index |= index_bit_[term];
    }
    if (control_.stopped()) {
      cloud_.complete = false;
      return;
    }
    if (fixed != 0) record(fixed, root.model_size(), index, root.rss(), root.press());
    visit(0, index);
  }

  const Cloud& cloud() const { return cloud_; }

 private:
  /// All models larger than that at `depth`, by the first candidate that joins it.
  void visit(int depth, std::size_t index) {
    const Submodel& model = path_[depth];
    const int count = model.count();
    if (count > 8 && control_.stopped()) {
      cloud_.complete = false;
      return;
    }
    for (int t = 0; t < count; ++t) {
      const std::size_t index_with = index | index_bit_[model.term(t)];
      record(model.model() | bit(model.term(t)), model.model_size() + 1, index_with,
             model.rss_with(t), model.press_with(t));
      if (t + 1 == count) break;
      path_[depth + 1].join(model, t, t + 1);
      visit(depth + 1, index_with);
    }
  }

  void record(TermSet set, int size, std::size_t index, double rss, double press) {
    pool_.offer(set, size, pool_.by_press() ? press : rss);
    ++cloud_.models;
    const auto r2 = static_cast<float>(1 - rss / problem_.tss);
    const auto r2p = static_cast<float>(1 - press / problem_.tss);
    auto& bins = cloud_.sizes[size];
    if (bins.r2.empty()) {
      bins.r2.resize(Cloud::bins);
      bins.r2p.resize(Cloud::bins);
    }
    ++bins.r2[bin(r2)];
    ++bins.r2p[bin(r2p)];
    if (kind_ == CloudKind::points) points_[index] = {r2, r2p};
  }

  static int bin(float r2) {
    if (!(r2 > 0)) return 0;  // NaN, too, is in no other bin
    return static_cast<int>(std::min(r2 * Cloud::bins, Cloud::bins - 1.0F));
  }

  const SearchProblem& problem_;
  ModelPool& pool_;
  const CloudKind kind_;
  SearchControl& control_;
  std::vector<Cloud::Point>& points_;
  std::vector<Submodel> path_;
  std::array<std::size_t, most_search_terms> index_bit_ = {};
  Cloud cloud_;
};

void add(Cloud& all, const Cloud& part) {
  all.models += part.models;
  all.complete = all.complete && part.complete;
  for (std::size_t size = 0; size < part.sizes.size(); ++size) {
    const auto& from = part.sizes[size];
    auto& to = all.sizes[size];
    to.r2.resize(std::max(to.r2.size(), from.r2.size()));
    to.r2p.resize(to.r2.size());
    for (std::size_t i = 0; i < from.r2.size(); ++i) {
      to.r2[i] += from.r2[i];
      to.r2p[i] += from.r2p[i];
    }
  }
}

}  // namespace

Cloud exhaustive_search(const SearchProblem& problem, ModelPool& pool, const Branch& root,
                        CloudKind kind, SearchControl& control, int threads) {
  const auto free = terms_of(root.free);
  const int count = static_cast<int>(free.size());
  // One task for each choice among the first terms: some thousand models each.
  const int split = std::clamp(count - 12, 0, 8);
  const int tasks = 1 << split;

  Cloud cloud;
  cloud.sizes.resize(problem.terms + 1);
  if (kind == CloudKind::points)
    cloud.points.assign(std::size_t{1} << count, {std::nanf(""), std::nanf("")});
  std::mutex mutex;
  int done = 0;
  const auto work = [&](int task) {
    TermSet fixed = root.fixed, rest = root.free;
    for (int i = 0; i < split; ++i) {
      rest &= ~bit(free[i]);
      if (task >> i & 1) fixed |= bit(free[i]);
    }
    Walk walk(problem, pool, free, kind, control, cloud.points);
    walk.run(fixed, rest);
    const std::lock_guard lock(mutex);
    add(cloud, walk.cloud());
    ++done;
    control.report(cloud.models, root.bound, static_cast<double>(done) / tasks);
  };
  run_tasks(tasks, threads, work);
  cloud.skipped = std::ldexp(1.0, count) - cloud.models;
  return cloud;
}

}  // namespace wearwell
