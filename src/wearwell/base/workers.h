#pragma once

#include <functional>

namespace wearwell {

/// `wanted`, or the number of hardware threads if it is 0.
int threads_or_all(int wanted);

/// Runs work(0), ..., work(threads - 1), each on its own thread (the first on the caller's), and
/// waits for all. Rethrows the exception of the lowest worker that threw, after all have finished.
/// Throws std::system_error if a thread cannot be started, after the started ones have finished.
void run_workers(int threads, const std::function<void(int)>& work);

/// Runs task(0), ..., task(count - 1) on up to `threads` threads, each taking the next free task.
/// After an exception no further task starts, and the exception is rethrown.
void run_tasks(int count, int threads, const std::function<void(int)>& task);

}  // namespace wearwell
