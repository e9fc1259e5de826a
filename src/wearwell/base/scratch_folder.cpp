#include "wearwell/base/scratch_folder.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "wearwell/base/ending.h"
#include "wearwell/base/staged_folder.h"

namespace wearwell {

// Recovery of a hidden folder without a journal removes its folder `new` with all content.
ScratchFolder::ScratchFolder(const std::filesystem::path& parent) {
  const std::filesystem::path place = std::filesystem::absolute(parent);
  recover_folder(place);
  hidden_ = make_staging_folder(place, parent);
  path_ = hidden_.path / "new";
  SignalBlocker now;
  now.unregister(hidden_.path);
  now.note_tree(hidden_.path);
  if (mkdir(path_.c_str(), 0700) == 0) return;
  const int error = errno;
  rmdir(hidden_.path.c_str());
  now.unregister(hidden_.path);
  fail_to_write(parent, error);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(hidden_.path, ignored);
  SignalBlocker now;
  now.unregister(hidden_.path);
}

}  // namespace wearwell
