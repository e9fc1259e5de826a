#include "wearwell/report/result_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
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

/// Nothing when there is no list, or it is none of ours.
std::optional<std::vector<Listed>> read_list(const fs::path& folder) {
  constexpr std::size_t digits = 40, between = 2;
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(folder / list_name, error))) return {};
  std::ifstream stream(folder / list_name, std::ios::binary);
  std::vector<Listed> list;
  for (std::string line; std::getline(stream, line);) {
    if (line.size() <= digits + between || line.substr(digits, between) != "  ") return {};
    list.push_back({line.substr(0, digits), line.substr(digits + between)});
    if (list.back().name.find('/') != std::string::npos) return {};
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

/// What is in the folder: of wearwell's writing, and the first that is not, with the reason.
struct Content {
  std::vector<std::string> own;
  std::string foreign;
};

Content look_at(const fs::path& folder) {
  Content content;
  const auto list = read_list(folder);
  const auto foreign = [&](const std::string& name, const char* why) {
    if (content.foreign.empty()) content.foreign = fmt::format("it holds {}, {}", name, why);
  };
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (list && name == list_name) {
      content.own.push_back(name);
    } else if (!list) {
      foreign(name, "and no results.sha1, the list of what wearwell wrote");
    } else if (std::none_of(list->begin(), list->end(),
                            [&](const Listed& each) { return each.name == name; })) {
      foreign(name, "which is no result");
    } else if (!is_unchanged(at->path(), name, *list)) {
      foreign(name, "which was changed since wearwell wrote it");
    } else {
      content.own.push_back(name);
    }
  }
  if (error) content.foreign = error.message();
  return content;
}

/// The earlier results that may be replaced.
std::vector<std::string> replaceable(const fs::path& target) {
  const fs::path folder = behind_links(target);
  std::error_code error;
  if (!fs::exists(folder, error)) {
    heal_folder(folder.parent_path());  // a program killed may have left it aside
    if (!fs::exists(folder, error)) return {};
  }
  if (!fs::is_directory(folder, error))
    throw InputError(fmt::format("cannot write to {}: it is not a folder", folder.string()));
  heal_folder(folder);
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

void replace_result(const fs::path& folder, const std::string& name, std::string_view content) {
  auto list = read_list(folder);
  const auto write_list = [&] {
    std::string text;
    for (const Listed& each : *list) text += line_of(each);
    write_file(folder / list_name, text, Links::replace);
  };
  const Listed now = {sha1_of(content), name};
  const auto is_old = [&](const Listed& each) {
    return each.name == name && each.sha1 != now.sha1;
  };
  // The old file and the new are both listed while one takes the other's place.
  const bool listed = list && std::any_of(list->begin(), list->end(), [&](const Listed& each) {
                        return each.name == name && each.sha1 == now.sha1;
                      });
  if (list && !listed) {
    list->push_back(now);
    write_list();
  }
  write_file(folder / name, content, Links::replace);
  if (list && std::erase_if(*list, is_old) > 0) write_list();
}

}  // namespace wearwell
