#pragma once

#include <functional>

namespace wearwell {

/// `wanted`, or where that is 0 as many as the machine runs at once.
int threads_or_all(int wanted);

/// Runs work(0), ..., work(threads - 1), each on a thread of its own (the first on the caller's), and
/// waits for all. Rethrows the exception of the lowest worker that threw; the others run to their
/// end. Throws std::system_error when the machine gives no more threads, after those that did start
/// have ended.
void run_workers(int threads, const std::function<void(int)>& work);

/// Runs task(0), ..., task(count - 1) on up to `threads` threads, each taking the next that nobody
/// took. After an exception no task is started any more; it is rethrown.
void run_tasks(int count, int threads, const std::function<void(int)>& task);

}  // namespace wearwell
