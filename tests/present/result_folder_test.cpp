#include "wearwell/present/result_folder.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "support/disk_content.h"
#include "support/run_command.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

class ResultFolderTest : public ScratchTest {
 protected:
  const fs::path target = folder() / "results";

  void put_result(const std::string& summary) const {
    ResultFolder result(target);
    result.write("summary.json", summary);
    result.commit();
  }
  std::string refusal(const fs::path& where) const {
    return message_of<InputError>([&] { ResultFolder{where}; });
  }
  // The hidden folder beside the target into which files go before the commit.
  fs::path staging() const {
    for (const std::string& name : entries(folder())) {
      if (name.front() == '.') return folder() / name;
    }
    throw std::logic_error("no staging folder");
  }
};

TEST_F(ResultFolderTest, AppearsAtCommit) {
  ResultFolder result(target);
  result.write("summary.json", "{}");
  result.write("study.toml", "title = 1\n");
  EXPECT_FALSE(fs::exists(target));
  result.commit();
  EXPECT_THAT(entries(target), ElementsAre("results.sha1", "study.toml", "summary.json"));
  EXPECT_EQ(content(target / "summary.json"), "{}");
  EXPECT_EQ(content(target / "study.toml"), "title = 1\n");
  EXPECT_THAT(entries(folder()), ElementsAre("results"));
  EXPECT_EQ(result.path(), target);
}

