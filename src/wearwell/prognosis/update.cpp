#include "wearwell/prognosis/update.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "wearwell/base/error.h"
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
  JoinedData joined = joined_data(state.source, tables_of(state.source, rows), repeated);
  StudyOfAllRows all{joined.source, nullptr};
  const auto study = read(all.source);
  const PosteriorStudy& of_all = require_posterior_study(*study);
  judge_new_data(of_all, state.posterior, joined);
  all.study =
      std::make_shared<const PosteriorStudy>(updated_study(of_all, std::move(joined), names));
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
