#pragma once

#include <ostream>
#include <span>
#include <string_view>

namespace wearwell::fuzz {

/// One door through which bytes of strangers come in. `run` returns when they were read or refused (InputError); whatever else
/// leaves it, and an answer that breaks what the door promises, is a finding.
struct Target {
  const char* name;  ///< of its folder in tests/fuzz/corpus
  void (*run)(std::string_view bytes);
};

inline void PrintTo(const Target& target, std::ostream* out) {
  *out << target.name;
}

std::span<const Target> targets();

}  // namespace wearwell::fuzz
