#include "wearwell/input/study_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>

#include "wearwell/base/nearest.h"

// Longer than others: the keys that all models share, and the search for missing and unknown
// keys.
namespace wearwell {
namespace {

using Present = TomlReader::Present;

// "data.columns" and "volume" of "data.columns.volume".
std::string_view parent_of(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  return dot == path.npos ? std::string_view() : path.substr(0, dot);
}
std::string_view leaf_of(std::string_view path) {
  return path.substr(path.rfind('.') + 1);
}
std::string under(std::string_view parent, std::string_view leaf) {
  return parent.empty() ? std::string(leaf) : fmt::format("{}.{}", parent, leaf);
}
bool is_below(std::string_view path, std::string_view ancestor) {
  return path.size() > ancestor.size() && path.starts_with(ancestor) &&
         path[ancestor.size()] == '.';
}
std::string table_named(std::string_view path) {
  return path.empty() ? "at the top, before the first [table]" : fmt::format("in [{}]", path);
}

// Keys of earlier studies, and their names now.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> renamed_keys{
    {{"law", "distribution"}, {"law", "formula"}, {"varies", "random_effects"}}};

class Keys {
 public:
  Keys(const TomlReader& root, const StudyKeys& keys)
      : root_(root), file_(root.file()), keys_(keys), present_(root.present()) {
    for (const auto& [path, kinds] : root.asked()) asked_.insert(path);
  }

  // "12:3: predict.limt: unknown key; did you mean 'limit'? (possible: ...)", each.
  std::vector<std::string> unknown() {
    std::vector<std::string> faults;
    std::string_view last;  // skips the keys of an unknown table
    for (const Present& each : present_) {
      if (!last.empty() && is_below(each.path, last)) continue;
      if (is_known(each.path)) continue;
      last = each.path;
      Repair repair;
      faults.push_back(
          fmt::format("{}: {}: {}", each.place, each.path, said_of(each.path, repair)));
      add_excerpt(each, repair);
    }
    return faults;
  }

  // Known keys without effect.
  std::vector<std::string> idle() {
    std::vector<std::string> faults;
    for (const Present& each : present_) {
      const std::string table(parent_of(each.path));
      const bool table_was_read = table.empty() || asked_.contains(table);
      if (!table_was_read || asked_.contains(each.path)) continue;
      faults.push_back(
          fmt::format("{}: {}: has no effect in this study; remove it, or add the keys that it "
                      "needs (docs/reference/study-keys.md)",
                      each.place, each.path));
      add_excerpt(each, {});
    }
    return faults;
  }

  // The lines of the study with faults.
  const std::string& excerpts() const { return excerpts_; }

  // Call after `unknown`: keys reported there are not reported as missing.
  StudyKeys missing() const {
    StudyKeys result;
    for (const StudyKey& key : keys_) {
      if (!key.needed) continue;
      const std::string parent(parent_of(key.path));
      if (parent.find('*') == parent.npos) {
        if (lacks(key, parent)) result.push_back(key);
        continue;
      }
      for (const Present& each : present_) {
        if (!each.is_table || !matches_key(parent, each.path) || !lacks(key, each.path)) continue;
        result.push_back(key);
        result.back().path = under(each.path, leaf_of(key.path));
      }
    }
    return result;
  }

  // Whether the reader's message is about an existing value.
  bool is_of_a_value(std::string_view refusal) const {
    return std::any_of(present_.begin(), present_.end(), [&](const Present& each) {
      return !each.is_table &&
             refusal.find(fmt::format(":{}: {}: ", each.place, each.path)) != refusal.npos;
    });
  }

  const std::string& file() const { return file_; }

 private:
  const Present* find(std::string_view path) const {
    const auto found = std::find_if(present_.begin(), present_.end(),
                                    [&](const Present& each) { return each.path == path; });
    return found == present_.end() ? nullptr : &*found;
  }

  bool is_known(std::string_view path) const {
    if (asked_.contains(std::string(path))) return true;
    return std::any_of(keys_.begin(), keys_.end(), [&](const StudyKey& key) {
      if (matches_key(key.path, path)) return true;
      // Whether this is a table of known keys; a table named by the user has its own entry.
      return is_below(key.path, path) && path.find('*') == path.npos;
    });
  }

