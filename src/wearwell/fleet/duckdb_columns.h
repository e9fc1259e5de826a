#pragma once

#include <duckdb.h>

#include <functional>
#include <memory>
#include <string>

#include "wearwell/fleet/column_engine.h"

namespace wearwell::fleet {

/// Throws DuckDB's error.
using DuckdbFailure = std::function<void(const std::string&)>;

/// As in ColumnEngine. The connection belongs to the scan while it runs.
std::unique_ptr<ColumnScan> duckdb_scan(duckdb_connection connection, const std::string& query,
                                        const DuckdbFailure& fail);
std::unique_ptr<ColumnEngine::Appender> duckdb_append(duckdb_connection connection,
                                                      const std::string& table,
                                                      const DuckdbFailure& fail);

}  // namespace wearwell::fleet
