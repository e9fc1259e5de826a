#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/study/posterior_study.h"
#include "wearwell/study/result.h"

namespace wearwell::prognosis {

/// Where a study names a table: "data", or "conditions.profile".
struct TableSection {
  std::string path, file;  ///< of the section; as it names the file
  std::optional<std::string> sql = {};
  std::string as_read, before_sql;  ///< names in Source::tables (input/as_read.h)
};
std::vector<TableSection> table_sections(const TextFile& study);

/// The study with all tables that it names as they were read, and as they were before their sql: it is read again
/// from this alone. Paths are those that the study itself has. Throws InputError as reading does, and where the data
/// are not those any more that `study` was read from.
Source carried_source(const Source& source, const PosteriorStudy& study);

/// state.bin of a result that has a posterior; `source` is of `carried_source`. Nodes that together carry less than a
/// billionth are left out; where more than 20,000 remain they go without their cells, each at its own place.
CarriedState state_of_result(Source source, const Result& result);

}  // namespace wearwell::prognosis
