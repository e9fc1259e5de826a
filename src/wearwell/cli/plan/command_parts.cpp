#include "wearwell/cli/plan/command_parts.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <optional>

#include "wearwell/base/printable.h"
#include "wearwell/present/page.h"
#include "wearwell/present/result_folder.h"

namespace wearwell::plan {

void add_answer_options(CLI::App& command, AnswerOptions& options) {
  command.add_option("-o,--output", options.output, "Folder for the page, tables and JSON");
  command.add_flag("--json", options.json, "Print one JSON object and nothing else");
}

int give_answer(const AnswerOptions& options, const std::function<Answer()>& work) {
  std::optional<ResultFolder> folder;
  if (!options.output.empty()) folder.emplace(options.output);
  const Answer answer = work();
  const std::string json = printable_json(answer.json.dump(2)) + "\n";
  if (folder) {
    folder->write("plan.json", json);
    for (const present::Table* table : present::tables(answer.sections))
      folder->write(fmt::format("tables/{}.csv", table->id), present::csv(*table));
    folder->write("report.html",
                  html_page({WEARWELL_VERSION, "Plan", answer.title, answer.sections}));
    folder->commit();
  }
  if (options.json) {
    fmt::print("{}", json);
  } else {
    fmt::print("{}", answer.text);
    if (folder) fmt::print("Results are in {}\n", options.output.string());
  }
  return answer.trusted ? 0 : 1;
}

}  // namespace wearwell::plan
