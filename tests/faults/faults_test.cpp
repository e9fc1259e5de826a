// Every command that writes, killed at each of its system calls that change the disk, with an I/O
// error at each of them, and on a disk that is full after ever more bytes: what was there before
// stays, or what is new is there whole.
#include <gmock/gmock.h>
#include <sys/mount.h>

#include <functional>

#include "support/disk_content.h"
#include "support/run_command.h"
#include "support/scratch.h"
#include "wearwell/clutch/wear_model.h"
#include "wearwell/study/clutch_model_file.h"

namespace wearwell {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::ContainsRegex;

using Tree = std::map<std::string, std::string>;

const std::string program = "'" WEARWELL_BINARY "' ";

/// A command, run in a folder that holds what `prepare` puts there.
struct Writer {
  const char* name;
  std::string arguments;
  std::function<void(const fs::path& folder)> prepare;
  std::string target;  ///< what it writes, in that folder
  /// Tells a whole new target from `fresh`, that of a run without a fault.
  std::function<bool(const fs::path& target, const Tree& fresh)> is_whole;
};

bool is_equal(const fs::path& target, const Tree& fresh) {
  return fs::is_directory(target) ? tree(target) == fresh : Tree{{"", content(target)}} == fresh;
}

Tree look(const fs::path& target) {
  if (!fs::exists(target)) return {};
  return fs::is_directory(target) ? tree(target) : Tree{{"", content(target)}};
}

/// Results hold the time they took; the list says whether they belong together.
bool is_listed_whole(const fs::path& target, const Tree& fresh) {
  Tree names = tree(target);
  if (names.size() != fresh.size()) return false;
  for (const auto& [name, text] : fresh) {
    if (!names.contains(name)) return false;
  }
  return run_command("cd '" + target.string() + "' && sha1sum --quiet -c results.sha1").exit_code ==
         0;
}

void run_or_throw(const fs::path& folder, const std::string& arguments) {
  const CommandResult run = run_command("cd '" + folder.string() + "' && " + program + arguments);
  if (run.exit_code > 1) throw std::runtime_error(arguments + ": " + run.err);
}

const std::string examples = PROJECT_SOURCE_DIR "/examples/";

const std::string fit =
    "fit joint/study.toml -o out --quiet --no-report --method exact --chains 1 --draws 10 "
    "--threads "
    "1";
const std::string select =
    "select table.csv --response y --inputs a,b --degree 2 -o out --quiet --no-report --threads 1";
const std::string predict =
    "clutch predict model.json cycles.csv --state state.json --trace trace.csv --threads 1";
const std::string simulate =
    "clutch simulate --design design.csv --truth truth.toml --traces 1 -o campaign";

void copy_joint(const fs::path& folder) {
  fs::copy(examples + "joint", folder / "joint", fs::copy_options::recursive);
}

void write_table(const fs::path& folder) {
  std::ofstream table(folder / "table.csv");
  table << "a,b,y\n";
  for (int i = 0; i < 30; ++i) table << i % 7 << ',' << i % 4 << ',' << i % 5 + i % 7 << '\n';
}

void write_model_and_cycles(const fs::path& folder) {
  clutch::WearModel model;
  model.title = "faults";
  model.terms.push_back({"1", 0, 0, 0, 0, 1, 2e-14});
  model.covariance = Eigen::MatrixXd::Constant(1, 1, 1e-32);
  model.run_in = {0.4, 4, 78e6, 6e6};
  model.run_in_covariance.setZero();
  model.scatter = {clutch::ScatterKind::linear, {1e-14, 1}};
  model.lowest = {50, 10, 50, 1};
  model.highest = {400, 100, 300, 4};
  model.worn_out = 1e-5;
  std::ofstream(folder / "model.json") << clutch::to_json(model).dump(1);
  std::ofstream(folder / "cycles.csv") << "plate,cycle,slip_speed [rpm],torque [N m],temperature "
                                          "[degC],closing_time [s],energy [J]\n"
                                          "1,1,1700,50,170,2,9000\n1,2,1700,50,170,2,9000\n";
}

void write_truth(const fs::path& folder) {
  std::string truth = content(examples + "clutch/truth.toml");
  const auto change = [&](const std::string& from, const std::string& to) {
    truth.replace(truth.find(from), from.size(), to);
  };
  change("weighings = [40, 100, 200, 400, 800, 1500, 2500, 4000, 6000, 8000]", "weighings = [40]");
  change("run_out_cycles = 1500", "run_out_cycles = 20");
  change("least_cycles = 750", "least_cycles = 10");
  change("\"0.3 g\"", "\"0 g\"");
  std::ofstream(folder / "truth.toml") << truth;
  fs::copy(examples + "clutch/design.csv", folder / "design.csv");
}

// Twice: with nothing there, and over an earlier run.
const std::vector<Writer>& writers() {
  static const auto then = [](auto prepare, const std::string& arguments) {
    return [=](const fs::path& folder) {
      prepare(folder);
      run_or_throw(folder, arguments);
    };
  };
  static const std::vector<Writer> all = {
      {"fit", fit, copy_joint, "out", is_listed_whole},
      {"fit_again", fit, then(copy_joint, fit + " --seed 2"), "out", is_listed_whole},
      {"select", select, write_table, "out", is_listed_whole},
      {"select_again", select, then(write_table, select + " --keep 3"), "out", is_listed_whole},
      {"report", "report out",
       then(copy_joint, "fit joint/study.toml -o out --quiet --chains 1 --draws 10"), "out",
       is_equal},
      {"predict", predict, write_model_and_cycles, "state.json", is_equal},
      {"predict_again", predict,
       [](const fs::path& folder) {
         write_model_and_cycles(folder);
         run_or_throw(folder, predict);
         std::ofstream(folder / "cycles.csv")
             << "plate,cycle,slip_speed [rpm],torque [N m],temperature [degC],closing_time [s],"
                "energy [J]\n1,3,1700,50,170,2,9000\n";
       },
       "state.json", is_equal},
      {"new", "new joint out", [](const fs::path&) {}, "out", is_equal},
      {"new_in_empty", "new joint out",
       [](const fs::path& folder) { fs::create_directory(folder / "out"); }, "out", is_equal},
      {"simulate", simulate, write_truth, "campaign", is_equal},
      {"simulate_again", simulate, then(write_truth, simulate + " --seed 7"), "campaign",
       is_equal}};
  return all;
}

class Faults : public testing::TestWithParam<Writer> {
 protected:
  Faults() {
    std::string pattern = (fs::temp_directory_path() / "wearwell-faults-XXXXXX").string();
    root_ = mkdtemp(pattern.data());
    fs::create_directories(root_ / "before");
    GetParam().prepare(root_ / "before");
    fs::copy(root_ / "before", root_ / "without", fs::copy_options::recursive);
    run_or_throw(root_ / "without", GetParam().arguments);
    old_ = look(root_ / "before" / GetParam().target);
    fresh_ = look(root_ / "without" / GetParam().target);
  }
  ~Faults() override {
    std::error_code ignored;
    fs::remove_all(root_, ignored);
  }

