#include "wearwell/study/posterior_result.h"

#include <fmt/format.h>

#include <memory>

#include "wearwell/study/csv.h"
#include "wearwell/study/json.h"
#include "wearwell/study/long_tables.h"
#include "wearwell/study/posterior_report.h"
#include "wearwell/study/posterior_tables.h"
#include "wearwell/study/row_tables.h"
#include "wearwell/study/terminal.h"

namespace wearwell {

Result posterior_result(PosteriorSummary summary) {
  const auto shared = std::make_shared<const PosteriorSummary>(std::move(summary));
  const PosteriorSummary& s = *shared;
  Result result;
  result.header = {.version = s.version,
                   .title = s.title,
                   .model = s.model,
                   .equation = s.equation,
                   .data = {{s.data_file}, s.data_rows, s.data_fingerprint, s.data_remarks},
                   .seed = s.seed,
                   .trusted = s.trusted,
                   .checks = s.checks};
  result.body = posterior_json(s);
  for (std::size_t c = 0; c < s.posterior_draws.size(); ++c)
    result.files.emplace_back(fmt::format("draws_{}.csv", c + 1), draws_csv(s, c));
  result.files.emplace_back("predictions.csv", predictions_csv(s));
  for (auto& table : long_tables(s)) result.files.push_back(std::move(table));
  if (s.plots) {
    result.sections = report_sections(s);
  } else {  // the terminal output names these files
    const auto add = [&](const present::Table& table) {
      result.files.emplace_back(fmt::format("tables/{}.csv", table.id), present::csv(table));
    };
    if (s.pointwise) add(pointwise_table(*s.pointwise));
    if (!s.stages.empty()) add(stage_table(s));
    if (s.coverage) add(coverage_table(*s.coverage));
    for (const auto& [section, blocks] : s.added.blocks) {
      const std::vector<present::Section> sections = {{section, "", blocks}};
      for (const present::Table* table : present::tables(sections)) add(*table);
    }
  }
  result.text = [shared](const TerminalStyle& style) { return terminal_summary(*shared, style); };
  result.posterior = shared;
  return result;
}

}  // namespace wearwell
