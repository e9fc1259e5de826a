#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "wearwell/input/source.h"
#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/new_data.h"
#include "wearwell/study/study.h"

namespace wearwell::prognosis {

/// Reads a study of any model.
using ReadStudy = std::function<std::unique_ptr<const Study>(const Source& source)>;

/// The study of a saved result with its old and its new rows.
struct StudyOfAllRows {
  Source source;  ///< with all rows, as read
  /// Its result has the check `new-data` and `update` in summary.json (updated_study.h).
  std::shared_ptr<const Study> study;
};

/// Joins new rows to the study that a fit saved: to the data, or for a clutch campaign to those of
/// its tables whose columns they have. Throws InputError as `joined_data` and `joined_campaign` do;
/// for a campaign also if `repeated` is given, because its repeated rows count once.
StudyOfAllRows study_of_all_rows(const CarriedState& state, const std::vector<NewRows>& rows,
                                 Repeated repeated, const ReadStudy& read);

/// "once", "another", or empty to ask. Throws InputError that begins with "--repeated".
Repeated repeated_named(const std::string& name);

/// state.bin of the result of such a study; empty if the model has written one among the files of
/// the result, as a clutch campaign does.
std::string state_of_all_rows(Source source, const Result& result);

/// How a result was fitted, by its summary.json: method, chains, warm-up, draws and seed. Empty for
/// a study without a sampler. `name`: of the file in messages. Throws InputError.
SamplerChoice sampler_of_summary(const nlohmann::ordered_json& summary,
                                 const std::filesystem::path& name);

}  // namespace wearwell::prognosis