  // Names allowed in a table.
  std::vector<std::string> possible(std::string_view table) const {
    std::set<std::string> names;
    const auto add = [&](std::string_view path) {
      std::string_view rest = path;
      for (std::string_view at = table; !at.empty();) {
        const std::size_t dot = std::min(at.find('.'), at.size()),
                          end = std::min(rest.find('.'), rest.size());
        if (end == rest.size()) return;
        if (rest.substr(0, end) != "*" && rest.substr(0, end) != at.substr(0, dot)) return;
        at.remove_prefix(std::min(dot + 1, at.size()));
        rest.remove_prefix(end + 1);
      }
      const std::string_view name = rest.substr(0, rest.find('.'));
      if (name != "*") names.emplace(name);
    };
    for (const StudyKey& key : keys_) add(key.path);
    for (const std::string& path : asked_) add(path);
    return {names.begin(), names.end()};
  }

  // Tables that may contain a key of this name.
  std::vector<std::string> homes(std::string_view leaf) const {
    std::vector<std::string> tables;
    for (const StudyKey& key : keys_) {
      const std::string_view parent = parent_of(key.path);
      if (leaf_of(key.path) != leaf || parent.find('*') != parent.npos) continue;
      std::string where = table_named(parent);
      if (std::find(tables.begin(), tables.end(), where) == tables.end())
        tables.push_back(std::move(where));
    }
    return tables;
  }

  void add_excerpt(const Present& at, const Repair& repair) {
    constexpr std::size_t enough = 600;
    if (excerpts_.size() < enough) excerpts_ += root_.excerpt(at.line, at.column, repair);
  }

  std::string said_of(const std::string& path, Repair& repair) {
    const std::string parent(parent_of(path)), leaf(leaf_of(path));
    const std::vector<std::string> names = possible(parent);
    for (const auto& [before, now] : renamed_keys) {
      if (leaf != before || std::find(names.begin(), names.end(), now) == names.end()) continue;
      meant_.insert(under(parent, now));
      repair = {leaf, std::string(now), true};
      return fmt::format("the name of this key is '{}' now", now);
    }
    const std::vector<std::string> elsewhere = homes(leaf);
    if (!elsewhere.empty()) {
      moved_.insert(leaf);
      return fmt::format("unknown key here; {} belongs {}", leaf, fmt::join(elsewhere, " or "));
    }
    if (const auto near = near_name(leaf, names)) {
      meant_.insert(under(parent, *near));
      repair = {leaf, *near, true};
    }
    if (names.empty()) return "unknown key; no keys are allowed here";
    return fmt::format("unknown key{} (possible: {})", did_you_mean(leaf, names),
                       fmt::join(names, ", "));
  }

  // "data", "law.fatigue_limit=random", ".distribution=normal".
  bool holds(const std::string& condition, std::string_view table) const {
    const std::size_t equals = condition.find('=');
    std::string path = condition.substr(0, equals);
    if (path.starts_with('.')) path = under(table, path.substr(1));
    const Present* found = find(path);
    return found && (equals == condition.npos || found->text == condition.substr(equals + 1));
  }

  bool lacks(const StudyKey& key, std::string_view table) const {
    const std::string path = under(table, leaf_of(key.path));
    const auto any = [&](const std::vector<std::string>& conditions) {
      return std::any_of(conditions.begin(), conditions.end(),
                         [&](const std::string& each) { return holds(each, table); });
    };
    if (find(path) || any(key.unless) || (!key.when.empty() && !any(key.when))) return false;
    const bool misspelt = moved_.contains(std::string(leaf_of(path))) ||
                          std::any_of(meant_.begin(), meant_.end(), [&](const std::string& meant) {
                            return path == meant || is_below(path, meant);
                          });
    if (misspelt) return false;
    // The misspelled key may be an alternative to this one.
    return std::none_of(key.unless.begin(), key.unless.end(),
                        [&](const std::string& each) { return meant_.contains(each); });
  }

  TomlReader root_;
  std::string file_, excerpts_;
  const StudyKeys& keys_;
  std::vector<Present> present_;
  std::set<std::string> asked_, meant_, moved_;
};

// "data.columns.radius = {...} (or conditions.radius)"
std::string like(const StudyKey& key) {
  constexpr std::size_t most = 3;
  std::vector<std::string> others;
  for (const std::string& each : key.unless) {
    const bool is_path = each.find('=') == each.npos && !each.starts_with('.');
    if (is_path && others.size() < most)
      others.push_back(each.find('.') == each.npos ? fmt::format("[{}]", each) : each);
  }
  return fmt::format("{} = {}{}", key.path, key.example,
                     others.empty() ? "" : fmt::format(" (or {})", fmt::join(others, ", ")));
}

}  // namespace

StudyKey needed_key(std::string path, std::string example, std::string meaning,
                    std::vector<std::string> unless, std::vector<std::string> when) {
  return {std::move(path), std::move(example), std::move(meaning), true,
          std::move(when), std::move(unless)};
}

