#pragma once

#include <istream>
#include <string>
#include <string_view>

namespace wearwell {

/// SHA-1, 40 hexadecimal digits as printed by `sha1sum`.
std::string sha1_of(std::string_view bytes);
/// The SHA-1 of the rest of a stream; check bad() afterwards.
std::string sha1_of(std::istream& stream);

}  // namespace wearwell
