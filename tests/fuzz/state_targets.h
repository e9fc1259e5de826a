#pragma once

#include <string_view>

namespace wearwell::fuzz {

/// state.bin: the bytes as they are, and the same as the body of one that is packed and signed.
void carried(std::string_view bytes);
/// What a store keeps of a unit on line, signed, of a population that the target knows.
void tracked(std::string_view bytes);

}  // namespace wearwell::fuzz
