#include "wearwell/present/result_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <optional>
#include <set>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/sha1.h"
#include "wearwell/base/staged_file.h"

namespace wearwell {
namespace fs = std::filesystem;

namespace {

constexpr char list_name[] = "results.sha1";

struct Listed {
  std::string sha1, name;
};

std::string line_of(const Listed& each) {
  return fmt::format("{}  {}\n", each.sha1, each.name);
}

std::string text_of(const std::vector<Listed>& list) {
  std::string text;
  for (const Listed& each : list) text += line_of(each);
  return text;
}

/// Accepts "life.csv" or "tables/life.csv", but no path that leaves the folder.
bool is_plain(const fs::path& name) {
  const bool leads_out = std::any_of(name.begin(), name.end(), [](const fs::path& part) {
    return part.empty() || part == "." || part == ".." || part == "/";
  });
  return !leads_out && std::distance(name.begin(), name.end()) <= 2;
}

/// Empty without a list, or with a list of another program.
std::optional<std::vector<Listed>> read_list(const fs::path& folder) {
  constexpr std::size_t digits = 40, between = 2;
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(folder / list_name, error))) return {};
  std::ifstream stream(folder / list_name, std::ios::binary);
  std::vector<Listed> list;
  for (std::string line; std::getline(stream, line);) {
    if (line.size() <= digits + between || line.substr(digits, between) != "  ") return {};
    list.push_back({line.substr(0, digits), line.substr(digits + between)});
    if (!is_plain(list.back().name)) return {};
  }
  return stream.bad() ? std::nullopt : std::optional(list);
}

bool is_unchanged(const fs::path& file, const std::string& name, const std::vector<Listed>& list) {
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(file, error))) return false;
  std::ifstream stream(file, std::ios::binary);
  const std::string sha1 = sha1_of(stream);
  return stream.eof() && std::any_of(list.begin(), list.end(), [&](const Listed& each) {
           return each.name == name && each.sha1 == sha1;
         });
}

/// The content of the folder: the files written by wearwell, and the first other file with the
/// reason.
struct Content {
  std::vector<std::string> own;
  std::string foreign;
};

Content look_at(const fs::path& folder) {
  Content content;
  const auto list = read_list(folder);
  const auto foreign = [&](const std::string& name, const char* why) {
    if (content.foreign.empty()) content.foreign = fmt::format("it contains {}, {}", name, why);
  };
  for (const std::string& name : files_in(folder)) {
    if (list && name == list_name) {
      content.own.push_back(name);
    } else if (!list) {
      foreign(name, "and no results.sha1, the list of files written by wearwell");
    } else if (std::none_of(list->begin(), list->end(),
                            [&](const Listed& each) { return each.name == name; })) {
      foreign(name, "which is not a result");
    } else if (!is_unchanged(folder / name, name, *list)) {
      foreign(name, "which has changed since wearwell wrote it");
    } else {
      content.own.push_back(name);
    }
  }
  std::error_code error;
  const fs::directory_iterator readable(folder, error);
  if (error) content.foreign = error.message();
  return content;
}

/// The earlier results that can be replaced.
std::vector<std::string> replaceable(const fs::path& target) {
  const fs::path folder = behind_links(target);
  recover_results(folder);
  std::error_code error;
  if (!fs::exists(folder, error)) return {};
  if (!fs::is_directory(folder, error))
    throw InputError(fmt::format("cannot write to {}: it is not a folder", folder.string()));
  const Content content = look_at(folder);
  if (!content.foreign.empty())
    throw InputError(fmt::format("will not replace {}: {}", folder.string(), content.foreign));
  return content.own;
}

}  // namespace

ResultFolder::ResultFolder(const fs::path& target) : folder_(target, replaceable(target)) {}

void ResultFolder::write(const std::string& name, std::string_view content) {
  folder_.write(name, content);
  list_ += line_of({sha1_of(content), name});
}

void ResultFolder::commit() {
  folder_.write(list_name, list_);
  folder_.commit(look_at(folder_.target()).own);
}

void recover_results(const fs::path& target) {
  const fs::path folder = behind_links(target);
  std::error_code error;
  if (!fs::exists(folder, error))
    recover_folder(folder.parent_path());  // an interrupted exchange may
                                           // have moved it
  if (fs::is_directory(folder, error)) recover_folder(folder);
}

void replace_result(const fs::path& folder, const std::string& name, std::string_view content) {
  auto list = read_list(folder);
  if (!list) {
    write_file(folder / name, content, Links::replace);
    return;
  }
  std::error_code error;
  const fs::file_status there = fs::symlink_status(folder / name, error);
  if (fs::is_directory(there)) fail_to_write(folder / name, EISDIR);
  const std::string before = text_of(*list);
  const Listed now = {sha1_of(content), name};
  const auto has_name = [&](const Listed& each) { return each.name == name; };
  const auto line = std::find_if(list->begin(), list->end(), has_name);
  if (line == list->end()) {
    list->push_back(now);
  } else {
    *line = now;
    list->erase(std::remove_if(line + 1, list->end(), has_name), list->end());
  }

  const std::set<std::string> changed = {name, list_name};
  const auto own = [&] {
    std::vector<std::string> names = look_at(folder).own;
    if (fs::is_regular_file(there) && std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
    return names;
  };
  const std::vector<std::string> old = own();
  StagedFolder staged(folder, old);
  for (const std::string& each : old) {
    if (!changed.contains(each)) staged.keep(each);
  }
  staged.write(name, content);
  staged.write(list_name, text_of(*list));
  const auto list_now = read_list(folder);
  if (!list_now || text_of(*list_now) != before)
    throw InputError(fmt::format("will not replace {}: another run wrote to {} in the meantime",
                                 name, folder.string()));
  std::vector<std::string> replaced = own();
  if (std::find(replaced.begin(), replaced.end(), name) == replaced.end()) replaced.push_back(name);
  staged.commit(replaced);
}

}  // namespace wearwell
