#include "wearwell/input/fingerprint.h"

#include <gtest/gtest.h>

#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell {
namespace {

class Fingerprint : public ScratchTest {};

// FIPS 180: the digest of "abc".
TEST_F(Fingerprint, Sha1OfAFile) {
  EXPECT_EQ(sha1(write("abc", "abc")), "a9993e364706816aba3e25717850c26c9cd0d89d");
  EXPECT_THROW(sha1(folder() / "missing"), InputError);
}

TEST_F(Fingerprint, OfWhatWasObserved) {
  const std::string of = fingerprint("life", {1, 2e5, 3});
  EXPECT_EQ(of, fingerprint("life", {1, 2e5 * (1 + 1e-15), 3}));  // units round differently
  EXPECT_NE(of, fingerprint("life", {1, 2e5 * (1 + 1e-9), 3}));
  EXPECT_NE(of, fingerprint("life", {2e5, 1, 3}));
  EXPECT_NE(of, fingerprint("life", {1, 2e5}));
  EXPECT_NE(of, fingerprint("wear depth", {1, 2e5, 3}));
}

}  // namespace
}  // namespace wearwell
