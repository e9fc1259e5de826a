#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace wearwell::fleet {

/// A database that computes.
enum class Dialect { duckdb, postgresql, clickhouse };

/// "duckdb", as an option has it.
const char* name_of(Dialect dialect);
const std::vector<std::string>& dialect_names();
/// Throws InputError for another name.
Dialect read_dialect(const std::string& name);

/// A name as it stands in a statement, whatever is in it: `"cycle"`, `"a""b"`. Throws InputError for
/// one that the engine cannot hold: empty, with a zero byte, or (PostgreSQL) longer than 63 bytes,
/// which it would cut.
std::string identifier(Dialect dialect, std::string_view name);
/// A table with the schemas it lies in, "fleet.cycles": each part is a name; a part in double quotes
/// may hold a dot. Throws InputError.
std::string table_identifier(Dialect dialect, std::string_view name);
/// Throws InputError for two names of columns that the engine takes for one: DuckDB does not tell "T" from "t".
void refuse_alike(Dialect dialect, const std::vector<std::string>& names);
/// A text as a statement has it: `'it''s'`.
std::string literal(Dialect dialect, std::string_view text);
/// A number that every engine reads as a double, with all its digits: "1e0".
std::string number(double x);

/// Names of types.
struct Types {
  const char* text;
  const char* real;   ///< a double
  const char* whole;  ///< 64 bits
  const char* sum;    ///< a whole number of 128 bits
};
Types types(Dialect dialect);

/// Fixed point. A sum of doubles depends on the order of its summands, which no engine that works in
/// parallel keeps; a sum of whole numbers does not. So each summand is rounded to a whole number of
/// units first. `whole` gives one of 64 bits, `wide` one of 128 (in PostgreSQL of 15 digits); where a summand does not fit
/// the engine ends the statement with an error. `sum_of` adds either up without overflow.
std::string whole(Dialect dialect, const std::string& real);
std::string wide(Dialect dialect, const std::string& real);
std::string sum_of(Dialect dialect, const std::string& fixed);
/// As a double.
std::string real(Dialect dialect, const std::string& fixed);
/// Seconds since 1970 of a date or a time.
std::string seconds(Dialect dialect, const std::string& moment);
/// As text.
std::string text(Dialect dialect, const std::string& any);
/// exp of a number that is not positive: PostgreSQL takes a result too small for a double for an
/// error.
std::string decay(Dialect dialect, const std::string& exponent);

/// A comment of one line: whatever is in `text`, it does not end.
std::string comment(std::string_view text);

}  // namespace wearwell::fleet
