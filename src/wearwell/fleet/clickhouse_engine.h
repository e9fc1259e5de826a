#pragma once

#include <memory>
#include <string>

#include "wearwell/fleet/engine.h"

namespace wearwell::fleet {

/// A server of ClickHouse through its HTTP interface, and the table of cycles in it, by a name as
/// `table_identifier` reads it:
///
///   clickhouse://USER:PASSWORD@HOST:8123,HOST:8123/DATABASE     clickhouses:// or https:// with
///   TLS, port 8443
///
/// Several hosts are replicas of each other: the first that answers is used, and if it is lost the
/// next, from the beginning. The default password is CLICKHOUSE_PASSWORD. The work is one session
/// with temporary tables. Partial answers are refused: settings that would allow them
/// (skip_unavailable_shards, replicas that lag behind, limits that truncate) are overridden, and
/// answers start when a query is complete. If the table is Distributed a unit must be on one shard.
/// Throws InputError, or `Lost` if a retry may help.
std::unique_ptr<Engine> clickhouse_engine(const std::string& address, const std::string& table);

/// Whether an address is one of ClickHouse.
bool is_clickhouse(const std::string& address);

}  // namespace wearwell::fleet
