#include "wearwell/workbench/actions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <system_error>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/input/text_file.h"
#include "wearwell/input/workbook.h"
#include "wearwell/workbench/fit_run.h"
#include "wearwell/workbench/folder_files.h"
#include "wearwell/workbench/guess_view.h"
#include "wearwell/workbench/result_view.h"
#include "wearwell/workbench/study_form.h"
#include "wearwell/workbench/table_view.h"

namespace wearwell::workbench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t rows_at_once = 200, columns_at_once = 60, longest_study = 1 << 20;

std::shared_ptr<const OpenTable> required_table(Session& session) {
  const std::lock_guard lock(session.mutex);
  if (!session.table) throw InputError("no table is open");
  return session.table;
}

std::string text_of_wish(const json& wish, const char* key) {
  if (!wish.contains(key) || !wish.at(key).is_string())
    throw InputError(fmt::format("\"{}\" is missing: it must be a text", key));
  return wish.at(key).get<std::string>();
}

// How the file stores the table: keys of [data].
std::map<std::string, std::string> settings_of(const json& wish) {
  static constexpr std::array keys = {"sheet",        "range",       "header_row", "units_row",
                                      "decimal",      "thousands",   "delimiter",  "encoding",
                                      "summary_rows", "hidden_rows", "comment"};
  std::map<std::string, std::string> settings;
  for (const auto& [key, value] : wish.value("settings", json::object()).items()) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end() || !value.is_string())
      throw InputError(fmt::format("settings: \"{}\" is not allowed; use {}", printable(key),
                                   fmt::join(keys, ", ")));
    const std::string text = value.get<std::string>();
    if (text.empty()) continue;
    const bool whole =
        std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
    if (key == "header_row" && (!whole || text.size() > 9))
      throw InputError(
          fmt::format("header_row: \"{}\" is not the number of a line", printable(text)));
    settings[key] = text;
  }
  return settings;
}

Json read_and_show(Session& session, const std::string& file,
                   const std::map<std::string, std::string>& settings) {
  try {
    const auto open = std::make_shared<const OpenTable>(open_table(session.folder, file, settings));
    Json shown = table_json(*open);
    const std::lock_guard lock(session.mutex);
    session.table = open;
    ++session.version;
    return {{"kind", "table"}, {"table", std::move(shown)}};
  } catch (const SeveralSheets& several) {
    Json names = Json::array();
    for (const std::string& each : several.names) names.push_back(printable(each));
    return {{"kind", "sheets"}, {"file", file}, {"sheets", std::move(names)}};
  }
}

Json study_json(Session& session, const std::string& name) {
  const TextFile file = read_text_file(path_in(session.folder, name));
  if (file.text.size() > longest_study || valid_utf8(file.text) != file.text)
    throw InputError(fmt::format("{} is not a text of at most 1 MiB", printable(name)));
  return {{"file", name}, {"text", file.text}};
}

Json table_action(Session& session, const json& wish) {
  return read_and_show(session, required_table(session)->file, settings_of(wish));
}

Json guess_action(Session& session, const json& wish) {
  return guesses_json(*required_table(session), session.models, wish);
}

Json check_action(Session& session, const json& wish) {
  const std::string name = wish.value("file", "study.toml");
  return checked_study(path_in(session.folder, name), text_of_wish(wish, "text"), session.models);
}

Json set_action(Session&, const json& wish) {
  return {{"text", with_value(text_of_wish(wish, "text"), text_of_wish(wish, "path"),
                              text_of_wish(wish, "value"))}};
}

// What the page read must be what stands there; `before` is null for a new file.
Json save_action(Session& session, const json& wish) {
  const std::string name = text_of_wish(wish, "file"), text = text_of_wish(wish, "text");
  const fs::path path = path_in(session.folder, name);
  if (path.extension() != ".toml")
    throw InputError(fmt::format("{}: the name of a study ends in .toml", printable(name)));
  if (text.size() > longest_study) throw InputError("a study has at most 1 MiB");
  const bool is_new = !wish.contains("before") || wish.at("before").is_null();
  std::error_code error;
  const bool exists = fs::exists(path, error);
  if (is_new && exists && read_text_file(path).text != text)
    throw Conflict(
        fmt::format("{} exists already: choose another name, or open it", printable(name)));
  if (!is_new && exists && read_text_file(path).text != text_of_wish(wish, "before"))
    throw Conflict(
        fmt::format("{} has been changed by another program or page since it was read: open it "
                    "again, or save under another name",
                    printable(name)));
  write_file(path, text, Links::replace);
  const std::lock_guard lock(session.mutex);
  session.study = name;
  ++session.version;
  return {{"file", name}};
}

Json fit_action(Session& session, const json& wish) {
  start_fit(session, text_of_wish(wish, "file"));
  return Json::object();
}

