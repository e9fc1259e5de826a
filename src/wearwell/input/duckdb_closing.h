#pragma once

#include <functional>

namespace wearwell {

/// Disconnects from a DuckDB within the program by `disconnect`, which must not throw. While an exception is on its
/// way through the thread that disconnects, DuckDB does not wait for the threads that work for it: they go on in memory
/// that is freed (ClientContext::~ClientContext). So that is left to a thread without one; where none is to be had the
/// database stays open, and what works for it has its memory.
void close_duckdb(const std::function<void()>& disconnect);

}  // namespace wearwell