  /// A new copy of what was there before.
  fs::path scene() const {
    const fs::path folder = root_ / "scene";
    fs::remove_all(folder);
    fs::copy(root_ / "before", folder, fs::copy_options::recursive);
    return folder;
  }

  void expect_whole_or_as_before(const fs::path& folder, bool must_be_new) const {
    const fs::path target = folder / GetParam().target;
    const bool is_new = fs::exists(target) && GetParam().is_whole(target, fresh_);
    if (must_be_new) {
      EXPECT_TRUE(is_new);
    } else {
      EXPECT_TRUE(is_new || look(target) == old_)
          << testing::PrintToString(entries(folder)) << testing::PrintToString(look(target));
    }
  }

  static void expect_nothing_hidden(const fs::path& folder) {
    for (const auto& [name, text] : tree(folder)) {
      const std::string last = fs::path(name).filename();
      EXPECT_FALSE(last.starts_with(".")) << name;
    }
  }

  /// Runs the command under strace with a fault at the n-th call of one kind; false when there are
  /// fewer.
  bool run_with(const std::string& call, const std::string& fault, int n, CommandResult& run,
                fs::path& folder) const {
    folder = scene();
    const fs::path log = root_ / "strace";
    run = run_command("cd '" + folder.string() + "' && exec strace -qq -o '" + log.string() +
                      "' -e trace=" + call + " -e inject=" + call + ":" + fault +
                      ":when=" + std::to_string(n) + " " + program + GetParam().arguments);
    const std::string text = content(log);
    return text.find("INJECTED") != std::string::npos ||
           text.find("killed by SIGKILL") != std::string::npos;
  }

