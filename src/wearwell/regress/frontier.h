#pragma once

#include <condition_variable>
#include <mutex>
#include <vector>

#include "wearwell/regress/search_control.h"
#include "wearwell/regress/search_problem.h"

namespace wearwell {

/// A branch of the search: models that contain all `fixed` and any of `free`.
struct Branch {
  TermSet fixed = 0;
  TermSet free = 0;
  double bound = 0;  ///< no model of the branch has a smaller score
};

/// The unvisited branches, smallest bound first, shared by all threads. A thread takes one,
/// searches part of it and returns the rest.
class Frontier {
 public:
  /// The search stops after `most_nodes` visited nodes.
  Frontier(const Branch& root, int threads, SearchControl& control, double most_nodes);

  /// The next branch for thread `worker`, waiting while others may still return some. False when
  /// the search is over: nothing left, or stopped.
  bool take(int worker, Branch& branch);
  void give_back(const Branch& branch);
  /// The thread has finished its branch, with `nodes` visited nodes.
  void done(int worker, double nodes);

  bool stopped() { return control_.stopped(); }
  /// Ends the search for every thread.
  void stop();

  double nodes() const { return nodes_; }
  /// The smallest bound of the remaining branches; infinity if there are none.
  double bound() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Branch> heap_;     ///< smallest bound first
  std::vector<double> working_;  ///< bound of the branch each thread works on; infinity if none
  double nodes_ = 0;
  const double most_nodes_;
  SearchControl& control_;
};

}  // namespace wearwell
