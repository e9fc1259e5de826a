#include "wearwell/base/staged_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "wearwell/base/ending.h"
#include "wearwell/base/error.h"

// The hidden folder:
//
//   journal      since `commit`: what is to be done (see Journal)
//   new/WITHIN/  the files; after the exchange, what was in the target before
//   old/NAME/    what was in the target, where the file system has no exchange
//   fill/        the files, once they are to be moved into the target one by one
//
// `heal` completes or undoes the commit from any state; a kill, a failure and a success differ only
// in progress.
// Longer than others: `commit` and `heal` share the intermediate states.
namespace wearwell {
namespace fs = std::filesystem;

namespace {

constexpr mode_t for_all = 0777, for_owner = 0700;

/// The target's files: added, replaced, and removed ones.
enum Kind : char { added = '+', replaced_by_new = '=', removed = '-' };

struct Journal {
  fs::path within;
  std::vector<std::pair<char, std::string>> files;

  bool lists(const std::string& name) const {
    return std::any_of(files.begin(), files.end(),
                       [&](const auto& each) { return each.second == name; });
  }
  bool lists_within(const std::string& folder) const {
    return std::any_of(files.begin(), files.end(),
                       [&](const auto& each) { return each.second.starts_with(folder + '/'); });
  }
};

// Parts end with zero bytes, which names cannot contain; the last part marks completeness.
constexpr char end_of_journal[] = "whole";

std::string text_of(const Journal& journal) {
  std::string text = journal.within.string() + '\0';
  for (const auto& [kind, name] : journal.files) text += kind + name + '\0';
  return text + end_of_journal + '\0';
}

/// False if there is no complete journal; nothing was moved into place then.
bool read_journal(const fs::path& file, Journal& journal) {
  std::ifstream stream(file, std::ios::binary);
  std::vector<std::string> parts;
  for (std::string part; std::getline(stream, part, '\0');) parts.push_back(part);
  if (parts.size() < 2 || parts.back() != end_of_journal) return false;
  journal.within = parts.front();
  for (std::size_t i = 1; i + 1 < parts.size(); ++i)
    journal.files.emplace_back(parts[i].front(), parts[i].substr(1));
  return true;
}

std::vector<std::string> entries(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    names.push_back(at->path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

bool is_there(const fs::path& path) {
  struct stat ignored;
  return lstat(path.c_str(), &ignored) == 0;
}

bool is_folder(const fs::path& path) {
  struct stat there;
  return lstat(path.c_str(), &there) == 0 && S_ISDIR(there.st_mode);
}

/// Moves a file back under its name, or under a name that explains the conflict. Returns 0, or the
/// error if it stays.
int move_and_keep(const fs::path& from, const fs::path& folder) {
  const std::string name = from.filename().string();
  for (int copy = 0; copy < 1000; ++copy) {
    const std::string suffix = copy == 0 ? "" : copy == 1 ? ".kept" : fmt::format(".kept{}", copy);
    if (rename_new(from, folder / (name + suffix))) return 0;
    if (errno != EEXIST) return errno;
  }
  return EEXIST;
}

/// Handles the previous content of the target: removes listed files, returns others. `within`:
/// "tables/" for a subfolder of the target.
void clear_away(const fs::path& before, const fs::path& target, const Journal& journal,
                const std::string& within = {}) {
  for (const std::string& name : entries(before)) {
    if (journal.lists(within + name)) {
      unlink((before / name).c_str());
    } else if (is_folder(before / name) && journal.lists_within(within + name)) {
      clear_away(before / name, target / name, journal, within + name + '/');
    } else {
      if (!within.empty() && is_there(target.parent_path())) mkdir(target.c_str(), for_all);
      if (is_there(target)) move_and_keep(before / name, target);
    }
  }
  rmdir(before.c_str());
}

/// Returns 0, or the error of a file that could not be moved or removed; the rest can be done
/// later.
int fill(const fs::path& from, const fs::path& target, const Journal& journal) {
  int trouble = 0;
  for (const auto& [kind, name] : journal.files) {
    int error = 0;
    const fs::path folder = fs::path(name).parent_path();
    if (!folder.empty() && kind != removed) mkdir((target / folder).c_str(), for_all);
    if (kind == removed) {
      if (unlink((target / name).c_str()) != 0) error = errno;
    } else if (kind == replaced_by_new) {
      if (std::rename((from / name).c_str(), (target / name).c_str()) != 0) error = errno;
    } else if (is_there(from / name)) {
      error = move_and_keep(from / name, target / folder);
    }
    if (error != 0 && error != ENOENT) trouble = error;  // already done, or kept in the target
    if (folder.empty()) continue;
    rmdir((from / folder).c_str());  // removes empty folders
    if (kind == removed) rmdir((target / folder).c_str());
  }
  if (trouble == 0) rmdir(from.c_str());
  return trouble;
}

/// Completes or undoes a hidden folder; keeps it if that would lose data. Returns 0, or the reason
/// why the target is incomplete.
int heal(const fs::path& area) {
  const fs::path place = area.parent_path();
  for (const std::string& name : entries(area)) {
    if (name != "journal" && name != "new" && name != "old" && name != "fill")
      return 0;  // not ours
  }
  Journal journal;
  std::error_code ignored;
  int trouble = 0;
  if (!read_journal(area / "journal", journal)) {
    fs::remove_all(area, ignored);
    return 0;
  }
  if (journal.within.empty()) {
    if (is_there(area / "fill")) trouble = fill(area / "fill", place, journal);
    fs::remove_all(area / "new", ignored);
  } else {
    const fs::path target = place / journal.within, old = area / "old" / target.filename();
    if (is_there(old)) {
      if (!rename_new(old, target)) clear_away(old, target, journal);
    }
    rmdir((area / "old").c_str());
    clear_away(area / "new" / journal.within, target, journal);
    for (fs::path up = journal.within.parent_path(); !up.empty(); up = up.parent_path())
      rmdir((area / "new" / up).c_str());
    rmdir((area / "new").c_str());
  }
  const std::vector<std::string> left = entries(area);
  if (left == std::vector<std::string>{"journal"}) fs::remove_all(area, ignored);
  return trouble;
}

}  // namespace

std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> files;
  for (const std::string& name : entries(folder)) {
    const std::vector<std::string> inside =
        is_folder(folder / name) ? entries(folder / name) : std::vector<std::string>{};
    if (inside.empty()) files.push_back(name);
    for (const std::string& each : inside) files.push_back(name + '/' + each);
  }
  return files;
}

void recover_folder(const fs::path& folder) {
  for_each_abandoned(folder, [](const fs::path& path, bool is_folder) {
    if (is_folder) {
      heal(path);
    } else {
      unlink(path.c_str());
    }
  });
}

StagedFolder::StagedFolder(const fs::path& target, const std::vector<std::string>& own)
    : target_(behind_links(target)) {
  struct stat there, parent, working;
  if (stat(target_.c_str(), &there) == 0) {
    if (!S_ISDIR(there.st_mode)) fail_to_write(target_, ENOTDIR);
    recover_folder(target_);
    const fs::path above = target_.parent_path();
    const std::vector<std::string> held = files_in(target_);
    const bool holds_more = std::any_of(held.begin(), held.end(), [&](const std::string& name) {
      return std::find(own.begin(), own.end(), name) == own.end();
    });
    const bool must_stay = stat(above.c_str(), &parent) != 0 || parent.st_dev != there.st_dev ||
                           parent.st_ino == there.st_ino ||
                           access(above.c_str(), W_OK | X_OK) != 0 ||
                           (stat(".", &working) == 0 && working.st_dev == there.st_dev &&
                            working.st_ino == there.st_ino);
    place_ = must_stay || holds_more ? target_ : above;
  } else {
    place_ = target_.parent_path();
    while (!is_there(place_) && place_.has_relative_path()) place_ = place_.parent_path();
  }
  if (place_ != target_) {
    recover_folder(place_);
    within_ = target_.lexically_relative(place_);
  }
  open_area(place_);
  make_folder(area_ / "new", for_all);
  fs::path folder = area_ / "new";
  for (const fs::path& part : within_) make_folder(folder /= part, for_all);
}

void StagedFolder::open_area(const fs::path& place) {
  StagingFolder made = make_staging_folder(place, target_);
  area_ = std::move(made.path);
  lock_ = std::move(made.lock);
  SignalBlocker now;
  now.note(area_ / "journal", false);
}

void StagedFolder::make_folder(const fs::path& folder, unsigned mode) {
  SignalBlocker now;
  if (mkdir(folder.c_str(), mode) != 0) {
    const int error = errno;
    heal(area_);
    now.unregister(area_);
    area_.clear();
    fail_to_write(target_, error);
  }
  now.note(folder, true);
}

StagedFolder::~StagedFolder() {
  if (area_.empty()) return;
  SignalBlocker now;
  heal(area_);
  now.unregister(area_);
}

fs::path StagedFolder::staged(const std::string& name) {
  const fs::path file = area_ / "new" / within_ / name;
  if (!is_there(file.parent_path())) make_folder(file.parent_path(), for_all);
  return file;
}

void StagedFolder::write(const std::string& name, std::string_view content) {
  const fs::path file = staged(name);
  const Descriptor opened = [&] {
    SignalBlocker now;
    now.note(file, false);
    return create_file(file);
  }();
  if (!opened) fail_to_write(target_ / name, errno);
  names_.push_back(name);
  write_all(opened, content, target_ / name);
  flush_to_disk(opened, target_ / name);
}

void StagedFolder::keep(const std::string& name) {
  if (within_.empty()) {
    names_.push_back(name);  // the target and its file are kept
    return;
  }
  {
    const fs::path file = staged(name);
    SignalBlocker now;
    if (link((target_ / name).c_str(), file.c_str()) == 0) {
      now.note(file, false);
      names_.push_back(name);
      return;
    }
  }
  std::ifstream stream(target_ / name, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) throw MachineError(fmt::format("cannot read {}", (target_ / name).string()));
  write(name, content);
}

void StagedFolder::write_journal(const std::vector<std::string>& replaced) {
  const auto has = [](const std::vector<std::string>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  Journal journal{within_, {}};
  for (const std::string& name : replaced) {
    if (!has(names_, name)) journal.files.emplace_back(removed, name);
  }
  for (const std::string& name : names_) {
    const bool there = has(replaced, name);
    journal.files.emplace_back(there ? replaced_by_new : added, name);
    const fs::path file = target_ / name, folder = file.parent_path();
    const bool blocked = is_there(folder) && folder != target_ && !is_folder(folder);
    if (blocked || (!there && is_there(file)))
      throw InputError(fmt::format("will not replace {}: it is not from an earlier run",
                                   (blocked ? folder : file).string()));
  }
  const Descriptor file = [&] {
    const SignalBlocker now;
    return create_file(area_ / "journal");
  }();
  if (!file) fail_to_write(target_, errno);
  write_all(file, text_of(journal), target_);
  flush_to_disk(file, target_);
}

void StagedFolder::commit(const std::vector<std::string>& replaced) {
  const fs::path files = area_ / "new" / within_;
  for (const std::string& name : entries(files)) {
    if (is_folder(files / name)) flush_folder(files / name);
  }
  flush_folder(files);
  write_journal(replaced);
  flush_folder(area_);
  put_into_place();
  flush_folder(target_);
  flush_folder(target_.parent_path());
  if (place_ != target_.parent_path()) flush_folder(place_);
}

void StagedFolder::put_into_place() {
  SignalBlocker now;
  const fs::path files = area_ / "new" / within_;
  const auto check = [&](bool done) {
    if (!done) fail_to_write(target_, errno);
  };
  struct stat there;
  if (within_.empty()) {
    check(std::rename(files.parent_path().c_str(), (area_ / "fill").c_str()) == 0);
  } else if (stat(target_.c_str(), &there) == 0) {
    if (!S_ISDIR(there.st_mode)) fail_to_write(target_, ENOTDIR);
    chmod(files.c_str(), there.st_mode & 07777);
    if (!exchange(files, target_)) {
      if (errno != EINVAL && errno != ENOSYS) fail_to_write(target_, errno);
      const fs::path old = area_ / "old";
      check(mkdir(old.c_str(), for_owner) == 0);
      check(std::rename(target_.c_str(), (old / target_.filename()).c_str()) == 0);
      check(rename_new(files, target_));
    }
  } else {
    // Parent folders may have appeared in the meantime; moves the first missing one into place.
    fs::path from = area_ / "new", to = place_;
    for (const fs::path& part : within_) {
      from /= part;
      to /= part;
      if (!is_there(to)) break;
    }
    check(rename_new(from, to));
  }
  const int trouble = heal(area_);
  now.unregister(area_);
  area_.clear();
  if (trouble != 0) fail_to_write(target_, trouble);
}

}  // namespace wearwell
