#include "wearwell/monitor/backup.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "wearwell/base/disk.h"
#include "wearwell/base/error.h"
#include "wearwell/monitor/sqlite_session.h"

namespace wearwell::monitor {
namespace {

namespace fs = std::filesystem;

void reach_disk(const fs::path& path) {
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file || fsync(file.get()) != 0)
    throw StoreError(fmt::format("{}: {}", path.string(), std::strerror(errno)));
}

/// Removes a file that is not finished.
struct Unfinished {
  fs::path path;
  ~Unfinished() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
};

}  // namespace

void backup_store(const std::string& url, const fs::path& folder, const StoreColumns& columns,
                  const fs::path& target) {
  if (is_postgres(url))
    throw InputError(
        fmt::format("--backup: the store {} is PostgreSQL; use pg_dump, which is consistent while "
                    "a monitor runs",
                    shown_store(url)));
  std::error_code ignored;
  if (fs::exists(target, ignored))
    throw InputError(
        fmt::format("--backup: {} exists already; a backup is a new file", target.string()));
  open_store(url, folder, columns, Access::read);  // checks that it is one
  const Unfinished unfinished{target.string() + fmt::format(".{}.unfinished", getpid())};
  SqliteSession session(folder / url);
  SqliteStatement(session, "VACUUM INTO ?")
      .bind(1, std::string_view(unfinished.path.string()))
      .run();
  reach_disk(unfinished.path);
  // Without replacing a file that has appeared meanwhile.
  if (link(unfinished.path.c_str(), target.c_str()) != 0)
    throw InputError(fmt::format("--backup: {}: {}", target.string(), std::strerror(errno)));
  reach_disk(target.has_parent_path() ? target.parent_path() : fs::path("."));
}

}  // namespace wearwell::monitor
