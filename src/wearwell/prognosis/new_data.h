#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/data_roles.h"

namespace wearwell::prognosis {

/// What a row is that equals one that is there already. Of one thing at one place along its life it is the same
/// reading; of single tests it may be another test.
enum class Repeated { ask, once, another };

/// A reading that what is known already does not bear.
struct Contradiction {
  std::size_t row = 0;  ///< of the joined table, from 0
  std::string place, why;
};

/// A study with the data that it had and new ones.
struct JoinedData {
  Source source;  ///< rows in canonical order: by unit, along its life, then by what else they hold
  DataRoles roles;
  std::size_t before = 0, counted = 0, repeated = 0;  ///< rows of files
  std::vector<std::size_t> fresh =
      {};  ///< rows of the joined table that were not in it before, from 0
  std::vector<Contradiction> contradictions = {};  ///< another number at a place
  std::vector<std::string> notes = {};
};

/// Joins rows to the data of a study. What is known is a set of rows: the outcome is the same to the bit whatever came
/// first and however rows were parted. Where the study has an sql, new rows are of the file that it asks, and it is
/// asked anew. Throws InputError: columns, units or cells that do not fit, rows that may be repeated or other tests
/// (`ask`), an sql that does not give the same of the rows that were kept.
JoinedData joined_data(const Source& source, const std::vector<Table>& fresh, Repeated repeated);

/// The same of one table, whose rows in canonical order are given back; `joined.roles` are its own, counts are added to.
Table joined_table(const Table& was, const std::vector<Table>& fresh, Repeated repeated,
                   JoinedData& joined);

/// New rows in files, written as the study says of its own where the ending is the same.
Table read_new_data(const Source& source, const std::filesystem::path& file);

/// The table of the study's data.
const Table& data_table(const Source& source);

/// Whose a row is and where: "laser 5 at hours = 250".
std::string place_text(const Table& table, const DataRoles& roles, std::size_t row);

/// The rows in canonical order.
Table in_order(const Table& table, const DataRoles& roles);

}  // namespace wearwell::prognosis
