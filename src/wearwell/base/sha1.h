#pragma once

#include <istream>
#include <string>
#include <string_view>

namespace wearwell {

/// SHA-1, 40 hexadecimal digits as `sha1sum` prints them.
std::string sha1_of(std::string_view bytes);
/// Of all that is left in a stream; look at bad() afterwards.
std::string sha1_of(std::istream& stream);

}  // namespace wearwell
