#include "wearwell/monitor/backup.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "wearwell/base/disk.h"
#include "wearwell/base/ending.h"
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

/// Removes a file that is not finished, also when a signal ends the program, with the files that
/// SQLite keeps beside it.
struct Unfinished {
  explicit Unfinished(std::string name) : path(std::move(name)) {
    SignalBlocker blocker;
    for (const fs::path& each : all()) blocker.note(each, false);
  }
  ~Unfinished() {
    SignalBlocker blocker;
    std::error_code ignored;
    for (const fs::path& each : all()) {
      fs::remove(each, ignored);
      blocker.unregister(each);
    }
  }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
  std::array<fs::path, 2> all() const { return {path, fs::path(path.string() + "-journal")}; }

  fs::path path;
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
  open_store(url, folder, columns, Access::copy);  // checks that it is one
  const fs::path beside = fs::absolute(target).lexically_normal();
  const Unfinished unfinished(beside.string() + fmt::format(".{}.unfinished", getpid()));
  SqliteSession session(folder / url);
  SqliteStatement(session, "VACUUM INTO ?")
      .bind(1, std::string_view(unfinished.path.string()))
      .run();
  reach_disk(unfinished.path);
  // Without replacing a file that has appeared meanwhile.
  if (!rename_new(unfinished.path, target))
    throw InputError(fmt::format("--backup: {}: {}", target.string(), std::strerror(errno)));
  reach_disk(target.has_parent_path() ? target.parent_path() : fs::path("."));
}

}  // namespace wearwell::monitor
