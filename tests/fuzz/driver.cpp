// Coverage-guided fuzzing of one target by libFuzzer: fuzz --target=NAME [what libFuzzer takes].
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "fuzz/targets.h"

namespace {

const wearwell::fuzz::Target* chosen = nullptr;

}  // namespace

// Whatever leaves a target, an exception too, ends the process: libFuzzer keeps the bytes.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  chosen->run({reinterpret_cast<const char*>(data), size});
  return 0;
}

// libFuzzer itself leaves alone what begins with two dashes.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  for (int i = 1; i < *argc; ++i) {
    for (const auto& target : wearwell::fuzz::targets()) {
      if ((*argv)[i] == "--target=" + std::string(target.name)) chosen = &target;
    }
  }
  if (chosen) return 0;
  std::fputs("fuzz: which --target=NAME? One of:", stderr);
  for (const auto& target : wearwell::fuzz::targets()) std::fprintf(stderr, " %s", target.name);
  std::fputs("\n", stderr);
  std::exit(2);
}
