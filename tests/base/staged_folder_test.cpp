#include "wearwell/base/staged_folder.h"

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

using Tree = std::map<std::string, std::string>;

unsigned mode(const fs::path& path) {
  struct stat status;
  return stat(path.c_str(), &status) == 0 ? status.st_mode & 07777 : 0;
}

class StagedFolderTest : public ScratchTest {
 protected:
  const fs::path target = folder() / "out";

  static void put(const fs::path& where, const std::map<std::string, std::string>& files,
                  const std::vector<std::string>& replaced = {}) {
    StagedFolder staged(where, replaced);
    for (const auto& [name, text] : files) staged.write(name, text);
    staged.commit(replaced);
  }
};

TEST_F(StagedFolderTest, AppearsWholeWithTheFoldersAbove) {
  {
    StagedFolder staged(folder() / "a" / "b" / "out/");
    EXPECT_EQ(staged.target(), folder() / "a" / "b" / "out");
    staged.write("x", "1");
    EXPECT_FALSE(fs::exists(folder() / "a"));
    staged.commit({});
  }
  EXPECT_EQ(tree(folder()), (Tree{{"a/", ""}, {"a/b/", ""}, {"a/b/out/", ""}, {"a/b/out/x", "1"}}));
}

TEST_F(StagedFolderTest, GoesWithoutCommit) {
  {
    StagedFolder staged(folder() / "a" / "out");
    staged.write("x", "1");
  }
  EXPECT_THAT(entries(folder()), IsEmpty());
}

TEST_F(StagedFolderTest, TakesFoldersAboveThatAppearMeanwhile) {
  StagedFolder staged(folder() / "a" / "b" / "out");
  staged.write("x", "1");
  fs::create_directory(folder() / "a");
  write("a/others", "precious");
  staged.commit({});
  EXPECT_EQ(tree(folder()), (Tree{{"a/", ""},
                                  {"a/others", "precious"},
                                  {"a/b/", ""},
                                  {"a/b/out/", ""},
                                  {"a/b/out/x", "1"}}));
}

TEST_F(StagedFolderTest, KeepsWhatItMayNotReplace) {
  put(target, {{"x", "1"}, {"gone", "1"}});
  StagedFolder staged(target, {"x", "gone"});
  staged.write("x", "2");
  write("out/notes.txt", "precious");
  fs::create_directory(target / "figures");
  write("out/figures/x", "precious");
  staged.commit({"x", "gone"});
  EXPECT_EQ(tree(folder()), (Tree{{"out/", ""},
                                  {"out/x", "2"},
                                  {"out/notes.txt", "precious"},
                                  {"out/figures/", ""},
                                  {"out/figures/x", "precious"}}));
}

TEST_F(StagedFolderTest, HasFoldersInside) {
  put(target, {{"x", "1"}, {"tables/a", "1"}, {"tables/gone", "1"}});
  EXPECT_THAT(files_in(target), ElementsAre("tables/a", "tables/gone", "x"));
  put(target, {{"x", "2"}, {"tables/a", "2"}, {"tables/b", "2"}}, files_in(target));
  EXPECT_EQ(tree(target),
            (Tree{{"x", "2"}, {"tables/", ""}, {"tables/a", "2"}, {"tables/b", "2"}}));
  put(target, {{"x", "3"}}, files_in(target));
  EXPECT_EQ(tree(target), (Tree{{"x", "3"}}));
}

// The same where the target has to stay, and is filled file by file.
TEST_F(StagedFolderTest, FillsFoldersInside) {
  put(target, {{"tables/a", "1"}, {"tables/gone", "1"}, {"old/b", "1"}});
  const std::vector<std::string> own = files_in(target);
  write("out/tables/notes.txt", "precious");
  put(target, {{"x", "2"}, {"tables/a", "2"}, {"new/c", "2"}}, own);
  EXPECT_EQ(tree(target), (Tree{{"x", "2"},
                                {"tables/", ""},
                                {"tables/a", "2"},
                                {"tables/notes.txt", "precious"},
                                {"new/", ""},
                                {"new/c", "2"}}));
}

