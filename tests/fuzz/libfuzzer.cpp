// One program a target, under libFuzzer with coverage and the address and undefined-behaviour sanitizers: `make fuzz`.
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto* const target = [] {
    for (const auto& each : wearwell::fuzz::targets()) {
      if (std::strcmp(each.name, FUZZ_TARGET) == 0) return &each;
    }
    return static_cast<const wearwell::fuzz::Target*>(nullptr);
  }();
  target->run({reinterpret_cast<const char*>(data), size});
  return 0;
}
