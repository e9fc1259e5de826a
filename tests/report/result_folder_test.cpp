#include "wearwell/report/result_folder.h"

#include <gmock/gmock.h>

#include <sstream>

#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

std::string content(const fs::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::vector<std::string> entries(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

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
  // The folder beside the target into which files go before the commit.
  fs::path staging() const {
    for (const std::string& name : entries(folder())) {
      if (name.front() == '.') return folder() / name;
    }
    throw std::logic_error("no staging folder");
  }
};

TEST_F(ResultFolderTest, AppearsAtCommit) {
  const auto study = write("my.toml", "title = 1\n");
  ResultFolder result(target);
  result.write("summary.json", "{}");
  result.copy(study, "study.toml");
  EXPECT_FALSE(fs::exists(target));
  result.commit();
  EXPECT_THAT(entries(target), UnorderedElementsAre("summary.json", "study.toml"));
  EXPECT_EQ(content(target / "summary.json"), "{}");
  EXPECT_EQ(content(target / "study.toml"), "title = 1\n");
  EXPECT_THAT(entries(folder()), UnorderedElementsAre("my.toml", "results"));
  EXPECT_EQ(result.path(), target);
}

TEST_F(ResultFolderTest, LeavesNothingWithoutCommit) {
  {
    ResultFolder result(folder() / "a" / "b" / "results");
    result.write("summary.json", "{}");
  }
  EXPECT_THAT(entries(folder()), IsEmpty());
}

TEST_F(ResultFolderTest, LeavesAloneWhatOthersPutIntoAParent) {
  {
    ResultFolder result(folder() / "a" / "b" / "results");
    std::ofstream(folder() / "a" / "others.txt") << "precious";
  }
  EXPECT_THAT(entries(folder()), ElementsAre("a"));
  EXPECT_THAT(entries(folder() / "a"), ElementsAre("others.txt"));
}

TEST_F(ResultFolderTest, MakesParentsAndReadsTrailingSlash) {
  ResultFolder result(folder() / "a" / "b" / "results/");
  result.write("summary.json", "{}");
  result.commit();
  EXPECT_THAT(entries(folder() / "a" / "b" / "results"), ElementsAre("summary.json"));
}

TEST_F(ResultFolderTest, ReplacesAnEarlierResultWhole) {
  {
    ResultFolder first(target);
    first.write("summary.json", "1");
    first.write("draws_3.csv", "x");
    first.commit();
  }
  put_result("2");
  EXPECT_THAT(entries(target), ElementsAre("summary.json"));
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
  write("project/study.txt", "");
  EXPECT_THAT(refusal(folder() / "project"), HasSubstr("it holds study.txt, which is no result"));
  fs::create_directory(folder() / "study");
  write("study/study.toml", "");
  EXPECT_THAT(refusal(folder() / "study"), HasSubstr("holds no summary.json"));
  put_result("1");
  write("results/notes.txt", "precious");
  EXPECT_THAT(refusal(target), HasSubstr("it holds notes.txt"));
  EXPECT_THAT(entries(target), UnorderedElementsAre("summary.json", "notes.txt"));
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

TEST_F(ResultFolderTest, FullDisk) {
  put_result("1");
  {
    ResultFolder result(target);
    fs::create_symlink("/dev/full", staging() / "summary.json");
    EXPECT_THAT(message_of<MachineError>([&] { result.write("summary.json", "2"); }),
                HasSubstr("is the disk full?"));
  }
  EXPECT_THAT(entries(folder()), ElementsAre("results"));
  EXPECT_EQ(content(target / "summary.json"), "1");
}

TEST_F(ResultFolderTest, FailedCommitKeepsTheEarlierResult) {
  put_result("1");
  {
    ResultFolder result(target);
    fs::remove_all(staging());
    EXPECT_THROW(result.write("summary.json", "2"), MachineError);
    EXPECT_THROW(result.commit(), MachineError);
  }
  EXPECT_THAT(entries(folder()), ElementsAre("results"));
  EXPECT_EQ(content(target / "summary.json"), "1");
}

TEST_F(ResultFolderTest, OnlyFilesOfAResult) {
  ResultFolder result(target);
  EXPECT_THROW(result.write("notes.txt", ""), std::logic_error);
  EXPECT_THROW(result.copy(folder() / "absent.toml", "study.toml"), MachineError);
}

}  // namespace
}  // namespace wearwell
