#include "wearwell/prognosis/joined_campaign.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <string>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/as_read.h"
#include "wearwell/input/heading.h"

namespace wearwell::prognosis {
namespace {

// Roles of a table's columns in a campaign, by the campaign's names.
struct KindOfTable {
  const char* key;
  std::vector<std::string> columns;
  std::optional<std::string> unit;
  std::string axis;
  std::vector<std::string> measured;
};

const std::vector<KindOfTable>& kinds() {
  static const std::vector<KindOfTable> all = {
      {"design",
       {"point", "role", "slip_speed", "torque", "temperature", "closing_time"},
       std::nullopt,
       "point",
       {}},
      {"cycles",
       {"plate", "cycle", "slip_speed", "torque", "temperature", "closing_time", "energy"},
       "plate",
       "cycle",
       {"energy"}},
      {"weighings", {"plate", "cycle", "block", "mass"}, "plate", "cycle", {"mass"}},
      {"traces",
       {"plate", "time", "slip_speed", "torque", "temperature"},
       "plate",
       "time",
       {"torque"}}};
  return all;
}

// A table as the study names it and the state stores it.
struct CampaignTable {
  const KindOfTable* kind = nullptr;
  std::string name;  ///< in Source::tables
  TableSettings settings;
  DataRoles roles = {};
  std::vector<Table> fresh = {};
};

DataRoles roles_of(const KindOfTable& kind, const std::optional<TomlReader>& columns,
                   const Table& table) {
  DataRoles roles;
  roles.noun = kind.unit.value_or("row");
  roles.one = !kind.unit;
  for (const std::string& name : kind.columns) {
    DataRoles::Named named{name, name};
    if (columns && columns->has(name)) named = named_column(*columns, name);
    named.column = table.column(named.column).name;
    if (name == kind.unit) roles.unit = named.column;
    if (name == kind.axis) roles.axis = named.column;
    if (name == kind.unit || name == "role" || name == "block") roles.words.push_back(named.column);
    if (std::find(kind.measured.begin(), kind.measured.end(), name) != kind.measured.end())
      roles.measured.push_back(named.column);
    roles.used.push_back(std::move(named));
  }
  return roles;
}

std::vector<CampaignTable> tables_of(const Source& source) {
  const TomlReader data = TomlReader::parse(source.study).required_table("data");
  std::vector<CampaignTable> tables;
  for (const KindOfTable& kind : kinds()) {
    if (!data.has(kind.key)) continue;
    const bool is_name = data.is_text(kind.key);
    const TomlReader section = is_name ? data : data.required_table(kind.key);
    CampaignTable table{&kind, is_name ? section.required_text(kind.key) : as_read_name(section),
                        read_table_settings(section)};
    const auto kept = source.tables.find(table.name);
    if (kept == source.tables.end())
      throw InputError(fmt::format("the state has no table of data.{}", kind.key));
    table.roles = roles_of(kind, is_name ? std::nullopt : section.table("columns"), kept->second);
    tables.push_back(std::move(table));
  }
  return tables;
}

bool has(const Table& table, const std::string& name) {
  return std::ranges::any_of(table.columns, [&](const Column& each) {
    return each.name == name || read_heading(each.name, "").name == name;
  });
}

// Its columns that a table lacks, by the table's headings or by the campaign's names.
std::vector<std::string> missing(const CampaignTable& kept, const Table& table) {
  std::vector<std::string> names;
  for (const DataRoles::Named& each : kept.roles.used)
    if (!has(table, each.column) && !has(table, read_heading(each.column, "").name) &&
        !has(table, each.name))
      names.push_back(each.column);
  return names;
}

// Adds rows to the table whose columns they have; a file is read again only for tables in another format.
void add_rows(const NewRows& rows, std::vector<CampaignTable>& tables) {
  const auto* const file = std::get_if<std::filesystem::path>(&rows);
  std::vector<std::string> why;
  CampaignTable* of = nullptr;
  const TableSettings* settings = nullptr;
  Table table = file ? Table{} : std::get<Table>(rows), read;
  for (CampaignTable& each : tables) {
    if (file && (!settings || *settings != each.settings))
      table = wearwell::read_table(*file, {}, {}, each.settings);
    settings = &each.settings;
    const std::vector<std::string> names = missing(each, table);
    if (!names.empty()) {
      why.push_back(fmt::format("{} ({})", each.kind->key, fmt::join(names, ", ")));
      continue;
    }
    if (of)
      throw InputError(
          fmt::format("{} has all columns of both {} and {}: leave out the columns of one",
                      table.source, of->kind->key, each.kind->key));
    of = &each;
    read = table;
  }
  if (!of)
    throw InputError(fmt::format("{} is not a table of this campaign; it lacks of {}",
                                 file ? valid_utf8(file->string()) : table.source,
                                 fmt::join(why, ", of ")));
  of->fresh.push_back(std::move(read));
}

}  // namespace

JoinedData joined_campaign(const Source& source, const std::vector<NewRows>& rows) {
  std::vector<CampaignTable> tables = tables_of(source);
  for (const NewRows& each : rows) add_rows(each, tables);
  JoinedData joined{source, {}};
  std::vector<std::size_t> fresh;
  for (const CampaignTable& each : tables) {
    joined.roles = each.roles;
    joined.fresh.clear();  // rows of the table before
    joined.source.tables[each.name] =
        joined_table(source.tables.at(each.name), each.fresh, Repeated::once, joined);
    fresh.insert(fresh.end(), joined.fresh.begin(), joined.fresh.end());
  }
  joined.fresh = std::move(fresh);
  return joined;
}

}  // namespace wearwell::prognosis