Json stop_action(Session& session, const json&) {
  stop_fit(session);
  return Json::object();
}

std::string open_result(Session& session) {
  const std::lock_guard lock(session.mutex);
  if (session.result.empty()) throw InputError("no result is open");
  return session.result;
}

Json life_action(Session& session, const json& wish) {
  return life_answer(path_in(session.folder, open_result(session)), session.models, wish);
}

Json session_look(Session& session, const HttpTarget&) {
  return session_json(session);
}

Json table_look(Session& session, const HttpTarget&) {
  return table_json(*required_table(session));
}

Json rows_look(Session& session, const HttpTarget& target) {
  constexpr std::size_t most = 1'000'000'000;
  return rows_json(*required_table(session), target.number("from", 0, most),
                   target.number("count", 50, rows_at_once), target.number("from_column", 0, most),
                   target.number("columns", 20, columns_at_once));
}

Json plot_look(Session& session, const HttpTarget& target) {
  constexpr std::size_t most = 1'000'000;
  const auto axis = [&](const char* column, const char* log) {
    PlotAxis wanted{{}, target.number(log, 0, 1) == 1};
    if (target.query.contains(column)) wanted.column = target.number(column, 0, most);
    return wanted;
  };
  return plot_json(*required_table(session), axis("x", "log_x"), axis("y", "log_y"));
}

Json study_look(Session& session, const HttpTarget&) {
  std::string name;
  {
    const std::lock_guard lock(session.mutex);
    name = session.study;
  }
  if (name.empty()) throw InputError("no study is open");
  return study_json(session, name);
}

Json result_look(Session& session, const HttpTarget&) {
  return result_json(path_in(session.folder, open_result(session)));
}

}  // namespace

Json session_json(Session& session) {
  Json files = listed_files(session.folder);
  const std::lock_guard lock(session.mutex);
  return {{"version", session.version},
          {"folder", printable(valid_utf8(session.folder.string()))},
          {"files", std::move(files)},
          {"table", session.table ? session.table->file : ""},
          {"study", session.study},
          {"result", session.result},
          {"fit", progress_json(session.fit)}};
}

Json open_file(Session& session, const json& wish) {
  const std::string name = text_of_wish(wish, "file");
  const fs::path path = path_in(session.folder, name);
  const std::string kind = kind_of(path);
  if (kind == "table") return read_and_show(session, name, settings_of(wish));
  if (kind == "study") {
    Json study = study_json(session, name);
    const std::lock_guard lock(session.mutex);
    session.study = name;
    ++session.version;
    return {{"kind", "study"}, {"study", std::move(study)}};
  }
  if (kind == "result") {
    static_cast<void>(result_json(path));
    const std::lock_guard lock(session.mutex);
    session.result = name;
    ++session.version;
    return {{"kind", "result"}};
  }
  throw InputError(
      fmt::format("{} is neither a table nor a study nor a folder of results here: tables are "
                  ".csv, .tsv, .txt, .dat, .json, .ndjson, .parquet and .xlsx",
                  printable(name)));
}

Json upload(Session& session, const std::string& name, const std::string& bytes) {
  const fs::path path = path_in(session.folder, name);
  std::error_code error;
  if (fs::exists(path, error)) {
    std::ifstream stream(path, std::ios::binary);
    const std::string known{std::istreambuf_iterator<char>(stream), {}};
    if (known != bytes)
      throw Conflict(
          fmt::format("{} exists in this folder with other content: rename the file that you chose",
                      printable(name)));
    return open_file(session, {{"file", name}});
  }
  if (!is_table_name(name))
    throw InputError(fmt::format(
        "{} is not a table: tables are .csv, .tsv, .txt, .dat, .json, .ndjson, .parquet and .xlsx",
        printable(name)));
  write_file(path, bytes, Links::replace);
  return open_file(session, {{"file", name}});
}

Look look_of(std::string_view path) {
  static constexpr std::pair<std::string_view, Look> looks[] = {
      {"/api/session", session_look}, {"/api/table", table_look}, {"/api/rows", rows_look},
      {"/api/plot", plot_look},       {"/api/study", study_look}, {"/api/result", result_look}};
  for (const auto& [known, look] : looks)
    if (known == path) return look;
  return nullptr;
}

Action action_of(std::string_view path) {
  static constexpr std::pair<std::string_view, Action> actions[] = {
      {"/api/open", open_file},     {"/api/table", table_action}, {"/api/guess", guess_action},
      {"/api/check", check_action}, {"/api/set", set_action},     {"/api/save", save_action},
      {"/api/fit", fit_action},     {"/api/stop", stop_action},   {"/api/life", life_action}};
  for (const auto& [known, action] : actions)
    if (known == path) return action;
  return nullptr;
}

}  // namespace wearwell::workbench
