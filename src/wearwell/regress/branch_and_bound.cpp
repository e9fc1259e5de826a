#include "wearwell/regress/branch_and_bound.h"

#include <memory>

#include "wearwell/base/workers.h"
#include "wearwell/regress/moment_search.h"
#include "wearwell/regress/press_search.h"
#include "wearwell/regress/rss_search.h"

namespace wearwell {
namespace {

std::unique_ptr<BranchSearch> make_search(const SearchProblem& problem, ModelPool& pool,
                                          Frontier& frontier) {
  if (!problem.moments.empty()) return std::make_unique<MomentSearch>(problem, pool, frontier);
  if (problem.leave_one_out) return std::make_unique<PressSearch>(problem, pool, frontier);
  return std::make_unique<RssSearch>(problem, pool, frontier);
}

}  // namespace

void branch_and_bound(const SearchProblem& problem, ModelPool& pool, Frontier& frontier,
                      const Branch& root, int threads) {
  make_search(problem, pool, frontier)->offer_root(root);
  const auto work = [&](int worker) {
    try {
      const auto search = make_search(problem, pool, frontier);
      Branch branch;
      while (frontier.take(worker, branch)) frontier.done(worker, search->search(branch));
    } catch (...) {
      frontier.stop();  // the other threads would wait for this one
      throw;
    }
  };
  run_workers(threads, work);
}

}  // namespace wearwell
