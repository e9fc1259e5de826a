// What a state packs in pieces is one stream as zlib reads it.
#include "wearwell/prognosis/packed.h"

#include <gmock/gmock.h>

#include <random>

#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell::prognosis {
namespace {

TEST(Packed, OfAnyLengthItComesBack) {
  std::mt19937 random(1);
  constexpr std::size_t piece = std::size_t{1} << 20;
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{1}, piece - 1, piece, piece + 1, 3 * piece + 77}) {
    for (const unsigned letters : {1U, 3U, 256U}) {
      std::string body(length, '\0');
      for (char& each : body) each = static_cast<char>(random() % letters);
      const std::string bytes = packed(body);
      EXPECT_EQ(unpacked(bytes, length, "f"), body) << length << " " << letters;
      EXPECT_LT(bytes.size(), 1.001 * static_cast<double>(length) + 100);
      if (letters == 1 && length > piece) {
        EXPECT_LT(bytes.size(), length / 100);
      }
    }
  }
}

TEST(Packed, WhatIsNoneIsRefused) {
  const std::string bytes = packed("wear");
  for (const std::string& wrong :
       {bytes.substr(0, bytes.size() - 1), bytes + "x", std::string(), "y" + bytes.substr(1)})
    EXPECT_THAT(message_of<InputError>([&] { unpacked(wrong, 4, "f"); }),
                testing::HasSubstr("f is damaged"));
  EXPECT_THAT(message_of<InputError>([&] { unpacked(bytes, 5, "f"); }),
              testing::HasSubstr("f is damaged"));
}

}  // namespace
}  // namespace wearwell::prognosis
