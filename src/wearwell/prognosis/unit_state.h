#pragma once

#include <string>
#include <string_view>

#include "wearwell/prognosis/bytes.h"

namespace wearwell::prognosis {

/// The start of a unit's saved state: the checksum of the rest, `mark` (kind and version of the
/// state), and its population.
ByteWriter unit_state(std::string_view mark, const std::string& fingerprint);
std::string signed_unit_state(ByteWriter state);

/// The rest; valid while `bytes` live. Throws InputError if they are damaged, of another version,
/// or of another population.
ByteReader read_unit_state(std::string_view bytes, std::string_view mark,
                           const std::string& fingerprint);

}  // namespace wearwell::prognosis