TEST_F(StagedFolderTest, KeepsWhatOthersPutIntoAFolderInside) {
  put(target, {{"tables/a", "1"}});
  for (const char* name : {"tables/a", "x"}) {  // with and without that folder among the new
    StagedFolder staged(target, {"tables/a"});
    staged.write(name, "2");
    write(std::string("out/tables/notes-") + name[0], "precious");
    staged.commit({"tables/a"});
  }
  EXPECT_EQ(tree(target), (Tree{{"x", "2"},
                                {"tables/", ""},
                                {"tables/notes-t", "precious"},
                                {"tables/notes-x", "precious"}}));
}

TEST_F(StagedFolderTest, AFileWhereAFolderIsNeededIsNotReplaced) {
  put(target, {{"x", "1"}});
  StagedFolder staged(target, {"x"});
  staged.write("x", "2");
  staged.write("tables/a", "2");
  write("out/tables", "precious");
  EXPECT_THAT(message_of<InputError>([&] { staged.commit({"x"}); }),
              HasSubstr("out/tables: it is not from an earlier run"));
  EXPECT_EQ(tree(target), (Tree{{"x", "1"}, {"tables", "precious"}}));
}

TEST_F(StagedFolderTest, KeepsAFolderThatAppearsMeanwhile) {
  StagedFolder staged(target);
  staged.write("x", "1");
  fs::create_directory(target);
  write("out/theirs", "precious");
  staged.commit({});
  EXPECT_EQ(tree(target), (Tree{{"x", "1"}, {"theirs", "precious"}}));
}

TEST_F(StagedFolderTest, RefusesAFileOfOthersWithItsName) {
  {
    StagedFolder staged(target);
    staged.write("x", "1");
    fs::create_directory(target);
    write("out/x", "precious");
    EXPECT_THAT(message_of<InputError>([&] { staged.commit({}); }),
                HasSubstr("out/x: it is not from an earlier run"));
  }
  EXPECT_EQ(tree(folder()), (Tree{{"out/", ""}, {"out/x", "precious"}}));
}

TEST_F(StagedFolderTest, WritesToWhatALinkPointsTo) {
  fs::create_directory(folder() / "real");
  fs::create_directory_symlink("real", folder() / "link");
  fs::create_directory_symlink("none", folder() / "dangling");
  put(folder() / "link", {{"x", "1"}});
  put(folder() / "dangling", {{"x", "2"}});
  EXPECT_TRUE(fs::is_symlink(folder() / "link"));
  EXPECT_TRUE(fs::is_symlink(folder() / "dangling"));
  EXPECT_EQ(tree(folder() / "real"), (Tree{{"x", "1"}}));
  EXPECT_EQ(tree(folder() / "none"), (Tree{{"x", "2"}}));
}

TEST_F(StagedFolderTest, HonoursUmaskAndKeepsPermissions) {
  const mode_t before = umask(0);
  put(target, {{"x", "1"}});
  umask(027);
  put(folder() / "closed", {{"x", "1"}});
  put(target, {{"x", "2"}}, {"x"});
  umask(before);
  EXPECT_EQ(mode(target), 0777u);
  EXPECT_EQ(mode(folder() / "closed"), 0750u);
  EXPECT_EQ(mode(folder() / "closed" / "x"), 0640u);
}

// The working folder must not be exchanged under the feet of the shell that stands in it.
TEST_F(StagedFolderTest, FillsTheWorkingFolder) {
  fs::create_directory(target);
  const fs::path before = fs::current_path();
  fs::current_path(target);
  struct stat was, is;
  ASSERT_EQ(stat(".", &was), 0);
  put(".", {{"x", "1"}, {"gone", "1"}});
  put(".", {{"x", "2"}}, {"x", "gone"});
  fs::current_path(before);
  ASSERT_EQ(stat(target.c_str(), &is), 0);
  EXPECT_EQ(was.st_ino, is.st_ino);
  EXPECT_EQ(tree(target), (Tree{{"x", "2"}}));
}

TEST_F(StagedFolderTest, FillsAFolderThatHoldsMore) {
  fs::create_directory(target);
  write("out/x", "0");
  write("out/theirs", "precious");
  put(target, {{"x", "1"}, {"y", "1"}}, {"x", "y"});
  EXPECT_EQ(tree(target), (Tree{{"x", "1"}, {"y", "1"}, {"theirs", "precious"}}));
}

std::string journal(const std::string& within, const std::vector<std::string>& files) {
  std::string text = within + '\0';
  for (const std::string& file : files) text += file + '\0';
  return text + "whole" + '\0';
}

