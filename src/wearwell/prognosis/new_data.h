#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/data_roles.h"

namespace wearwell::prognosis {

/// Meaning of a row that equals an earlier one. For one unit at one place on the axis it is the
/// same reading; for single tests it may be another test.
enum class Repeated { ask, once, another };

/// New rows: a file, or a table in memory whose `source` is its name.
using NewRows = std::variant<std::filesystem::path, Table>;

/// A reading that contradicts the present posterior.
struct Contradiction {
  std::size_t row = 0;  ///< of the joined table, from 0
  std::string place, why;
};

/// A study with its old and new data.
struct JoinedData {
  Source source;  ///< rows in canonical order: by unit, along the axis, then by the other columns
  DataRoles roles;
  std::size_t before = 0, counted = 0, repeated = 0;  ///< rows of files
  std::vector<std::size_t> fresh = {};  ///< rows of the joined table that are new, from 0
  std::vector<Contradiction> contradictions = {};  ///< another value at a known place
  std::vector<std::string> notes = {};
};

/// Joins rows to the data of a study. The data are a set of rows: the outcome is the same to the
/// bit for any order and any division of the rows. Where the study has an sql, new rows belong to
/// the file that the query reads, and the query runs again. Throws InputError: columns, units or
/// cells that do not fit; rows that may be repeats or other tests (`ask`); an sql that gives
/// another result on the saved rows.
JoinedData joined_data(const Source& source, const std::vector<Table>& fresh, Repeated repeated);

/// The same for one table; returns its rows in canonical order; `joined.roles` are its own, counts
/// are incremented.
Table joined_table(const Table& was, const std::vector<Table>& fresh, Repeated repeated,
                   JoinedData& joined);

/// New rows in files, read with the format of the study's own files where the extension is the
/// same.
Table read_new_data(const Source& source, const std::filesystem::path& file);

/// The table of the study's data.
const Table& data_table(const Source& source);

/// Unit and place: "laser 5 at hours = 250".
std::string place_text(const Table& table, const DataRoles& roles, std::size_t row);

/// The rows in canonical order.
Table in_order(const Table& table, const DataRoles& roles);

}  // namespace wearwell::prognosis
