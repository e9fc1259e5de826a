#pragma once

#include <memory>
#include <string>

#include "wearwell/fleet/engine.h"

namespace wearwell::fleet {

/// A server of PostgreSQL, by a libpq address ("postgresql://user@host/database"; passwords belong
/// into ~/.pgpass), and the table of cycles in it, by a name as `table_identifier` reads it. The
/// work is one transaction of isolation level repeatable read, with `read_only` one that can write
/// nothing. Throws InputError.
std::unique_ptr<Engine> postgres_engine(const std::string& address, const std::string& table,
                                        bool read_only = false);

}  // namespace wearwell::fleet
