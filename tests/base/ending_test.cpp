// What is left when a program that is writing ends by a signal, and who gets a lock.
#include "wearwell/base/ending.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <string>
#include <thread>

#include "support/disk_content.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/base/lock_file.h"
#include "wearwell/base/scratch_folder.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/base/staged_folder.h"

namespace wearwell {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class EndingTest : public ScratchTest {
 protected:
  /// Runs `work` in a process of its own and sends it `signal` when it says so on the pipe.
  template <class Work>
  static int end(int signal, const Work& work) {
    int ready[2];
    if (pipe(ready) != 0) throw std::runtime_error("no pipe");
    const pid_t child = fork();
    if (child == 0) {
      remove_half_written_on_signals();
      work([&] { (void)!::write(ready[1], "x", 1); });
      _exit(0);
    }
    close(ready[1]);
    char byte;
    (void)!::read(ready[0], &byte, 1);
    kill(child, signal);
    int status = 0;
    waitpid(child, &status, 0);
    close(ready[0]);
    return WIFSIGNALED(status) ? WTERMSIG(status) : -WEXITSTATUS(status);
  }
};

// More files than one look at a folder lists, and folders in it.
void fill_scratch(const fs::path& folder) {
  fs::create_directories(folder / "spill" / "deep");
  for (int i = 0; i < 300; ++i)
    std::ofstream(folder / "spill" / ("a rather long name of a file " + std::to_string(i))) << i;
  std::ofstream(folder / "spill" / "deep" / "block") << "block";
  std::ofstream(folder / "sums") << "sums";
}

TEST_F(EndingTest, AScratchFolderGoesWithAllThatIsInIt) {
  {
    const ScratchFolder scratch(folder());
    EXPECT_EQ(scratch.path().parent_path().parent_path(), folder());
    fill_scratch(scratch.path());
  }
  EXPECT_THAT(files_in(folder()), IsEmpty());
  EXPECT_EQ(end(SIGINT,
                [&](const auto& ready) {
                  const ScratchFolder scratch(folder());
                  fill_scratch(scratch.path());
                  ready();
                  pause();
                }),
            SIGINT);
  EXPECT_THAT(files_in(folder()), IsEmpty());
}

TEST_F(EndingTest, TheNextStartRemovesAScratchFolderThatAKillLeft) {
  EXPECT_EQ(end(SIGKILL,
                [&](const auto& ready) {
                  const ScratchFolder scratch(folder());
                  fill_scratch(scratch.path());
                  ready();
                  pause();
                }),
            SIGKILL);
  EXPECT_FALSE(files_in(folder()).empty());
  const ScratchFolder next(folder());
  EXPECT_EQ(files_in(folder()).size(), 1U);
}

TEST_F(EndingTest, LeavesNothingBehind) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EQ(end(signal,
                  [&](const auto& ready) {
                    StagedFolder results(folder() / "a" / "out");
                    results.write("x", "1");
                    StagedFile state(folder() / "state");
                    state.write("1");
                    const LockFile lock(folder() / "state", [] {});
                    ready();
                    pause();
                  }),
              signal);
    EXPECT_THAT(entries(folder()), IsEmpty()) << signal;
  }
}

// Whenever the signal comes, nothing half done stays: threads write without a pause meanwhile.
TEST_F(EndingTest, AtAnyMoment) {
  for (int round = 0; round < 8; ++round) {
    EXPECT_EQ(end(SIGTERM,
                  [&](const auto& ready) {
                    std::atomic<int> started = 0;
                    const auto write_on = [&](int i) {
                      for (int n = 0;; ++n) {
                        const std::string name = std::to_string(i);
                        StagedFolder results(folder() / name, {"x"});
                        results.write("x", "whole");
                        if (n % 3) results.commit({"x"});
                        if (n == 1 && ++started == 3) ready();
                      }
                    };
                    std::thread one(write_on, 1), two(write_on, 2);
                    write_on(3);
                  }),
              SIGTERM);
    for (const std::string& name : entries(folder())) {
      EXPECT_FALSE(is_staging_name(name)) << round;
      EXPECT_THAT(entries(folder() / name), ElementsAre("x")) << round;
      EXPECT_EQ(content(folder() / name / "x"), "whole") << round;
    }
  }
}

TEST_F(EndingTest, IgnoredSignalsStayIgnored) {
  EXPECT_EQ(end(SIGUSR1,
                [&](const auto& ready) {
                  std::signal(SIGHUP, SIG_IGN);
                  remove_half_written_on_signals();
                  struct sigaction action = {};
                  sigaction(SIGHUP, nullptr, &action);
                  if (action.sa_handler != SIG_IGN) _exit(1);
                  ready();
                  pause();
                }),
            SIGUSR1);
}

TEST_F(EndingTest, OneLockAtATime) {
  const fs::path file = folder() / "count";
  write("count", "0");
  constexpr int processes = 4, rounds = 12;
  std::vector<pid_t> children;
  for (int p = 0; p < processes; ++p) {
    children.push_back(fork());
    if (children.back() != 0) continue;
    for (int i = 0; i < rounds; ++i) {
      const LockFile lock(file, [] {});
      write_file(file, std::to_string(std::stoi(content(file)) + 1));
    }
    _exit(0);
  }
  for (const pid_t child : children) {
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(content(file), std::to_string(processes * rounds));
  EXPECT_THAT(entries(folder()), ElementsAre("count"));
}

TEST_F(EndingTest, SaysThatItWaits) {
  auto first = std::make_unique<LockFile>(folder() / "state", [] { FAIL(); });
  std::thread second([&] { LockFile lock(folder() / "state", [&] { first.reset(); }); });
  second.join();
  EXPECT_THAT(entries(folder()), IsEmpty());
  write(".state.lock", "a file of somebody");
  EXPECT_THAT(message_of<InputError>([&] { LockFile(folder() / "state", [] {}); }),
              HasSubstr("is not a lock file"));
  EXPECT_THAT(entries(folder()), ElementsAre(".state.lock"));
}

}  // namespace
}  // namespace wearwell
