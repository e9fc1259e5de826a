#pragma once

#include <memory>
#include <string>

#include "wearwell/fleet/engine.h"

namespace wearwell::fleet {

/// A server of ClickHouse by its HTTP interface, and the table of cycles in it, as `table_identifier` reads its name:
///
///   clickhouse://USER:PASSWORD@HOST:8123,HOST:8123/DATABASE     clickhouses:// or https:// by TLS, port 8443
///
/// Several hosts are replicas of each other: the first that answers is asked, and where it is lost the next, from the beginning. Without a
/// password in the address it is that of CLICKHOUSE_PASSWORD. All that is done is one session of its server with temporary tables.
/// A part of an answer is none: settings that would give one (skip_unavailable_shards, replicas that stay behind, limits that
/// break off) are overruled, answers begin when a query is through. Where the table is Distributed a unit must lie on one
/// shard. Throws InputError, `Lost` where trying again may help.
std::unique_ptr<Engine> clickhouse_engine(const std::string& address, const std::string& table);

/// Whether an address is of ClickHouse.
bool is_clickhouse(const std::string& address);

}  // namespace wearwell::fleet
