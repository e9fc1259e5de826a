#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace wearwell::prognosis {

/// Bytes packed as one zlib stream (RFC 1950): in pieces, on all threads, with the same result for
/// any number of threads.
std::string packed(std::string_view body);

/// Unpacks; `size` is that of the body. Throws InputError that names the file if it differs.
std::string unpacked(std::string_view bytes, std::uint64_t size, const std::string& file);

}  // namespace wearwell::prognosis
