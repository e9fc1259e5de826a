#include "wearwell/models/clutch/kept_sums.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell::clutch {
namespace {

/// The number of replicates in columns v1, v2, ...
std::size_t replicates_of(const std::vector<std::string>& columns) {
  return static_cast<std::size_t>(
      std::count_if(columns.begin(), columns.end(), [](const std::string& name) {
        return name.size() > 1 && name[0] == 'v' &&
               std::isdigit(static_cast<unsigned char>(name[1])) != 0;
      }));
}

/// The existing table: its columns, and the number of those in its key.
struct Layout {
  std::vector<std::string> columns;
  std::size_t key = 0;
};

Layout layout_of(fleet::Engine& engine, const ClutchSql& sql) {
  Layout found;
  bool exists = true;
  if (!sql.exists.empty())
    engine.rows(sql.exists, 0, [&](const fleet::Row& row) { exists = row.numbers[0] != 0; });
  if (!exists) return found;
  const bool described = !sql.exists.empty();
  engine.rows(sql.layout, described ? 2 : 1, [&](const fleet::Row& row) {
    found.columns.push_back(row.texts[0]);
    if (!described) found.key += row.numbers[0] != 0;
  });
  return found;
}

}  // namespace

void refuse_other_layout(fleet::Engine& engine, const ClutchSql& sql, const std::string& prefix) {
  Layout found = layout_of(engine, sql);
  if (found.columns.empty()) return;
  const std::string where = fmt::format("{}: the sums kept in {}_sums", engine.source(), prefix);
  const bool duckdb = engine.dialect() == fleet::Dialect::duckdb;
  const char* elsewhere = duckdb ? "into another file (--state)" : "under another --prefix";
  const std::size_t here = replicates_of(sql.columns), there = replicates_of(found.columns);
  if ((here > 0) != (there > 0))
    throw InputError(
        fmt::format("{} were made {} --scatter-only{}: continue with the same option, or sum all "
                    "cycles again, {}",
                    where, there > 0 ? "without" : "with",
                    here > 0 ? "" : ", or for a model that has replicates", elsewhere));
  if (here != there)
    throw InputError(
        fmt::format("{} are of a model of {} replicates, and this one has {}: sum all cycles {}",
                    where, there, here, elsewhere));
  std::vector<std::string> wanted = sql.columns;
  for (auto* each : {&wanted, &found.columns}) std::sort(each->begin(), each->end());
  constexpr std::size_t key = 2;  // model and unit
  const bool keyed = engine.dialect() != fleet::Dialect::clickhouse;
  if (wanted != found.columns || (keyed && found.key != key))
    throw InputError(
        fmt::format("{} have the layout of another version of wearwell and cannot be continued: "
                    "sum all cycles again, {}",
                    where, elsewhere));
}

void refuse_others(fleet::Engine& engine, const ClutchSql& sql, const std::string& model,
                   const std::string& prefix) {
  engine.rows(sql.others, 1, [&](const fleet::Row& row) {
    if (engine.dialect() != fleet::Dialect::duckdb)
      throw InputError(
          fmt::format("{}: {}_sums has sums of this table by other columns or units (--columns): "
                      "continue with those, or sum all cycles again, under another --prefix",
                      engine.source(), prefix));
    throw InputError(
        fmt::format("{}: --state has the sums of another model ({}; this is {}) and cannot be "
                    "continued: sum all cycles again, into another file",
                    engine.source(), printable(row.texts.front()), model));
  });
}

void refuse_late(fleet::Engine& engine, const ClutchSql& sql) {
  engine.rows(sql.late, 1, [&](const fleet::Row& row) {
    throw InputError(fmt::format(
        "{}: unit {} has {:.0f} cycles up to the last counted one, but {:.0f} were counted: rows "
        "came late or were removed; sum all cycles again, {}",
        engine.source(), printable(row.texts.front()), row.numbers[0], row.numbers[1],
        engine.dialect() == fleet::Dialect::duckdb ? "without --state" : "under another --prefix"));
  });
}

}  // namespace wearwell::clutch
