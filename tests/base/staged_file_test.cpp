#include "wearwell/base/staged_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include "support/disk_content.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

unsigned mode(const fs::path& path) {
  struct stat status;
  return stat(path.c_str(), &status) == 0 ? status.st_mode & 07777 : 0;
}

/// The umask while it lives.
class Umask {
 public:
  explicit Umask(mode_t mask) : before_(umask(mask)) {}
  ~Umask() { umask(before_); }

 private:
  mode_t before_;
};

class StagedFileTest : public ScratchTest {
 protected:
  const fs::path target = folder() / "state.json";
};

TEST_F(StagedFileTest, AppearsAtCommit) {
  StagedFile file(target);
  file.write("one ");
  file.write("two");
  EXPECT_FALSE(fs::exists(target));
  file.commit();
  EXPECT_EQ(content(target), "one two");
  EXPECT_THAT(entries(folder()), ElementsAre("state.json"));
}

TEST_F(StagedFileTest, GoesWithoutCommit) {
  write("state.json", "old");
  {
    StagedFile file(target);
    file.write("new");
    EXPECT_EQ(entries(folder()).size(), 2u);
  }
  EXPECT_THAT(entries(folder()), ElementsAre("state.json"));
  EXPECT_EQ(content(target), "old");
}

// No two stagings share a name, and what lies under a name that could be foreseen is not touched.
TEST_F(StagedFileTest, MakesItsFolders) {
  { const StagedFile file(folder() / "a/b/c.csv"); }
  EXPECT_THAT(entries(folder()), IsEmpty());
  write_file(folder() / "a/b/c.csv", "one");
  EXPECT_EQ(content(folder() / "a/b/c.csv"), "one");
  write("file", "");
  EXPECT_THROW(write_file(folder() / "file/x/c.csv", "one"), InputError);
  EXPECT_THROW(write_file(folder() / "x/c.csv", "one", Links::replace), InputError);
}

TEST_F(StagedFileTest, NameCannotBeForeseen) {
  write("victim", "precious");
  for (const char* name : {"state.json.new", "state.json.tmp", ".state.json.new"})
    fs::create_symlink(folder() / "victim", folder() / name);
  StagedFile one(target), other(target);
  std::vector<std::string> staged;
  for (const std::string& name : entries(folder())) {
    if (is_staging_name(name)) staged.push_back(name);
  }
  ASSERT_EQ(staged.size(), 2u);
  EXPECT_NE(staged[0].substr(21, 4), staged[1].substr(21, 4));
  one.write("1");
  one.commit();
  EXPECT_EQ(content(folder() / "victim"), "precious");
  EXPECT_TRUE(fs::is_symlink(folder() / "state.json.new"));
}

TEST_F(StagedFileTest, HonoursUmaskAndKeepsPermissions) {
  {
    const Umask open(0);
    write_file(folder() / "open", "");
  }
  {
    const Umask closed(077);
    write_file(folder() / "closed", "");
    write_file(folder() / "open", "again");
  }
  EXPECT_EQ(mode(folder() / "open"), 0666u);
  EXPECT_EQ(mode(folder() / "closed"), 0600u);
}

TEST_F(StagedFileTest, FollowsTheLinksOfAUser) {
  fs::create_directories(folder() / "real" / "deep");
  write("real/deep/file", "old");
  fs::create_symlink("real/deep", folder() / "way");
  fs::create_symlink("way/file", folder() / "link");
  fs::create_symlink(folder() / "link", folder() / "link to link");
  fs::create_symlink("real/deep/missing", folder() / "dangling");
  write_file(folder() / "link to link", "new");
  write_file(folder() / "dangling", "made");
  EXPECT_TRUE(fs::is_symlink(folder() / "link"));
  EXPECT_TRUE(fs::is_symlink(folder() / "link to link"));
  EXPECT_TRUE(fs::is_symlink(folder() / "dangling"));
  EXPECT_EQ(content(folder() / "real/deep/file"), "new");
  EXPECT_EQ(content(folder() / "real/deep/missing"), "made");
  EXPECT_THAT(entries(folder() / "real/deep"), ElementsAre("file", "missing"));
  fs::create_symlink("real/deep/..", folder() / "back");
  write_file(folder() / "back" / "deep" / ".." / "beside", "1");
  write_file(folder() / "way" / ".." / "beside", "2");  // not folder()/beside
  EXPECT_EQ(content(folder() / "real/beside"), "2");
  EXPECT_EQ(behind_links(folder() / "back"), folder() / "real");
  EXPECT_EQ(behind_links(folder() / "way" / ".."), folder() / "real");
  EXPECT_EQ(behind_links("/"), "/");
  fs::create_symlink("round", folder() / "round");
  EXPECT_THAT(message_of<InputError>([&] { write_file(folder() / "round", ""); }),
              HasSubstr("symbolic links"));
}

TEST_F(StagedFileTest, ReplacesALinkWithinAFolderOfAnybody) {
  write("victim", "precious");
  fs::create_symlink("victim", folder() / "report.html");
  write_file(folder() / "report.html", "page", Links::replace);
  EXPECT_FALSE(fs::is_symlink(folder() / "report.html"));
  EXPECT_EQ(content(folder() / "report.html"), "page");
  EXPECT_EQ(content(folder() / "victim"), "precious");
}

TEST_F(StagedFileTest, WritesDevicesAndPipesAsTheyStand) {
  write_file("/dev/null", "anything");
  struct stat null;
  ASSERT_EQ(stat("/dev/null", &null), 0);
  EXPECT_TRUE(S_ISCHR(null.st_mode));
  EXPECT_THAT(message_of<MachineError>([&] { write_file("/dev/full", "anything"); }),
              HasSubstr("is the disk full?"));
  const fs::path pipe = folder() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  write_file(pipe, "through");
  char text[16];
  EXPECT_EQ(read(reader, text, sizeof text), 7);
  close(reader);
  EXPECT_THAT(entries(folder()), ElementsAre("pipe"));
}

TEST_F(StagedFileTest, SaysWhoIsAtFault) {
  EXPECT_THAT(message_of<InputError>([&] { write_file(folder(), ""); }), HasSubstr("directory"));
  EXPECT_THAT(message_of<InputError>([&] { write_file("/proc/no/file", ""); }),
              HasSubstr("No such file"));
  EXPECT_THROW(fail_to_write("x", EACCES), InputError);
  EXPECT_THROW(fail_to_write("x", ENOSPC), MachineError);
  EXPECT_THROW(fail_to_write("x", EROFS), MachineError);
  EXPECT_THROW(fail_to_write("x", EIO), MachineError);
}

TEST_F(StagedFileTest, RemovesWhatAKilledProgramLeft) {
  write(".wearwell.unfinished.abcdefghijkl", "half");    // nobody holds its lock
  write(".wearwell.unfinished.abc", "somebody else's");  // no name of ours
  write(".wearwell.unfinished.ABCDEFGHIJKL", "somebody else's");
  fs::create_symlink("state.json", folder() / ".wearwell.unfinished.mnopqrstuvwx");
  StagedFile alive(folder() / "other");
  write_file(target, "new");
  alive.write("x");
  alive.commit();
  EXPECT_THAT(entries(folder()),
              ElementsAre(".wearwell.unfinished.ABCDEFGHIJKL", ".wearwell.unfinished.abc",
                          ".wearwell.unfinished.mnopqrstuvwx", "other", "state.json"));
}

}  // namespace
}  // namespace wearwell