  fs::path root_;
  Tree old_, fresh_;
};

/// What changes the disk, or tells that it has.
constexpr const char* changing[] = {"mkdir",  "write",  "fsync",     "flock",  "chmod",
                                    "fchmod", "rename", "renameat2", "unlink", "rmdir"};
constexpr int most_calls = 200;

#define SKIP_WITHOUT_STRACE()                                     \
  if (run_command("strace -qq -o /dev/null true").exit_code != 0) \
  GTEST_SKIP() << "no strace here, or it may not trace (setup/install --tests installs it)"

TEST_P(Faults, KilledAtEachCall) {
  SKIP_WITHOUT_STRACE();
  int kills = 0;
  for (const char* call : changing) {
    for (int n = 1; n <= most_calls; ++n) {
      SCOPED_TRACE(testing::Message() << "killed at " << call << " " << n);
      CommandResult run;
      fs::path folder;
      if (!run_with(call, "signal=KILL", n, run, folder)) {
        EXPECT_LE(run.exit_code, 1) << run.err;
        break;
      }
      ++kills;
      EXPECT_EQ(run.exit_code, 128 + SIGKILL);
      expect_whole_or_as_before(folder, false);
      // The next start that writes here and there, of another command.
      const CommandResult next = run_command("cd '" + folder.string() + "' && " + program +
                                             "bearing chart --output next.csv");
      ASSERT_EQ(next.exit_code, 0) << next.err;
      if (fs::is_directory(folder / GetParam().target))
        run_command("cd '" + folder.string() + "' && " + program + "bearing chart --output " +
                    GetParam().target + "/next.csv && rm " + GetParam().target + "/next.csv");
      expect_whole_or_as_before(folder, false);
      // A lock is taken over, and taken away, by the next who locks the same.
      if (GetParam().arguments == predict)
        run_command("cd '" + folder.string() + "' && " + program + predict);
      expect_nothing_hidden(folder);
      ASSERT_FALSE(HasFailure());
    }
  }
  EXPECT_GE(kills, 10);
}

TEST_P(Faults, ErrorAtEachCall) {
  SKIP_WITHOUT_STRACE();
  int errors = 0;
  for (const char* call : changing) {
    for (int n = 1; n <= most_calls; ++n) {
      SCOPED_TRACE(testing::Message() << "EIO at " << call << " " << n);
      CommandResult run;
      fs::path folder;
      if (!run_with(call, "error=EIO", n, run, folder)) break;
      ++errors;
      EXPECT_THAT(run.exit_code, AnyOf(0, 1, 3));
      if (run.exit_code == 3) {
        EXPECT_THAT(run.err, ContainsRegex("^wearwell: [^\n]*Input/output error[^\n]*\n$"));
      }
      expect_whole_or_as_before(folder, run.exit_code <= 1);
      ASSERT_FALSE(HasFailure()) << run.err;
    }
  }
  EXPECT_GE(errors, 10);
}

TEST_P(Faults, FullDisk) {
  const fs::path disk = root_ / "disk";
  fs::create_directory(disk);
  if (mount("wearwell-faults", disk.c_str(), "tmpfs", 0, "size=4096k") != 0)
    GTEST_SKIP() << "only root may mount a small disk";
  int full = 0;
  // Room for less and less, by a file that fills the disk but for so many pages.
  for (const int pages : {0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 64, 128, 256}) {
    SCOPED_TRACE(testing::Message() << pages << " free pages of 4 kB");
    run_command("rm -rf '" + disk.string() + "'/*; cp -a '" + (root_ / "before").string() +
                "'/. '" + disk.string() + "'");
    run_command("cd '" + disk.string() + "'; cat /dev/zero > fill 2>/dev/null; truncate -s -" +
                std::to_string(4096 * pages) + " fill");
    const CommandResult run =
        run_command("cd '" + disk.string() + "' && " + program + GetParam().arguments);
    EXPECT_THAT(run.exit_code, AnyOf(0, 1, 3)) << run.err;
    if (run.exit_code == 3) {
      ++full;
      EXPECT_THAT(run.err, ContainsRegex("^wearwell: [^\n]*is the disk full[^\n]*\n$"));
    }
    expect_whole_or_as_before(disk, run.exit_code <= 1);
    expect_nothing_hidden(disk);
    if (HasFailure()) break;
  }
  EXPECT_GE(full, 1);
  umount(disk.c_str());
}

INSTANTIATE_TEST_SUITE_P(, Faults, testing::ValuesIn(writers()),
                         [](const auto& each) { return std::string(each.param.name); });

// What is printed must arrive, too.
TEST(FullOutput, IsSaid) {
  const fs::path table = fs::temp_directory_path() / "wearwell-full-output";
  fs::create_directories(table);
  write_table(table);
  for (const std::string& arguments :
       {std::string("clutch design"), std::string("bearing chart"),
        "select '" + (table / "table.csv").string() + "' --response y --inputs a,b --json",
        "check " + examples + "joint/study.toml", std::string("--help")}) {
    const CommandResult run = run_command(program + arguments + " > /dev/full");
    EXPECT_EQ(run.exit_code, 3) << arguments;
    EXPECT_EQ(run.err, "wearwell: cannot write to standard output: No space left on device\n")
        << arguments;
    const CommandResult closed = run_command(program + arguments + " >&-");
    EXPECT_EQ(closed.exit_code, 3) << arguments;
    EXPECT_EQ(closed.err, "wearwell: cannot write to standard output: Bad file descriptor\n")
        << arguments;
  }
  fs::remove_all(table);
}

}  // namespace
}  // namespace wearwell
