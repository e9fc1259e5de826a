#include "wearwell/fleet/dialect.h"

#include <fmt/format.h>

#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/replace.hpp>
#include <locale>
#include <map>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell::fleet {

const char* name_of(Dialect dialect) {
  static constexpr const char* names[] = {"duckdb", "postgresql", "clickhouse"};
  return names[static_cast<int>(dialect)];
}

const std::vector<std::string>& dialect_names() {
  static const std::vector<std::string> names = {"duckdb", "postgresql", "clickhouse"};
  return names;
}

Dialect read_dialect(const std::string& name) {
  for (const Dialect each : {Dialect::duckdb, Dialect::postgresql, Dialect::clickhouse}) {
    if (name == name_of(each)) return each;
  }
  throw InputError(fmt::format("'{}' is unknown; use 'duckdb', 'postgresql' or 'clickhouse'",
                               printable(shortened(name))));
}

std::string identifier(Dialect dialect, std::string_view name) {
  constexpr std::size_t postgresql_most = 63;
  if (name.empty()) throw InputError("the name of a table or column is empty");
  if (name.find('\0') != std::string_view::npos)
    throw InputError(fmt::format("the name '{}' has a zero byte", printable(name)));
  if (dialect == Dialect::postgresql && name.size() > postgresql_most)
    throw InputError(fmt::format("the name '{}' has {} bytes; PostgreSQL cuts names off at {}",
                                 printable(name), name.size(), postgresql_most));
  std::string inside(name);
  if (dialect == Dialect::clickhouse) {
    boost::algorithm::replace_all(inside, "\\", "\\\\");
    boost::algorithm::replace_all(inside, "\"", "\\\"");
  } else {
    boost::algorithm::replace_all(inside, "\"", "\"\"");
  }
  return '"' + inside + '"';
}

std::string table_identifier(Dialect dialect, std::string_view name) {
  std::string out, part;
  bool quoted = false, was_quoted = false;
  const auto finish = [&] {
    out += (out.empty() ? "" : ".") + identifier(dialect, part);
    part.clear();
    was_quoted = false;
  };
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    if (quoted && c == '"' && i + 1 < name.size() && name[i + 1] == '"') {
      part += c;
      ++i;
    } else if (c == '"' && (quoted || part.empty()) && !(was_quoted && !quoted)) {
      quoted = !quoted;
      was_quoted = true;
    } else if (c == '.' && !quoted) {
      finish();
    } else if (was_quoted && !quoted) {
      throw InputError(fmt::format("'{}' is not a table name: '{}' follows a closing quote",
                                   printable(name), printable(std::string(1, c))));
    } else {
      part += c;
    }
  }
  if (quoted)
    throw InputError(
        fmt::format("'{}' is not a table name: it has an unclosed quote", printable(name)));
  finish();
  return out;
}

void refuse_alike(Dialect dialect, const std::vector<std::string>& names) {
  if (dialect != Dialect::duckdb) return;
  std::map<std::string, std::string> seen;
  for (const std::string& name : names) {
    const auto at =
        seen.emplace(boost::algorithm::to_lower_copy(name, std::locale::classic()), name).first;
    if (at->second != name)
      throw InputError(
          fmt::format("the columns '{}' and '{}' are the same name for DuckDB, which ignores case: "
                      "rename one of them (--columns)",
                      printable(at->second), printable(name)));
  }
}

std::string literal(Dialect dialect, std::string_view text) {
  if (text.find('\0') != std::string_view::npos)
    throw InputError(fmt::format("the text '{}' has a zero byte", printable(text)));
  std::string inside(text);
  if (dialect == Dialect::clickhouse) {
    boost::algorithm::replace_all(inside, "\\", "\\\\");
    boost::algorithm::replace_all(inside, "'", "\\'");
    return "'" + inside + "'";
  }
  boost::algorithm::replace_all(inside, "'", "''");
  if (dialect == Dialect::duckdb || inside.find('\\') == std::string::npos)
    return "'" + inside + "'";
  // For any standard_conforming_strings.
  boost::algorithm::replace_all(inside, "\\", "\\\\");
  return " E'" + inside + "'";
}

std::string number(double x) {
  std::string text = fmt::format("{}", x);
  if (text.find('e') == std::string::npos) text += "e0";
  return x < 0 ? "(" + text + ")" : text;
}

Types types(Dialect dialect) {
  switch (dialect) {
    case Dialect::duckdb:
      return {"varchar", "double", "bigint", "hugeint"};
    case Dialect::postgresql:
      return {"text", "double precision", "bigint", "numeric"};
    case Dialect::clickhouse:
      break;
  }
  return {"String", "Float64", "Int64", "Decimal(38, 0)"};
}

std::string whole(Dialect dialect, const std::string& real) {
  if (dialect == Dialect::clickhouse)
    return fmt::format("toInt64(round({0}) + throwIf(not (abs({0}) < 9.2e18)))", real);
  return fmt::format("cast({} as bigint)", real);  // which rounds
}

std::string wide(Dialect dialect, const std::string& real) {
  if (dialect == Dialect::clickhouse)
    return fmt::format("toDecimal128(round({0}) + throwIf(not (abs({0}) < 1e36)), 0)", real);
  return fmt::format("cast(round({}) as {})", real, types(dialect).sum);
}

std::string sum_of(Dialect dialect, const std::string& fixed) {
  if (dialect == Dialect::clickhouse) return fmt::format("sum(toDecimal128({}, 0))", fixed);
  return fmt::format("sum({})", fixed);
}

std::string real(Dialect dialect, const std::string& fixed) {
  if (dialect == Dialect::clickhouse) return fmt::format("toFloat64({})", fixed);
  return fmt::format("cast({} as {})", fixed, types(dialect).real);
}

std::string seconds(Dialect dialect, const std::string& moment) {
  switch (dialect) {
    case Dialect::duckdb:
      return fmt::format("cast(epoch({}) as double)", moment);
    case Dialect::postgresql:
      return fmt::format("cast(extract(epoch from {}) as double precision)", moment);
    case Dialect::clickhouse:
      break;
  }
  return fmt::format("toFloat64(toUInt32(toDateTime({}, 'UTC')))", moment);
}

std::string text(Dialect dialect, const std::string& any) {
  if (dialect == Dialect::clickhouse) return fmt::format("toString({})", any);
  return fmt::format("cast({} as {})", any, types(dialect).text);
}

std::string decay(Dialect dialect, const std::string& exponent) {
  if (dialect == Dialect::postgresql) return fmt::format("exp(greatest({}, -700e0))", exponent);
  return fmt::format("exp({})", exponent);
}

std::string comment(std::string_view text) {
  return "-- " + printable(text) + "\n";
}

}  // namespace wearwell::fleet
