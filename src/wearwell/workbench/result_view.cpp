#include "wearwell/workbench/result_view.h"

#include <fmt/format.h>

#include <system_error>
#include <variant>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/present/section.h"
#include "wearwell/prognosis/asked_life.h"
#include "wearwell/prognosis/life_bounds.h"
#include "wearwell/prognosis/life_text.h"
#include "wearwell/study/header_json.h"
#include "wearwell/study/saved_result.h"

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
void add_lives(const std::filesystem::path& folder, ordered_json& json) {
  json["lives"] = false;
  std::error_code error;
  if (!std::filesystem::is_regular_file(folder / "state.bin", error)) return;
  const std::string name = folder.filename().string();
  try {
    prognosis::require_posterior(prognosis::read_state(folder), name);
    json["lives"] = true;
  } catch (const InputError& problem) {
    json["no_lives"] = printable_lines(problem.what());
  }
}

std::string option_text(const nlohmann::json& question, const char* name) {
  return printable(question.value(name, ""));
}

// A word for a shell, quoted where needed.
std::string quoted_word(const std::string& text) {
  static constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-+/=:,";
  if (!text.empty() && text.find_first_not_of(plain) == text.npos) return text;
  std::string out = "'";
  for (const char each : text) out += each == '\'' ? std::string("'\\''") : std::string(1, each);
  return out + "'";
}

constexpr const char* life_options[] = {"unit", "survived", "horizon", "risk", "level", "sides"};

std::string life_command(const std::filesystem::path& folder, const nlohmann::json& question) {
  // Another shell stands in another folder; a unit may be named "-1".
  std::string command = "wearwell life " + quoted_word(folder.string());
  for (const char* name : life_options) {
    const std::string text = option_text(question, name);
    if (!text.empty()) command += fmt::format(" --{}={}", name, quoted_word(text));
  }
  return command;
}

// "--survived: ..." -> "survived: ...": a page has fields, not options.
std::string without_dashes(std::string message) {
  for (const char* name : life_options) {
    const std::string option = std::string("--") + name;
    for (std::size_t at = 0; (at = message.find(option, at)) != message.npos;) message.erase(at, 2);
  }
  return message;
}

}  // namespace

ordered_json result_json(const std::filesystem::path& folder) {
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
  add_lives(folder, json);
  return json;
}

std::string report_page(const std::filesystem::path& folder) {
  const SavedReport saved = read_saved_report(folder);
  return report_html(saved.header, saved.sections);
}

ordered_json life_answer(const std::filesystem::path& folder, Models models,
                         const nlohmann::json& question) {
  try {
    prognosis::LifeQuestion asked;
    asked.unit = option_text(question, "unit");
    const std::string survived = option_text(question, "survived");
    const std::string horizon = option_text(question, "horizon");
    const std::string risk = option_text(question, "risk");
    if (!survived.empty()) asked.survived = survived;
    if (!horizon.empty()) asked.horizon = horizon;
    if (!risk.empty()) asked.risk = prognosis::tolerated_risk(risk);
    const prognosis::LifeBounds bounds =
        prognosis::read_life_bounds(option_text(question, "level"), option_text(question, "sides"));
    if (bounds.asked) asked.shares = {bounds.levels.below(), 1 - bounds.levels.below()};
    const prognosis::CarriedState state = prognosis::read_state(folder);
    prognosis::require_posterior(state, folder.filename().string());
    const prognosis::UnitLife life =
        prognosis::asked_life(state, folder.filename().string(), models, asked);
    return {{"text", prognosis::life_text(life, bounds, {}, state.trusted)},
            {"answer", prognosis::life_json(life, bounds, {}, state.trusted)},
            {"command", life_command(folder, question)}};
  } catch (const InputError& error) {
    throw InputError(without_dashes(error.what()));
  }
}

}  // namespace wearwell::workbench
