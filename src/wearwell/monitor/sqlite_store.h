#pragma once

#include <filesystem>
#include <memory>

#include "wearwell/monitor/store.h"

namespace wearwell::monitor {

/// A store in one file (docs/reference/monitor.md has its tables). Its journal is a write-ahead log
/// with synchronous = FULL: a commit returns when the disk has acknowledged it. Throws as
/// open_store does.
std::unique_ptr<Store> open_sqlite_store(const std::filesystem::path& file,
                                         const StoreColumns& columns, Access access,
                                         const StoreNotice& reported);
/// As check_place does.
void check_sqlite_place(const std::filesystem::path& file);

}  // namespace wearwell::monitor
