// Every command that writes, killed at each of its system calls that change the disk, with an I/O
// error at each of them, and on a disk that is full after ever more bytes: what was there before
// stays, or what is new is there whole.
#include <gmock/gmock.h>
#include <sys/mount.h>

#include <functional>
#include <optional>
#include <regex>
#include <set>

#include "support/disk_content.h"
#include "support/run_command.h"
#include "support/scratch.h"
#include "wearwell/base/lock_file.h"
#include "wearwell/base/sha1.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/models/clutch/clutch_model_file.h"
#include "wearwell/models/clutch/wear_model.h"

namespace wearwell {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::ContainsRegex;

using Tree = std::map<std::string, std::string>;

const std::string program = "'" WEARWELL_BINARY "' ";

/// When what a command leaves that met a fault is whole or as before.
enum class Whole { at_once, once_healed };

/// A command, run in a folder that holds what `prepare` puts there.
struct Writer {
  const char* name;
  std::string arguments;
  std::function<void(const fs::path& folder)> prepare;
  std::string target;  ///< what it writes, in that folder
  /// Tells a whole new target from `fresh`, that of a run without a fault.
  std::function<bool(const fs::path& target, const Tree& fresh)> is_whole;
  Whole after_a_fault = Whole::at_once;
};

void PrintTo(const Writer& writer, std::ostream* out) {
  *out << writer.name;
}

std::string names_that_differ(const Tree& one, const Tree& other) {
  std::set<std::string> names;
  for (const auto& [name, text] : one) {
    if (!other.contains(name) || other.at(name) != text) names.insert(name);
  }
  for (const auto& [name, text] : other) {
    if (!one.contains(name)) names.insert(name);
  }
  return testing::PrintToString(names);
}

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
  std::istringstream list(names["results.sha1"]);
  std::size_t listed = 0;
  for (std::string sha1, name; list >> sha1 && std::getline(list >> std::ws, name); ++listed) {
    std::istringstream text(names[name]);
    if (sha1_of(text) != sha1) return false;
  }
  return listed + 1 == names.size();
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

/// One fit, not one a stage: the disk sees the same.
void copy_joint(const fs::path& folder) {
  fs::copy(examples + "joint", folder / "joint", fs::copy_options::recursive);
  const std::string study = content(folder / "joint" / "study.toml");
  const std::string stages = std::regex_replace(study, std::regex("\\[update\\][^\\[]*"), "");
  if (stages == study) throw std::runtime_error("no stages to leave out");
  std::ofstream(folder / "joint" / "study.toml") << stages;
}

/// Results whose report is of an earlier version, as their list says.
void prepare_earlier_report(const fs::path& folder) {
  copy_joint(folder);
  run_or_throw(folder, "fit joint/study.toml -o out --quiet --method exact --chains 1 --draws 10");
  const fs::path out = folder / "out";
  std::string list = content(out / "results.sha1");
  const std::string now = sha1_of(content(out / "report.html"));
  std::ofstream(out / "report.html") << "an earlier report";
  list.replace(list.find(now), now.size(), sha1_of("an earlier report"));
  std::ofstream(out / "results.sha1") << list;
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
      {"update", "update out joint/joint_wear.csv -o more --quiet --no-report --threads 1",
       then(copy_joint, fit), "more", is_listed_whole},
      {"select", select, write_table, "out", is_listed_whole},
      {"select_again", select, then(write_table, select + " --keep 3"), "out", is_listed_whole},
      {"report", "report out", prepare_earlier_report, "out", is_equal},
      // Its folder holds more than results, and stays: two files are put into it, one by one.
      {"report_beside_notes", "report out",
       [](const fs::path& folder) {
         prepare_earlier_report(folder);
         std::ofstream(folder / "out" / "notes.txt") << "kept";
       },
       "out", is_equal, Whole::once_healed},
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

/// What changes the disk, or tells that it has.
constexpr const char* changing[] = {"mkdir",  "write",     "fsync", "flock",  "chmod", "fchmod",
                                    "rename", "renameat2", "link",  "unlink", "rmdir"};

/// The count-th call of its kind in one run.
struct Call {
  std::string kind;
  int count;
};

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
      return;
    }
    const Tree now = look(target);
    EXPECT_TRUE(is_new || now == old_)
        << "beside the target: " << testing::PrintToString(entries(folder))
        << "\nother than before: " << names_that_differ(now, old_)
        << "\nother than new: " << names_that_differ(now, fresh_);
  }

  /// The next to write here and there, whoever it is, by the way that all take.
  static void heal(const fs::path& folder) {
    const fs::path target = folder / GetParam().target;
    for (const fs::path& where : {folder, target}) {
      if (!fs::is_directory(where)) continue;
      write_file(where / "next.csv", "next");
      fs::remove(where / "next.csv");
    }
  }

  static void expect_nothing_hidden(const fs::path& folder) {
    for (const auto& [name, text] : tree(folder)) {
      const std::string last = fs::path(name).filename();
      EXPECT_FALSE(last.starts_with(".")) << name;
    }
  }

  /// Runs the command under strace with a fault at one call; false when it was not come to.
  bool run_with(const Call& at, const std::string& fault, CommandResult& run,
                fs::path& folder) const {
    folder = scene();
    const std::string log = traced(folder,
                                   "-e trace=" + at.kind + " -e inject=" + at.kind + ":" + fault +
                                       ":when=" + std::to_string(at.count),
                                   run);
    return log.find("INJECTED") != std::string::npos ||
           log.find("killed by SIGKILL") != std::string::npos;
  }

  /// Where a fault may tell something new: the calls that touch the scene, or standard output. Of
  /// those of one kind in one folder (or on one stream), the first, the middle and the last: between
  /// them nothing differs but the file that is next.
  std::vector<Call> calls() const {
    std::string kinds;
    for (const char* kind : changing) kinds += std::string(kinds.empty() ? "" : ",") + kind;
    CommandResult run;
    const fs::path folder = scene();
    std::istringstream log(traced(folder, "-y -e trace=" + kinds, run));
    EXPECT_LE(run.exit_code, 1) << run.err;
    std::map<std::string, int> counts;
    std::vector<std::string> places;
    std::map<std::string, std::vector<Call>> at;
    for (std::string line; std::getline(log, line);) {
      const std::string kind = line.substr(0, line.find('('));
      const Call call = {kind, ++counts[kind]};
      const std::optional<std::string> place = place_of(line, folder);
      if (!place) continue;
      if (!at.contains(kind + *place)) places.push_back(kind + *place);
      at[kind + *place].push_back(call);
    }
    std::vector<Call> chosen;
    for (const std::string& place : places) {
      const std::vector<Call>& all = at[place];
      for (const std::size_t i : std::set<std::size_t>{0, all.size() / 2, all.size() - 1})
        chosen.push_back(all[i]);
    }
    return chosen;
  }

  /// The folder of the file that a call names, without the random part; or the stream.
  static std::optional<std::string> place_of(const std::string& line, const fs::path& folder) {
    if (line.starts_with("write(1<")) return "standard output";
    const std::size_t begin = line.find(folder.string());
    if (begin == std::string::npos) return std::nullopt;
    return fs::path(line.substr(begin, line.find_first_of("\">", begin) - begin))
        .parent_path()
        .string();
  }

  /// The log of strace with these options.
  std::string traced(const fs::path& folder, const std::string& options, CommandResult& run) const {
    const fs::path log = root_ / "strace";
    run = run_command("cd '" + folder.string() + "' && exec strace -qq -o '" + log.string() + "' " +
                      options + " " + program + GetParam().arguments);
    return content(log);
  }

  fs::path root_;
  Tree old_, fresh_;
};

