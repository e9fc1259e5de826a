#include "wearwell/study/result_writer.h"

#include <fmt/format.h>

#include "wearwell/base/printable.h"
#include "wearwell/present/section_json.h"

namespace wearwell {
namespace {

using Json = nlohmann::ordered_json;

std::string dumped(const Json& json, int indent) {
  return printable_json(json.dump(indent, ' ', false, Json::error_handler_t::replace)) + "\n";
}

}  // namespace

std::string summary_text(const Result& result) {
  return dumped(summary_json(result), 2);
}

void write_result(const Result& result, std::string_view study_text, ResultFolder& folder) {
  folder.write("summary.json", summary_text(result));
  for (const auto& [name, content] : result.files) folder.write(name, content);
  for (const present::Table* table : present::tables(result.sections))
    folder.write(fmt::format("tables/{}.csv", table->id), present::csv(*table));
  if (!result.sections.empty()) {
    folder.write("report.json", dumped(to_json(result.sections), -1));
    folder.write("report.html", report_html(result.header, result.sections));
  }
  if (!study_text.empty()) folder.write("study.toml", study_text);
  folder.commit();
}

}  // namespace wearwell
