#include "wearwell/regress/frontier.h"

#include <algorithm>

#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

bool later(const Branch& a, const Branch& b) {
  return a.bound > b.bound;
}

}  // namespace

Frontier::Frontier(const Branch& root, int threads, SearchControl& control, double most_nodes)
    : heap_{root}, working_(threads, infinity), most_nodes_(most_nodes), control_(control) {}

bool Frontier::take(int worker, Branch& branch) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] {
    return control_.stopped() || !heap_.empty() ||
           std::all_of(working_.begin(), working_.end(), [](double b) { return b == infinity; });
  });
  if (control_.stopped() || heap_.empty()) return false;
  std::pop_heap(heap_.begin(), heap_.end(), later);
  branch = heap_.back();
  heap_.pop_back();
  working_[worker] = branch.bound;
  return true;
}

void Frontier::give_back(const Branch& branch) {
  const std::lock_guard lock(mutex_);
  heap_.push_back(branch);
  std::push_heap(heap_.begin(), heap_.end(), later);
  changed_.notify_one();
}

void Frontier::done(int worker, double nodes) {
  double all, least;
  {
    const std::lock_guard lock(mutex_);
    working_[worker] = infinity;
    all = nodes_ += nodes;
    if (all >= most_nodes_) control_.stop();
    changed_.notify_all();
  }
  least = bound();
  control_.report(all, least, 0);
}

void Frontier::stop() {
  const std::lock_guard lock(mutex_);
  control_.stop();
  changed_.notify_all();
}

double Frontier::bound() const {
  const std::lock_guard lock(mutex_);
  double least = heap_.empty() ? infinity : heap_.front().bound;
  for (const double bound : working_) least = std::min(least, bound);
  return least;
}

}  // namespace wearwell
