#pragma once

#include <duckdb.h>

#include <functional>
#include <memory>
#include <string>

#include "wearwell/fleet/column_engine.h"

namespace wearwell::fleet {

/// Throws for what DuckDB says.
using DuckdbFailure = std::function<void(const std::string&)>;

/// As ColumnEngine has them. The connection is the scan's alone while it goes on.
std::unique_ptr<ColumnScan> duckdb_scan(duckdb_connection connection, const std::string& query,
                                        const DuckdbFailure& fail);
std::unique_ptr<ColumnEngine::Appender> duckdb_append(duckdb_connection connection,
                                                      const std::string& table,
                                                      const DuckdbFailure& fail);

}  // namespace wearwell::fleet
