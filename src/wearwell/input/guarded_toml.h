#pragma once

// The only way to toml++. Some text that is no TOML ("[.=") breaks an assertion of it, and without its assertions the
// behaviour is undefined. So they are on here, and throw: in the headers, because Debian's library is built without.
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
