// Every seed of the corpus, every case that was once a finding, and a few mutations of each: read or refused, nothing else.
// WEARWELL_FUZZ_MUTATIONS says how many, instead of 20.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "fuzz/targets.h"
#include "wearwell/base/rng.h"

namespace wearwell {
namespace {

namespace fs = std::filesystem;

class Replay : public testing::TestWithParam<fuzz::Target> {};

std::string mutated(std::string bytes, Rng& rng) {
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(rng.uniform() * static_cast<double>(n));
  };
  for (std::size_t n = 1 + below(4); n-- > 0 && !bytes.empty();) {
    const std::size_t at = below(bytes.size());
    switch (below(4)) {
      case 0:
        bytes[at] = static_cast<char>(below(256));
        break;
      case 1:
        bytes.erase(at, 1 + below(8));
        break;
      case 2:
        bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(16)));
        break;
      default:
        bytes.resize(at);
    }
  }
  return bytes;
}

int mutations() {
  const char* many = std::getenv("WEARWELL_FUZZ_MUTATIONS");
  return many ? std::atoi(many) : 20;
}

TEST_P(Replay, ReadsOrRefuses) {
  const fs::path corpus = fs::path(PROJECT_SOURCE_DIR "/tests/fuzz/corpus") / GetParam().name;
  int seeds = 0;
  for (const auto& entry : fs::directory_iterator(corpus)) {
    std::ifstream stream(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    ASSERT_NO_THROW(GetParam().run(bytes)) << entry.path();
    Rng rng(1, static_cast<std::uint64_t>(++seeds));
    for (int i = 0; i < mutations(); ++i) {
      const std::string other = mutated(bytes, rng);
      ASSERT_NO_THROW(GetParam().run(other)) << entry.path() << " mutated to:\n" << other;
    }
  }
  EXPECT_GT(seeds, 0) << corpus;
}

INSTANTIATE_TEST_SUITE_P(Doors, Replay,
                         testing::ValuesIn(fuzz::targets().begin(), fuzz::targets().end()),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace wearwell
