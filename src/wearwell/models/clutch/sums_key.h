#pragma once

#include <string>

#include "wearwell/models/clutch/clutch_sql.h"

namespace wearwell::clutch {

/// Prefix of the keys of sums of one table in a server: several tables may share one table prefix.
/// `model`: SHA-1 of model.json.
std::string table_key(const std::string& model, const SqlSource& source);
/// How the table is read: names and units of its columns, as twelve hexadecimal digits.
std::string columns_key(const SqlSource& source);

}  // namespace wearwell::clutch
