#pragma once

#include <string>

namespace wearwell {

/// What DuckDB says, as one sentence without its classes of errors and its options: "line 7:
/// 'oops' in column 'v' is no number, as the cells before it are".
std::string duckdb_sentence(const std::string& message);

}  // namespace wearwell
