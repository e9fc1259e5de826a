#include "wearwell/base/same_file.h"

#include <gmock/gmock.h>

#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class SameFile : public ScratchTest {
 protected:
  const fs::path input = write("in.csv", "x\n");

  std::string refusal(const fs::path& output) const {
    return message_of<InputError>([&] {
      refuse_overwriting({{"the cycles", input}}, {{"--trace", output}});
    });
  }
};

TEST_F(SameFile, ByAnyName) {
  EXPECT_THAT(refusal(input), AllOf(HasSubstr("--trace"), HasSubstr("would overwrite the cycles")));
  fs::create_directory(folder() / "sub");
  fs::create_symlink("in.csv", folder() / "link");
  fs::create_hard_link(input, folder() / "hard");
  fs::create_directory_symlink(folder(), folder() / "sub" / "up");
  for (const char* other : {"sub/../in.csv", "./in.csv", "link", "hard", "sub/up/in.csv"})
    EXPECT_NE(refusal(folder() / other), "") << other;
  const fs::path before = fs::current_path();
  fs::current_path(folder());
  EXPECT_NE(refusal("in.csv"), "");
  fs::current_path(before);
}

TEST_F(SameFile, WhichDoesNotExistYet) {
  fs::create_symlink("state.json", folder() / "link");
  EXPECT_THAT(message_of<InputError>([&] {
                refuse_overwriting(
                    {}, {{"--state", folder() / "state.json"}, {"--trace", folder() / "link"}});
              }),
              HasSubstr("is the same file as --state"));
}

TEST_F(SameFile, WithinAFolderThatIsReplaced) {
  EXPECT_THAT(refusal(folder()), HasSubstr("is a folder that contains the cycles"));
}

TEST_F(SameFile, OthersPass) {
  refuse_overwriting({{"the cycles", input}, {"a pipe", "/dev/null"}, {"none", ""}},
                     {{"--trace", folder() / "out.csv"},
                      {"--state", ""},
                      {"--output", "/dev/null"},
                      {"-o", folder() / "missing"}});
}

}  // namespace
}  // namespace wearwell
