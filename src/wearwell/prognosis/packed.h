#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace wearwell::prognosis {

/// Bytes packed as one zlib stream (RFC 1950): by pieces, on all threads, the same whatever their number.
std::string packed(std::string_view body);

/// Back again; `size` is that of the body. Throws InputError that names the file where it is not.
std::string unpacked(std::string_view bytes, std::uint64_t size, const std::string& file);

}  // namespace wearwell::prognosis