void add_keys(StudyKeys& keys, const StudyKeys& more) {
  keys.insert(keys.end(), more.begin(), more.end());
}

StudyKeys column_keys(const std::string& table) {
  return {needed_key(table + ".columns.*.column", "\"wear\"", "heading of the column"),
          {table + ".columns.*.unit", "\"mm^3\"",
           "unit of its numbers, if the heading has none; a count needs none"}};
}

StudyKeys status_keys() {
  return {
      {"data.columns.status.failure", "1",
       "value that means failure: for codes whose heading is not clear, 0 (1 is a runout, -1 left, "
       "2 interval) or 1 (0 is a runout, 2 left, 3 interval); or a word of the table, or a list of "
       "words"},
      {"data.columns.status.runout", "\"unbroken\"", "a word of the table for a runout, or a list"},
      {"data.columns.status.left", "\"before\"",
       "a word of the table for a left-censored life, or a list"},
      {"data.columns.status.interval", "\"between\"",
       "a word of the table for an interval-censored life, or a list"}};
}

StudyKey unused_columns_key() {
  return {"data.unused", "[\"event\"]",
          "headings of columns that look like a status but are not "
          "([tables.md](tables.md#how-a-test-ended))"};
}

StudyKeys layout_keys(const std::string& table) {
  return {{table + ".decimal", "\",\"", "decimal mark"},
          {table + ".thousands", "\".\"", "thousands separator, or none"},
          {table + ".delimiter", "\";\"", "separator of columns"},
          {table + ".encoding", "\"cp1252\"", "of the text: utf-8, utf-16 or cp1252"},
          {table + ".header_row", "5", "line of the headings, from 1"},
          {table + ".units_row", "\"below\"", "units stand in the row below the headings, or none"},
          {table + ".summary_rows", "\"last\"",
           "whether the last rows are means, sums and the like and are omitted: last, or none"},
          {table + ".hidden_rows", "\"skip\"", "hidden rows of a sheet: skip, or read (read)"},
          {table + ".comment", "\"#\"", "lines that begin with this are omitted"},
          {table + ".sheet", "\"Messung\"", "of a workbook: name or number"},
          {table + ".range", "\"B4:G22\"", "of that sheet"}};
}

bool matches_key(std::string_view pattern, std::string_view path) {
  while (true) {
    const std::size_t dot = pattern.find('.'), end = path.find('.');
    const std::string_view part = pattern.substr(0, dot);
    if (part != "*" && part != path.substr(0, end)) return false;
    if (dot == pattern.npos || end == path.npos) return dot == pattern.npos && end == path.npos;
    pattern.remove_prefix(dot + 1);
    path.remove_prefix(end + 1);
  }
}

StudyKeys missing_keys(const TomlReader& root, const StudyKeys& keys) {
  return Keys(root, keys).missing();
}

std::string key_faults(const TomlReader& root, const StudyKeys& keys, std::string_view refusal) {
  Keys all(root, keys);
  const std::vector<std::string> unknown = all.unknown();
  const StudyKeys missing = all.missing();
  if (unknown.empty() && missing.empty()) return {};
  std::string message = all.file() + ":";
  if (!unknown.empty()) {
    message += fmt::format("{}", fmt::join(unknown, "; and "));
  } else if (missing.size() == 1) {
    const StudyKey& key = missing.front();
    const bool is_said =
        without_excerpt(std::string(refusal)).find(leaf_of(key.path)) != std::string::npos;
    if (is_said && !all.is_of_a_value(refusal)) return {};
    message += fmt::format(" {} is missing, {}: {}", key.path, key.meaning, like(key));
  }
  if (missing.size() > 1 || (missing.size() == 1 && !unknown.empty())) {
    std::vector<std::string> examples;
    for (const StudyKey& key : missing) examples.push_back(like(key));
    const char* are = unknown.empty()       ? " {} keys are missing; with values of yours: {}"
                      : missing.size() == 1 ? "; and missing is {1}"
                                            : "; and {} keys are missing: {}";
    message += fmt::format(fmt::runtime(are), missing.size(), fmt::join(examples, "; "));
  }
  // A wrong value is not a consequence of missing keys.
  if (unknown.empty() && all.is_of_a_value(refusal)) message += fmt::format("; and {}", refusal);
  return message + all.excerpts();
}

std::string unused_keys(const TomlReader& root, const StudyKeys& keys) {
  Keys all(root, keys);
  std::vector<std::string> faults = all.unknown();
  if (faults.empty()) faults = all.idle();
  if (faults.empty()) return {};
  return fmt::format("{}:{}{}", all.file(), fmt::join(faults, "; and "), all.excerpts());
}

}  // namespace wearwell
