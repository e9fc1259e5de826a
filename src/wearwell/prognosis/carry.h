#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/study/posterior_study.h"
#include "wearwell/study/result.h"

namespace wearwell::prognosis {

/// The place where a study names a table: "data", or "conditions.profile".
struct TableSection {
  std::string path, file;  ///< of the section; as the study writes it
  std::optional<std::string> sql = {};
  std::string as_read, before_sql;  ///< names in Source::tables (input/as_read.h)
};
std::vector<TableSection> table_sections(const TextFile& study);

/// The study with all its tables as read, and as they were before their sql: enough to read the
/// study again. Paths are those of the study. Throws InputError as reading does, and if the data
/// are no longer those that `study` was read from.
Source carried_source(const Source& source, const PosteriorStudy& study);

/// state.bin of a result with a posterior; `source` comes from `carried_source`. Leaves out nodes
/// that together have less than a billionth of the weight; where more than 20,000 remain it leaves
/// out the cells and keeps each node at its own position.
CarriedState state_of_result(Source source, const Result& result);

}  // namespace wearwell::prognosis
