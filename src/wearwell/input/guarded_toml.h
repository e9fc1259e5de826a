#pragma once

// Includes toml++; use no other include. Some invalid TOML ("[.=") fails an assertion of toml++,
// and without assertions the behaviour is undefined. So its assertions are enabled and throw. It is
// used as headers because Debian's library is built without assertions.
namespace wearwell {

struct NoToml {};
[[noreturn]] inline void toml_assertion_failed() {
  throw NoToml();
}

}  // namespace wearwell

#undef NDEBUG
#undef TOML_SHARED_LIB
#undef TOML_HEADER_ONLY
#define TOML_HEADER_ONLY 1
#define TOML_ASSERT(expr) ((expr) ? static_cast<void>(0) : wearwell::toml_assertion_failed())
#define TOML_MAX_NESTED_VALUES 32
#include <toml++/toml.h>
