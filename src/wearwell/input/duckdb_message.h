#pragma once

#include <string>

namespace wearwell {

/// A DuckDB message as one sentence, without error classes and options: "line 7: 'oops' in column
/// 'v' is not a number, unlike the cells above it".
std::string duckdb_sentence(const std::string& message);

}  // namespace wearwell