// coreutils is the other who can compute SHA-1.
TEST_F(ResultFolderTest, ListAgreesWithSha1sum) {
  ResultFolder result(target);
  result.write("summary.json", std::string(100'000, 'x'));
  result.write("a file", "");
  result.commit();
  const CommandResult run = run_command("cd '" + target.string() + "' && sha1sum -c results.sha1");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out, "summary.json: OK\na file: OK\n");
}

TEST_F(ResultFolderTest, LeavesNothingWithoutCommit) {
  {
    ResultFolder result(folder() / "a" / "b" / "results");
    result.write("summary.json", "{}");
  }
  EXPECT_THAT(entries(folder()), IsEmpty());
}

TEST_F(ResultFolderTest, MakesParentsAndReadsTrailingSlash) {
  ResultFolder result(folder() / "a" / "b" / "results/");
  result.write("summary.json", "{}");
  result.commit();
  EXPECT_THAT(entries(folder() / "a" / "b" / "results"),
              ElementsAre("results.sha1", "summary.json"));
}

TEST_F(ResultFolderTest, ReplacesAnEarlierResultWhole) {
  {
    ResultFolder first(target);
    first.write("summary.json", "1");
    first.write("draws_3.csv", "x");
    first.commit();
  }
  put_result("2");
  EXPECT_THAT(entries(target), ElementsAre("results.sha1", "summary.json"));
  EXPECT_EQ(content(target / "summary.json"), "2");
  EXPECT_THAT(entries(folder()), ElementsAre("results"));
}

TEST_F(ResultFolderTest, TakesAnEmptyFolder) {
  fs::create_directory(target);
  put_result("1");
  EXPECT_EQ(content(target / "summary.json"), "1");
}

TEST_F(ResultFolderTest, RefusesWhatIsNotOurs) {
  EXPECT_THAT(refusal(write("file", "")), HasSubstr("it is not a folder"));
  fs::create_directory(folder() / "project");
  write("project/study.toml", "");
  EXPECT_THAT(refusal(folder() / "project"),
              HasSubstr("it contains study.toml, and no results.sha1"));
  put_result("1");
  write("results/notes.txt", "precious");
  EXPECT_THAT(refusal(target), HasSubstr("it contains notes.txt, which is not a result"));
  fs::remove(target / "notes.txt");
  write("results/summary.json", "edited");
  EXPECT_THAT(refusal(target),
              HasSubstr("it contains summary.json, which has changed since wearwell wrote it"));
  fs::remove(target / "summary.json");
  put_result("2");
  fs::remove(target / "summary.json");
  write("victim", "2");
  fs::create_symlink("../victim", target / "summary.json");
  EXPECT_THAT(refusal(target), HasSubstr("summary.json"));
  EXPECT_THAT(entries(target), ElementsAre("results.sha1", "summary.json"));
}

TEST_F(ResultFolderTest, KeepsWhatComesMeanwhile) {
  put_result("1");
  ResultFolder result(target);
  result.write("summary.json", "2");
  write("results/notes.txt", "precious");
  fs::create_directory(target / "figures");
  write("results/figures/a.png", "precious");
  result.commit();
  EXPECT_EQ(content(target / "summary.json"), "2");
  EXPECT_EQ(content(target / "notes.txt"), "precious");
  EXPECT_EQ(content(target / "figures" / "a.png"), "precious");
  EXPECT_THAT(entries(folder()), ElementsAre("results"));
}

TEST_F(ResultFolderTest, KeepsAResultThatIsEditedMeanwhile) {
  put_result("1");
  ResultFolder result(target);
  result.write("summary.json", "2");
  write("results/summary.json", "precious");
  EXPECT_THAT(message_of<InputError>([&] { result.commit(); }), HasSubstr("summary.json"));
  EXPECT_EQ(content(target / "summary.json"), "precious");
}

TEST_F(ResultFolderTest, OfTwoAtOnceTheLastIsThere) {
  ResultFolder one(target), other(target);
  one.write("summary.json", "1");
  other.write("summary.json", "2");
  one.commit();
  other.commit();
  EXPECT_EQ(content(target / "summary.json"), "2");
  EXPECT_THAT(entries(folder()), ElementsAre("results"));
}

TEST_F(ResultFolderTest, RefusesAParentThatCannotBeWritten) {
  write("file", "");
  EXPECT_THAT(refusal(folder() / "file" / "results"), HasSubstr("cannot write to"));
  EXPECT_THAT(refusal("/proc/results"), HasSubstr("cannot write to /proc"));
  // The parents that were made before the last one failed go again.
  EXPECT_THAT(refusal(folder() / "a" / std::string(300, 'b') / "results"), HasSubstr("too long"));
  EXPECT_THAT(entries(folder()), ElementsAre("file"));
}

TEST_F(ResultFolderTest, NameMayBeAsLongAsAFolderMay) {
  const fs::path longest = folder() / std::string(255, 'x');
  ResultFolder result(longest);
  result.write("summary.json", "{}");
  result.commit();
  EXPECT_TRUE(fs::exists(longest / "summary.json"));
}

TEST_F(ResultFolderTest, FailedCommitKeepsTheEarlierResult) {
  put_result("1");
  {
    ResultFolder result(target);
    fs::remove_all(staging());
    EXPECT_THROW(result.write("summary.json", "2"), InputError);
    EXPECT_THROW(result.commit(), InputError);
  }
  EXPECT_THAT(entries(folder()), ElementsAre("results"));
  EXPECT_EQ(content(target / "summary.json"), "1");
}

TEST_F(ResultFolderTest, RestoresWhatAKillLeftAside) {
  put_result("1");
  const fs::path area = folder() / ".wearwell.unfinished.abcdefghijkl";
  fs::create_directories(area / "old");
  fs::create_directories(area / "new" / "results");
  fs::rename(target, area / "old" / "results");
  write(".wearwell.unfinished.abcdefghijkl/journal",
        std::string("results\0=summary.json\0whole\0", 28));
  { ResultFolder result(target); }
  EXPECT_EQ(content(target / "summary.json"), "1");
  EXPECT_THAT(entries(folder()), ElementsAre("results"));
}

TEST_F(ResultFolderTest, ReplacesOneResultAndItsLine) {
  put_result("1");
  replace_result(target, "report.html", "page");
  replace_result(target, "report.html", "other page");
  replace_result(target, "report.html", "other page");
  EXPECT_EQ(content(target / "report.html"), "other page");
  EXPECT_EQ(run_command("cd '" + target.string() + "' && sha1sum -c results.sha1").out,
            "summary.json: OK\nreport.html: OK\n");
  put_result("2");
  EXPECT_THAT(entries(target), ElementsAre("results.sha1", "summary.json"));
  write("report.html", "alone");
  replace_result(folder(), "report.html", "page");
  EXPECT_FALSE(fs::exists(folder() / "results.sha1")) << "no folder of results";
}

TEST_F(ResultFolderTest, OneResultIsReplacedBesideWhatIsNotOurs) {
  {
    ResultFolder result(target);
    result.write("report.html", "page");
    result.write("summary.json", "1");
    result.commit();
  }
  write("results/notes.txt", "precious");
  write("results/summary.json", "edited");
  replace_result(target, "report.html", "other page");
  EXPECT_THAT(entries(target),
              ElementsAre("notes.txt", "report.html", "results.sha1", "summary.json"));
  EXPECT_EQ(content(target / "report.html"), "other page");
  EXPECT_EQ(content(target / "notes.txt"), "precious");
  EXPECT_EQ(content(target / "summary.json"), "edited");
  EXPECT_EQ(run_command("cd '" + target.string() + "' && sha1sum -c results.sha1").out,
            "report.html: OK\nsummary.json: FAILED\n");
  EXPECT_THAT(entries(folder()), ElementsAre("results"));
}

// The others are not written again: as many of them as there may be, they are linked.
TEST_F(ResultFolderTest, OneResultIsReplacedWithTheFolder) {
  put_result("1");
  const auto inode = [](const fs::path& path) {
    struct stat there = {};
    EXPECT_EQ(stat(path.c_str(), &there), 0);
    return there.st_ino;
  };
  const auto summary = inode(target / "summary.json"), folder_before = inode(target);
  replace_result(target, "report.html", "page");
  EXPECT_EQ(inode(target / "summary.json"), summary);
  EXPECT_NE(inode(target), folder_before) << "not in one step";
  EXPECT_THAT(entries(folder()), ElementsAre("results"));
  fs::remove(target / "report.html");
  fs::create_directory(target / "report.html");
  EXPECT_THAT(message_of<InputError>([&] { replace_result(target, "report.html", "page"); }),
              HasSubstr("report.html: Is a directory"));
}

}  // namespace
}  // namespace wearwell