// What a kill leaves, stage by stage, and what the next start makes of it.
class Killed : public StagedFolderTest {
 protected:
  Killed() { fs::create_directories(area / "new"); }
  void put(const std::string& name, const std::string& text) const {
    fs::create_directories((folder() / name).parent_path());
    write(name, text);
  }
  Tree healed() const {
    recover_folder(folder());
    return tree(folder());
  }
  const fs::path area = folder() / ".wearwell.unfinished.abcdefghijkl";
  const std::string in_area = ".wearwell.unfinished.abcdefghijkl/";
};

TEST_F(Killed, WhileWriting) {
  put("out/x", "old");
  put(in_area + "new/out/x", "half");
  EXPECT_EQ(healed(), (Tree{{"out/", ""}, {"out/x", "old"}}));
}

TEST_F(Killed, WhileWritingTheJournal) {
  put(in_area + "new/out/x", "new");
  put(in_area + "journal", journal("out", {"+x"}).substr(0, 8));
  EXPECT_EQ(healed(), Tree{});
}

TEST_F(Killed, BeforeTheExchange) {
  put("out/x", "old");
  put(in_area + "new/out/x", "new");
  put(in_area + "journal", journal("out", {"=x"}));
  EXPECT_EQ(healed(), (Tree{{"out/", ""}, {"out/x", "old"}}));
}

TEST_F(Killed, AfterTheExchange) {
  put("out/x", "new");
  put(in_area + "new/out/x", "old");
  put(in_area + "new/out/gone", "old");
  put(in_area + "new/out/notes", "precious");
  put(in_area + "journal", journal("out", {"=x", "-gone"}));
  EXPECT_EQ(healed(), (Tree{{"out/", ""}, {"out/x", "new"}, {"out/notes", "precious"}}));
}

TEST_F(Killed, AfterTheExchangeKeepsBothOfOneName) {
  put("out/notes", "later");
  put(in_area + "new/out/notes", "precious");
  put(in_area + "journal", journal("out", {"=x"}));
  EXPECT_EQ(healed(), (Tree{{"out/", ""}, {"out/notes", "later"}, {"out/notes.kept", "precious"}}));
}

TEST_F(Killed, BetweenTheTwoRenamesWhereThereIsNoExchange) {
  put(in_area + "old/out/x", "old");
  put(in_area + "old/out/notes", "precious");
  put(in_area + "new/out/x", "new");
  put(in_area + "journal", journal("out", {"=x"}));
  EXPECT_EQ(healed(), (Tree{{"out/", ""}, {"out/x", "old"}, {"out/notes", "precious"}}));
}

TEST_F(Killed, AfterTheTwoRenames) {
  put("out/x", "new");
  put(in_area + "old/out/x", "old");
  put(in_area + "old/out/notes", "precious");
  put(in_area + "journal", journal("out", {"=x"}));
  EXPECT_EQ(healed(), (Tree{{"out/", ""}, {"out/x", "new"}, {"out/notes", "precious"}}));
}

TEST_F(Killed, WhileFilling) {
  put("x", "new");
  put("y", "old");
  put("gone", "old");
  put(in_area + "fill/y", "new");
  put(in_area + "fill/z", "new");
  put(in_area + "journal", journal("", {"-gone", "+x", "=y", "+z"}));
  fs::remove(area / "new");
  EXPECT_EQ(healed(), (Tree{{"x", "new"}, {"y", "new"}, {"z", "new"}}));
}

TEST_F(Killed, BeforeFilling) {
  put("y", "old");
  put(in_area + "new/y", "new");
  put(in_area + "journal", journal("", {"=y"}));
  EXPECT_EQ(healed(), (Tree{{"y", "old"}}));
}

TEST_F(Killed, WhatHoldsOtherThingsIsNotOurs) {
  put(in_area + "diary", "precious");
  EXPECT_EQ(healed().at(in_area + "diary"), "precious");
}

TEST_F(Killed, IsLeftAloneWhileItsOwnerLives) {
  fs::remove_all(area);
  StagedFolder staged(target);
  staged.write("x", "1");
  recover_folder(folder());
  staged.commit({});
  EXPECT_EQ(tree(folder()), (Tree{{"out/", ""}, {"out/x", "1"}}));
}

}  // namespace
}  // namespace wearwell
