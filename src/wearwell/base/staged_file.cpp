#include "wearwell/base/staged_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

#include "wearwell/base/ending.h"
#include "wearwell/base/staged_folder.h"

namespace wearwell {
namespace fs = std::filesystem;

StagedFile::StagedFile(const fs::path& target, Links links) {
  target_ = links == Links::follow ? behind_links(target) : fs::absolute(target);
  struct stat there;
  const bool exists =
      (links == Links::follow ? stat(target.c_str(), &there) : lstat(target_.c_str(), &there)) == 0;
  if (exists && S_ISDIR(there.st_mode)) fail_to_write(target, EISDIR);
  if (exists && !S_ISREG(there.st_mode) && links == Links::follow) {
    file_ = Descriptor(::open(target.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC));
    if (!file_) fail_to_write(target, errno);
    return;
  }
  const bool replaces = exists && S_ISREG(there.st_mode);
  if (replaces && access(target_.c_str(), W_OK) != 0) fail_to_write(target, errno);
  if (links == Links::follow) make_folders();
  recover_folder(target_.parent_path());
  while (!file_) {
    const fs::path staging = staging_name(target_.parent_path());
    SignalBlocker now;
    Descriptor file = create_file(staging);
    const int error = errno;
    if (!file && error == EEXIST) continue;
    if (!file) {
      remove_folders();
      fail_to_write(target_, error);
    }
    if (!lock_staging(file, staging, target_)) continue;
    now.note(staging, false);
    file_ = std::move(file);
    staging_ = staging;
  }
  if (replaces) fchmod(file_.get(), there.st_mode & 07777);
}

void StagedFile::make_folders() {
  std::vector<fs::path> missing;  // innermost first
  struct stat ignored;
  for (fs::path up = target_.parent_path(); lstat(up.c_str(), &ignored) != 0 && errno == ENOENT;
       up = up.parent_path())
    missing.push_back(up);
  for (auto each = missing.rbegin(); each != missing.rend(); ++each) {
    if (mkdir(each->c_str(), 0777) == 0) {
      made_.push_back(*each);
    } else if (const int error = errno; error != EEXIST) {
      remove_folders();
      fail_to_write(target_, error);
    }
  }
}

/// Keeps folders with other content.
void StagedFile::remove_folders() {
  for (auto each = made_.rbegin(); each != made_.rend(); ++each) rmdir(each->c_str());
  made_.clear();
}

StagedFile::~StagedFile() {
  if (staging_.empty()) return;
  SignalBlocker now;
  unlink(staging_.c_str());
  now.unregister(staging_);
  remove_folders();
}

void StagedFile::commit() {
  if (staging_.empty()) {
    file_ = Descriptor();
    return;
  }
  flush_to_disk(file_, target_);
  {
    SignalBlocker now;
    if (std::rename(staging_.c_str(), target_.c_str()) != 0) fail_to_write(target_, errno);
    now.unregister(staging_);
    staging_.clear();
  }
  flush_folder(target_.parent_path());
}

void write_file(const fs::path& target, std::string_view content, Links links) {
  StagedFile file(target, links);
  file.write(content);
  file.commit();
}

}  // namespace wearwell
