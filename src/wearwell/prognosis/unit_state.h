#pragma once

#include <string>
#include <string_view>

#include "wearwell/prognosis/bytes.h"

namespace wearwell::prognosis {

/// How the saved state of a unit begins: the checksum of all that follows, `mark` (what kind of state, and its version), the
/// population that it is of.
ByteWriter unit_state(std::string_view mark, const std::string& fingerprint);
std::string signed_unit_state(ByteWriter state);

/// Behind that; valid while `bytes` live. Throws InputError where they are damaged, of another version, or of another population.
ByteReader read_unit_state(std::string_view bytes, std::string_view mark,
                           const std::string& fingerprint);

}  // namespace wearwell::prognosis
