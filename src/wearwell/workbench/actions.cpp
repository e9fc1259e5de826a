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
#include "wearwell/workbench/comparison_view.h"
#include "wearwell/workbench/date_query.h"
#include "wearwell/workbench/families_view.h"
#include "wearwell/workbench/fit_run.h"
#include "wearwell/workbench/folder_files.h"
#include "wearwell/workbench/guess_view.h"
#include "wearwell/workbench/priors.h"
#include "wearwell/workbench/question_view.h"
#include "wearwell/workbench/result_view.h"
#include "wearwell/workbench/study_form.h"
#include "wearwell/workbench/table_reading.h"
#include "wearwell/workbench/table_view.h"

// Longer than others: one short function for each request of the page.
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

// The open table, if it is the one that the request means: another page may have opened another.
std::shared_ptr<const OpenTable> named_table(Session& session, const std::string& file,
                                             std::uint64_t number) {
  auto open = required_table(session);
  if (open->file != file || open->number != number)
    throw Conflict(fmt::format("the request is for {}; since then another page has opened {}{}",
                               printable(shortened(file)), printable(open->file),
                               open->file == file ? " with other settings" : ""));
  return open;
}

std::string text_of_wish(const json& wish, const char* key) {
  if (!wish.contains(key) || !wish.at(key).is_string())
    throw InputError(fmt::format("\"{}\" is missing: it must be a text", key));
  return wish.at(key).get<std::string>();
}

std::shared_ptr<const OpenTable> table_of_wish(Session& session, const json& wish) {
  if (!wish.contains("number") || !wish.at("number").is_number_unsigned())
    throw InputError("\"number\" is missing: it must be the number of a table");
  return named_table(session, text_of_wish(wish, "file"), wish.at("number").get<std::uint64_t>());
}

std::shared_ptr<const OpenTable> table_of_target(Session& session, const HttpTarget& target) {
  const auto file = target.query.find("file");
  if (file == target.query.end()) throw InputError("\"file\" is missing: it must name the table");
  constexpr std::size_t most = 1'000'000'000;
  return named_table(session, file->second, target.number("number", 0, most));
}

