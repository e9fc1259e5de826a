#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace wearwell::fleet {

/// A database that does the computation.
enum class Dialect { duckdb, postgresql, clickhouse };

/// "duckdb", as in an option.
const char* name_of(Dialect dialect);
const std::vector<std::string>& dialect_names();
/// Throws InputError for another name.
Dialect read_dialect(const std::string& name);

/// A name quoted for a statement: `"cycle"`, `"a""b"`. Throws InputError for one that the engine
/// does not support: empty, with a zero byte, or (PostgreSQL) longer than 63 bytes, which it would
/// truncate.
std::string identifier(Dialect dialect, std::string_view name);
/// A table with its schemas, "fleet.cycles": each part is a name; a part in double quotes may
/// contain a dot. Throws InputError.
std::string table_identifier(Dialect dialect, std::string_view name);
/// Throws InputError for two column names that are the same for the engine: DuckDB does not
/// distinguish "T" from "t".
void refuse_alike(Dialect dialect, const std::vector<std::string>& names);
/// A text quoted for a statement: `'it''s'`.
std::string literal(Dialect dialect, std::string_view text);
/// A number that every engine reads as a double, with full precision: "1e0".
std::string number(double x);

/// Names of types.
struct Types {
  const char* text;
  const char* real;   ///< a double
  const char* whole;  ///< 64 bits
  const char* sum;    ///< a 128-bit integer
};
Types types(Dialect dialect);

/// Fixed point. A sum of doubles depends on the order of its summands, which parallel engines do
/// not keep; a sum of integers does not. So each summand is first rounded to an integer number of
/// units. `whole` gives one of 64 bits, `wide` one of 128 (in PostgreSQL of 15 digits); if a
/// summand does not fit, the engine ends the statement with an error. `sum_of` adds either without
/// overflow.
std::string whole(Dialect dialect, const std::string& real);
std::string wide(Dialect dialect, const std::string& real);
std::string sum_of(Dialect dialect, const std::string& fixed);
/// As a double.
std::string real(Dialect dialect, const std::string& fixed);
/// Seconds since 1970 of a date or a timestamp.
std::string seconds(Dialect dialect, const std::string& moment);
/// As text.
std::string text(Dialect dialect, const std::string& any);
/// exp of a non-positive number: PostgreSQL treats underflow as an error.
std::string decay(Dialect dialect, const std::string& exponent);

/// A comment of one line, whatever `text` contains.
std::string comment(std::string_view text);

}  // namespace wearwell::fleet
