#pragma once

#include <functional>

namespace wearwell {

/// Disconnects from an embedded DuckDB by `disconnect`, which must not throw. If the disconnecting
/// thread is handling an exception, DuckDB does not wait for its worker threads, which then use
/// freed memory (ClientContext::~ClientContext). So another thread disconnects. If none can be
/// started, the database stays open and its memory stays valid.
void close_duckdb(const std::function<void()>& disconnect);

}  // namespace wearwell
