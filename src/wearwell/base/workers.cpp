#include "wearwell/base/workers.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

#include "wearwell/base/stop_scope.h"

namespace wearwell {

int threads_or_all(int wanted) {
  return wanted > 0 ? wanted : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void run_workers(int threads, const std::function<void(int)>& work) {
  std::vector<std::exception_ptr> failures(threads);
  const auto guarded = [&, signal = current_stop_signal()](int worker) {
    try {
      const StopScope scope(signal);
      work(worker);
    } catch (...) {
      failures[worker] = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;  // join at the end of the scope
    for (int worker = 1; worker < threads; ++worker) others.emplace_back(guarded, worker);
    guarded(0);
  }
  for (const auto& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

void run_tasks(int count, int threads, const std::function<void(int)>& task) {
  std::atomic<int> next = 0;
  run_workers(std::min(threads, count), [&](int) {
    try {
      for (int i = next++; i < count; i = next++) task(i);
    } catch (...) {
      next = count;
      throw;
    }
  });
}

}  // namespace wearwell
