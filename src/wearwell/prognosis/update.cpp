#include "wearwell/prognosis/update.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/json_reader.h"
#include "wearwell/prognosis/carry.h"
#include "wearwell/prognosis/joined_campaign.h"
#include "wearwell/prognosis/updated_study.h"
#include "wearwell/study/inference_data.h"

namespace wearwell::prognosis {
namespace {

// A campaign has no posterior: its run fits all rows, and the new ones are reported afterwards.
class CampaignOfAllRows : public Study {
 public:
  CampaignOfAllRows(std::unique_ptr<const Study> study, JoinedData joined, std::string names)
      : study_(std::move(study)), joined_(std::move(joined)), names_(std::move(names)) {}

  std::string description() const override { return study_->description(); }

  Result run(const RunOptions& options, const Monitor& monitor) const override {
    Result result = study_->run(options, monitor);
    add_new_data(joined_, names_, result);
    return result;
  }

 private:
  std::unique_ptr<const Study> study_;
  JoinedData joined_;
  std::string names_;
};

// An improper posterior gives no additions of a study, but what became of the rows is known.
class PosteriorOfAllRows : public PosteriorStudy {
 public:
  PosteriorOfAllRows(PosteriorStudy study, nlohmann::ordered_json rows)
      : PosteriorStudy(std::move(study)), rows_(std::move(rows)) {}

  Result run(const RunOptions& options, const Monitor& monitor) const override {
    Result result = PosteriorStudy::run(options, monitor);
    if (!result.body.contains("update")) result.body["update"] = rows_;
    return result;
  }

 private:
  nlohmann::ordered_json rows_;
};

std::string names_of(const std::vector<NewRows>& rows) {
  std::vector<std::string> names;
  for (const NewRows& each : rows) {
    const auto* const file = std::get_if<std::filesystem::path>(&each);
    names.push_back(file ? valid_utf8(file->filename().string()) : std::get<Table>(each).source);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

std::vector<Table> tables_of(const Source& source, const std::vector<NewRows>& rows) {
  std::vector<Table> tables;
  for (const NewRows& each : rows) {
    const auto* const file = std::get_if<std::filesystem::path>(&each);
    tables.push_back(file ? read_new_data(source, *file) : std::get<Table>(each));
  }
  return tables;
}

// "seal" of "scale[seal]"; empty for another parameter.
std::string level_of(const std::string& parameter) {
  const std::size_t open = parameter.find('[');
  return open == parameter.npos || parameter.back() != ']'
             ? ""
             : parameter.substr(open + 1, parameter.size() - open - 2);
}

// Whether a cell is the word, or has it among several: "A|B".
bool holds(const Column& column, std::size_t row, const std::string& word) {
  if (column.is_number) return false;
  std::istringstream cell(column.text[row]);
  for (std::string part; std::getline(cell, part, '|');) {
    const std::size_t first = part.find_first_not_of(' ');
    if (first != part.npos && part.substr(first, part.find_last_not_of(' ') - first + 1) == word)
      return true;
  }
  return false;
}

// The first new row that has the word, and the column.
std::optional<std::pair<std::size_t, std::string>> first_with(const JoinedData& joined,
                                                              const std::string& word) {
  const Table& table = data_table(joined.source);
  for (const std::size_t row : joined.fresh) {
    for (const Column& column : table.columns)
      if (holds(column, row, word)) return std::pair{row, column.name};
  }
  return {};
}

std::string row_in_file(const std::vector<Table>& tables, const std::string& column,
                        const std::string& word) {
  for (const Table& table : tables) {
    for (const Column& each : table.columns) {
      for (std::size_t row = 0; each.name == column && row < table.rows; ++row)
        if (holds(each, row, word)) return place(table, column, row);
    }
  }
  return fmt::format("column '{}'", column);
}

// A word that no earlier row has, such as a failure mode, adds parameters that the earlier posterior
// does not know: it may be misspelt.
void report_new_words(const std::vector<std::string>& before, const PosteriorStudy& study,
                      const std::vector<Table>& tables, JoinedData& joined) {
  std::vector<std::string> known;
  std::map<std::string, std::vector<std::string>> added;
  for (const std::string& each : before)
    if (const std::string level = level_of(each); !level.empty()) known.push_back(level);
  for (const Parameter& each : study.parameters) {
    const std::string level = level_of(each.name);
    if (!level.empty() && std::find(known.begin(), known.end(), level) == known.end())
      added[level].push_back(each.name);
  }
  for (const auto& [word, parameters] : added) {
    const auto at = first_with(joined, word);
    if (!at) continue;
    joined.contradictions.push_back({at->first, row_in_file(tables, at->second, word),
                                     fmt::format("no earlier row has '{}', which adds {}{}", word,
                                                 fmt::join(parameters, " and "),
                                                 known.empty() ? "" : did_you_mean(word, known))});
  }
}

}  // namespace

Repeated repeated_named(const std::string& name) {
  if (name.empty()) return Repeated::ask;
  if (name == "once") return Repeated::once;
  if (name == "another") return Repeated::another;
  throw InputError(fmt::format("--repeated: {} is neither 'once' nor 'another'", printable(name)));
}

StudyOfAllRows study_of_all_rows(const CarriedState& state, const std::vector<NewRows>& rows,
                                 Repeated repeated, const ReadStudy& read) {
  const std::string names = names_of(rows);
  if (state.parameters.empty()) {
    if (repeated != Repeated::ask)
      throw InputError("--repeated: a repeated row of a campaign counts once");
    JoinedData joined = joined_campaign(state.source, rows);
    StudyOfAllRows all{joined.source, nullptr};
    all.study =
        std::make_shared<const CampaignOfAllRows>(read(all.source), std::move(joined), names);
    return all;
  }
  const std::vector<Table> tables = tables_of(state.source, rows);
  JoinedData joined = joined_data(state.source, tables, repeated);
  StudyOfAllRows all{joined.source, nullptr};
  const auto study = read(all.source);
  const PosteriorStudy& of_all = require_posterior_study(*study);
  judge_new_data(of_all, state.posterior, joined);
  report_new_words(state.parameters, of_all, tables, joined);
  nlohmann::ordered_json of_rows = rows_json(joined, names);
  all.study = std::make_shared<const PosteriorOfAllRows>(
      updated_study(of_all, std::move(joined), names), std::move(of_rows));
  return all;
}

std::string state_of_all_rows(Source source, const Result& result) {
  if (!result.posterior) return {};
  return state_bytes(state_of_result(std::move(source), result));
}

SamplerChoice sampler_of_summary(const nlohmann::ordered_json& summary,
                                 const std::filesystem::path& name) {
  constexpr std::int64_t most = 1'000'000'000;
  SamplerChoice choice;
  const auto sampler = JsonReader(summary, name).find("sampler");
  if (!sampler) return choice;
  const std::string method = sampler->at("method").one_of({"exact", "nuts", "metropolis"});
  choice.method = method == "exact"  ? Method::exact
                  : method == "nuts" ? Method::nuts
                                     : Method::metropolis;
  choice.chains = static_cast<int>(sampler->at("chains").integer(1, max_chains));
  if (choice.method != Method::exact)
    choice.warmup = static_cast<int>(sampler->at("warmup").integer(0, most));
  choice.draws = static_cast<int>(sampler->at("draws").integer(1, most));
  choice.seed = sampler->at("seed").natural();
  return choice;
}

}  // namespace wearwell::prognosis
