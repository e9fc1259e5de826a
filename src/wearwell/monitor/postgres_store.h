#pragma once

#include <memory>
#include <string>

#include "wearwell/monitor/store.h"

namespace wearwell::monitor {

/// A store in a database of PostgreSQL, in tables "wearwell_..." (docs/reference/monitor.md). A
/// lost connection is reopened by the next call. Throws as open_store does.
std::unique_ptr<Store> open_postgres_store(const std::string& url, const StoreColumns& columns,
                                           Access access, const StoreNotice& reported);
/// As check_place does.
void check_postgres_place(const std::string& url);

}  // namespace wearwell::monitor