#define SKIP_WITHOUT_STRACE()                                     \
  if (run_command("strace -qq -o /dev/null true").exit_code != 0) \
  GTEST_SKIP() << "no strace here, or it may not trace (setup/install --tests installs it)"

TEST_P(Faults, KilledAtEachCall) {
  SKIP_WITHOUT_STRACE();
  const std::vector<Call> all = calls();
  EXPECT_GE(all.size(), 10u);
  for (const Call& call : all) {
    SCOPED_TRACE(testing::Message() << "killed at " << call.kind << " " << call.count);
    CommandResult run;
    fs::path folder;
    ASSERT_TRUE(run_with(call, "signal=KILL", run, folder)) << run.err;
    EXPECT_EQ(run.exit_code, 128 + SIGKILL);
    if (GetParam().after_a_fault == Whole::at_once) expect_whole_or_as_before(folder, false);
    heal(folder);
    expect_whole_or_as_before(folder, false);
    // A lock is taken over, and taken away, by the next who locks the same.
    if (GetParam().arguments == predict)
      const LockFile next(folder / GetParam().target, [] { FAIL() << "waits for the dead"; });
    expect_nothing_hidden(folder);
    ASSERT_FALSE(HasFailure());
  }
}

TEST_P(Faults, ErrorAtEachCall) {
  SKIP_WITHOUT_STRACE();
  const std::vector<Call> all = calls();
  EXPECT_GE(all.size(), 10u);
  for (const Call& call : all) {
    SCOPED_TRACE(testing::Message() << "EIO at " << call.kind << " " << call.count);
    CommandResult run;
    fs::path folder;
    ASSERT_TRUE(run_with(call, "error=EIO", run, folder)) << run.err;
    EXPECT_THAT(run.exit_code, AnyOf(0, 1, 3));
    if (run.exit_code == 3) {
      EXPECT_THAT(run.err, ContainsRegex("^wearwell: [^\n]*Input/output error[^\n]*\n$"));
    }
    if (GetParam().after_a_fault == Whole::once_healed) heal(folder);
    expect_whole_or_as_before(folder, run.exit_code <= 1);
    ASSERT_FALSE(HasFailure()) << run.err;
  }
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
