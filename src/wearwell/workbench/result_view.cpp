#include "wearwell/workbench/result_view.h"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <system_error>
#include <variant>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/text_file.h"
#include "wearwell/present/section.h"
#include "wearwell/prognosis/asked_life.h"
#include "wearwell/study/header_json.h"
#include "wearwell/study/saved_result.h"
#include "wearwell/workbench/advice_changes.h"
#include "wearwell/workbench/changed_prediction.h"
#include "wearwell/workbench/command_line.h"
#include "wearwell/workbench/folder_files.h"
#include "wearwell/workbench/python_line.h"

namespace wearwell::workbench {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t most_rows = 200;

ordered_json table_texts(const present::Table& table) {
  ordered_json json = {{"id", table.id},
                       {"caption", table.caption},
                       {"all", table.rows.size()},
                       {"columns", ordered_json::array()},
                       {"rows", ordered_json::array()}};
  for (const present::Column& each : table.columns)
    json["columns"].push_back(present::heading(each));
  for (const auto& row : table.rows) {
    if (json["rows"].size() == most_rows) break;
    ordered_json cells = ordered_json::array();
    for (std::size_t c = 0; c < row.size(); ++c)
      cells.push_back(present::description(row[c], table.columns[c]));
    json["rows"].push_back(std::move(cells));
  }
  return json;
}

// The sentences and key figures of a section.
void add_summary(const std::vector<present::Block>& blocks, ordered_json& json) {
  for (const present::Block& block : blocks) {
    const auto* prose = std::get_if<present::Prose>(&block.content);
    if (prose && prose->lead) json["leads"].push_back(prose->text);
    const auto* tiles = std::get_if<present::Tiles>(&block.content);
    if (!tiles) continue;
    for (const html::Tile& each : tiles->tiles)
      json["tiles"].push_back(
          {{"name", each.name}, {"value", each.value}, {"unit", each.unit}, {"note", each.note}});
  }
}

// Whether there is a posterior to ask, or why not.
void add_lives(const std::filesystem::path& folder, Models models, ordered_json& json) {
  json["lives"] = false;
  std::error_code error;
  if (!std::filesystem::is_regular_file(folder / "state.bin", error)) return;
  const std::string name = folder.filename().string();
  try {
    const prognosis::CarriedState state = prognosis::read_state(folder);
    prognosis::require_posterior(state, name);
    json["varied"] = varied_predictions(state.source.study.text, models);
    json["lives"] = true;
  } catch (const InputError& problem) {
    json["no_lives"] = printable_lines(problem.what());
  }
}

// The lines that fit the study again, where it stands beside its result as it was fitted.
void add_lines(const std::filesystem::path& folder, ordered_json& json) {
  constexpr std::string_view ending = "-results";
  std::string stem = folder.filename().string();
  if (!stem.ends_with(ending)) return;
  stem.resize(stem.size() - ending.size());
  const std::filesystem::path study = folder.parent_path() / (stem + ".toml");
  std::error_code error;
  for (const auto& each : {study, folder / "study.toml"})
    if (!std::filesystem::is_regular_file(each, error)) return;
  if (read_text_file(study).text != read_text_file(folder / "study.toml").text) return;
  json["command"] = fmt::format("wearwell fit {} -o {}", quoted_word(study.string()),
                                quoted_word(folder.string()));
  json["python"] = fmt::format("import wearwell as ww; ww.fit({}).write({})",
                               python_text(study.string()), python_text(folder.string()));
}

}  // namespace

ordered_json result_json(const std::filesystem::path& folder, Models models) {
  const SavedReport saved = read_saved_report(folder);
  const Header& header = saved.header;
  ordered_json json = {{"folder", folder.filename().string()},
                       {"title", header.title},
                       {"model", header.model},
                       {"equation", header.equation},
                       {"trusted", header.trusted},
                       {"checks", to_json(header.checks)},
                       {"leads", ordered_json::array()},
                       {"tiles", ordered_json::array()},
                       {"tables", ordered_json::array()}};
  for (const present::Section& section : saved.sections) add_summary(section.blocks, json);
  for (const present::Table* each : present::tables(saved.sections))
    json["tables"].push_back(table_texts(*each));
  for (ordered_json& check : json["checks"])
    check["changes"] = advised_changes(check.value("advice", std::string()));
  add_lives(folder, models, json);
  add_lines(folder, json);
  return json;
}

std::string report_page(const std::filesystem::path& folder) {
  const SavedReport saved = read_saved_report(folder);
  return report_html(saved.header, saved.sections);
}

}  // namespace wearwell::workbench