// How the file stores the table: keys of [data].
std::map<std::string, std::string> settings_of(const json& wish) {
  static constexpr std::array keys = {"sheet",        "range",       "header_row", "units_row",
                                      "decimal",      "thousands",   "delimiter",  "encoding",
                                      "summary_rows", "hidden_rows", "comment",    "sql"};
  std::map<std::string, std::string> settings;
  const json given = wish.value("settings", json::object());  // `items` refers to it
  for (const auto& [key, value] : given.items()) {
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

// Line ends apart: a page has LF only.
bool is_same_text(std::string a, std::string b) {
  for (std::string* each : {&a, &b}) std::erase(*each, '\r');
  return a == b;
}

// A file with CRLF keeps it.
std::string with_line_ends_of(const std::string& known, const std::string& text) {
  if (known.find("\r\n") == known.npos) return text;
  std::string out;
  for (const char each : text) {
    if (each == '\n') out += '\r';
    if (each != '\r') out += each;
  }
  return out;
}

Conflict changed_file(const std::string& name) {
  return Conflict(
      fmt::format("{} has been changed by another program or page since it was read: open it "
                  "again, or save under another name",
                  printable(name)));
}

Json study_json(Session& session, const std::string& name) {
  const TextFile file = read_text_file(path_in(session.folder, name));
  if (file.text.size() > longest_study || valid_utf8(file.text) != file.text)
    throw InputError(fmt::format("{} is not a text of at most 1 MiB", printable(name)));
  return {{"file", name}, {"text", file.text}};
}

Json table_action(Session& session, const json& wish) {
  const auto open = table_of_wish(session, wish);
  auto settings = settings_of(wish);
  if (wish.contains("dates")) {
    settings = open->settings;
    settings["sql"] = time_query(open->table, read_dates_wanted(wish.at("dates")), settings["sql"]);
  }
  return start_reading(session, open->file, settings);
}

Json guess_action(Session& session, const json& wish) {
  return guesses_json(*table_of_wish(session, wish), session.models, wish);
}

// Whether another program has changed or removed the file of the open table. A study reads the file.
bool is_table_changed(Session& session) {
  const std::lock_guard lock(session.mutex);
  const auto& open = session.table;
  return open && stamp_of(session.folder / open->file) != open->stamp;
}

Json check_action(Session& session, const json& wish) {
  const std::string name = wish.value("file", "study.toml");
  Json json =
      checked_study(path_in(session.folder, name), text_of_wish(wish, "text"), session.models);
  json["table_changed"] = is_table_changed(session);
  return json;
}

Json form_action(Session& session, const json& wish) {
  const std::string name = wish.value("file", "study.toml");
  return study_form(path_in(session.folder, name), text_of_wish(wish, "text"), session.models);
}

Json priors_action(Session& session, const json& wish) {
  return priors_json(path_in(session.folder, wish.value("file", "study.toml")),
                     text_of_wish(wish, "text"), session.models);
}

Json move_prior_action(Session&, const json& wish) {
  return moved_prior_json(text_of_wish(wish, "text"), wish);
}

Json families_action(Session& session, const json& wish) {
  return families_json(path_in(session.folder, wish.value("file", "study.toml")),
                       text_of_wish(wish, "text"));
}

Json set_action(Session&, const json& wish) {
  return {{"text", with_value(text_of_wish(wish, "text"), text_of_wish(wish, "path"),
                              text_of_wish(wish, "value"))}};
}

// What the page read must be what stands there; `before` is null for a new file.
Json save_action(Session& session, const json& wish) {
  const std::string name = text_of_wish(wish, "file"), text = text_of_wish(wish, "text");
  const fs::path path = path_in(session.folder, name);
  if (!is_study_name(path))
    throw InputError(fmt::format("{}: the name of a study ends in .toml", printable(name)));
  if (text.size() > longest_study) throw InputError("a study has at most 1 MiB");
  const bool is_new = !wish.contains("before") || wish.at("before").is_null();
  const std::lock_guard one_writer(session.writing);
  std::error_code error;
  const bool exists = fs::exists(path, error);
  const std::string known = exists ? read_text_file(path).text : "";
  const bool same = exists && is_same_text(known, text);
  if (is_new && exists && !same)
    throw Conflict(
        fmt::format("{} exists already: choose another name, or open it", printable(name)));
  if (!is_new && exists && !same && !is_same_text(known, text_of_wish(wish, "before")))
    throw changed_file(name);
  // The path is checked: a link leads to a file of this folder, and stays a link.
  if (!same) write_file(fs::weakly_canonical(path), with_line_ends_of(known, text), Links::replace);
  const std::lock_guard lock(session.mutex);
  session.study = name;
  ++session.version;
  return {{"file", name}};
}

Json fit_action(Session& session, const json& wish) {
  const std::string name = text_of_wish(wish, "file"), shown = text_of_wish(wish, "text");
  start_fit(session, name, [&](const std::string& text) {
    if (!is_same_text(text, shown)) throw changed_file(name);
  });
  return Json::object();
}

Json stop_action(Session& session, const json&) {
  stop_fit(session);
  return Json::object();
}

Json stop_reading_action(Session& session, const json&) {
  stop_reading(session);
  return Json::object();
}

std::string open_result(Session& session) {
  const std::lock_guard lock(session.mutex);
  if (session.result.empty()) throw InputError("no result is open");
  return session.result;
}

// The open result, if it is the one that the question means.
fs::path result_of_wish(Session& session, const json& wish) {
  const std::string result = open_result(session);
  if (wish.contains("result") && text_of_wish(wish, "result") != result)
    throw Conflict(fmt::format("the question is for {}; since then {} has been opened",
                               printable(shortened(text_of_wish(wish, "result"))),
                               printable(result)));
  return path_in(session.folder, result);
}

Json life_action(Session& session, const json& wish) {
  return life_answer(result_of_wish(session, wish), session.models, wish);
}

Json decide_action(Session& session, const json& wish) {
  return decision_answer(result_of_wish(session, wish), session.models, wish);
}

Json next_test_action(Session& session, const json& wish) {
  return next_test_answer(result_of_wish(session, wish), session.models, wish);
}

Json compare_action(Session& session, const json& wish) {
  const json given = wish.value("results", json::array());
  std::vector<std::string> names;
  for (const json& each : given) {
    if (!each.is_string()) throw InputError("\"results\" must be a list of names");
    names.push_back(each.get<std::string>());
  }
  Json answer = comparison_answer(session.folder, names);
  const std::lock_guard lock(session.mutex);
  session.compared = names;
  return answer;
}

Json session_look(Session& session, const HttpTarget&) {
  return session_json(session);
}

Json table_look(Session& session, const HttpTarget&) {
  return shown_table(*required_table(session));
}

Json rows_look(Session& session, const HttpTarget& target) {
  constexpr std::size_t most = 1'000'000'000;
  return rows_json(*table_of_target(session, target), target.number("from", 0, most),
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
  return plot_json(*table_of_target(session, target), axis("x", "log_x"), axis("y", "log_y"),
                   axis("by", "").column);
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
  return result_json(path_in(session.folder, open_result(session)), session.models);
}

Json units_look(Session& session, const HttpTarget&) {
  return followed_units(path_in(session.folder, open_result(session)), session.models);
}

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Whether it is a new file; false: it was there already.
bool store_upload(Session& session, const fs::path& path, const std::string& name,
                  const std::string& bytes) {
  const std::lock_guard one_writer(session.writing);
  std::error_code error;
  if (fs::exists(path, error)) {
    if (bytes_of(path) == bytes) return false;
    throw Conflict(
        fmt::format("{} exists in this folder with other content: rename the file that you chose",
                    printable(name)));
  }
  if (!is_table_name(name))
    throw InputError(fmt::format(
        "{} is not a table: tables are .csv, .tsv, .txt, .dat, .json, .ndjson, .parquet and .xlsx",
        printable(name)));
  write_file(path, bytes, Links::replace);
  return true;
}

}  // namespace

Json session_json(Session& session) {
  std::uint64_t version = 0;  // from before the listing: a later change is another event
  {
    const std::lock_guard lock(session.mutex);
    version = session.version;
  }
  Json files = listed_files(session.folder);
  const bool table_changed = is_table_changed(session);
  const std::lock_guard lock(session.mutex);
  return {{"version", version},
          {"folder", printable(valid_utf8(session.folder.string()))},
          {"files", std::move(files)},
          {"table", session.table ? session.table->file : ""},
          {"table_number", session.table ? session.table->number : 0},
          {"table_changed", table_changed},
          {"workbook", session.workbook},
          {"study", session.study},
          {"result", session.result},
          {"reading", reading_json(session.read)},
          {"fit", progress_json(session.fit)}};
}

// `refused` is called if the file is a table that cannot be read.
Json open_named(Session& session, const std::string& name,
                const std::map<std::string, std::string>& settings,
                const std::function<void()>& refused) {
  const fs::path path = path_in(session.folder, name);
  const std::string kind = kind_of(path);
  if (kind == "table") return start_reading(session, name, settings, refused);
  if (kind == "study") {
    Json study = study_json(session, name);
    const std::lock_guard lock(session.mutex);
    session.study = name;
    ++session.version;
    return {{"kind", "study"}, {"study", std::move(study)}};
  }
  if (kind == "result") {
    static_cast<void>(result_json(path, session.models));
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

Json open_file(Session& session, const json& wish) {
  return open_named(session, text_of_wish(wish, "file"), settings_of(wish), {});
}

Json upload(Session& session, const json& wish, std::string bytes) {
  const std::string name = text_of_wish(wish, "file");
  const auto settings = settings_of(wish);
  const fs::path path = path_in(session.folder, name);
  if (!store_upload(session, path, name, bytes)) return open_named(session, name, settings, {});
  // It is not removed if another program has changed it since.
  const auto forget = [&session, path, bytes = std::move(bytes)] {
    const std::lock_guard one_writer(session.writing);
    std::error_code ignored;
    if (bytes_of(path) == bytes) fs::remove(path, ignored);
  };
  const bool is_table = kind_of(path) == "table";
  try {
    return open_named(session, name, settings, forget);
  } catch (...) {
    if (!is_table) forget();
    throw;
  }
}

Look look_of(std::string_view path) {
  static constexpr std::pair<std::string_view, Look> looks[] = {
      {"/api/session", session_look}, {"/api/table", table_look}, {"/api/rows", rows_look},
      {"/api/plot", plot_look},       {"/api/study", study_look}, {"/api/result", result_look},
      {"/api/units", units_look}};
  for (const auto& [known, look] : looks)
    if (known == path) return look;
  return nullptr;
}

Action action_of(std::string_view path) {
  static constexpr std::pair<std::string_view, Action> actions[] = {
      {"/api/open", open_file},          {"/api/table", table_action},
      {"/api/guess", guess_action},      {"/api/check", check_action},
      {"/api/set", set_action},          {"/api/save", save_action},
      {"/api/fit", fit_action},          {"/api/stop", stop_action},
      {"/api/life", life_action},        {"/api/priors", priors_action},
      {"/api/decide", decide_action},    {"/api/compare", compare_action},
      {"/api/prior", move_prior_action}, {"/api/families", families_action},
      {"/api/form", form_action},        {"/api/stop-reading", stop_reading_action},
      {"/api/next", next_test_action}};
  for (const auto& [known, action] : actions)
    if (known == path) return action;
  return nullptr;
}

}  // namespace wearwell::workbench
