#pragma once

#include <filesystem>
#include <string>

#include "wearwell/monitor/store.h"

namespace wearwell::monitor {

/// Writes the store of a configuration, as it is at one moment, to a new file, also while a monitor
/// runs. The file is whole or not there. Throws InputError: no store, the file exists, or a store of
/// PostgreSQL, which pg_dump is for; StoreError.
void backup_store(const std::string& url, const std::filesystem::path& folder,
                  const StoreColumns& columns, const std::filesystem::path& target);

}  // namespace wearwell::monitor
