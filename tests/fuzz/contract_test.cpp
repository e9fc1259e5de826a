// Wrong studies, wrong data and wrong options, made by mutating the examples, judged by what every run promises whatever it is
// given: an exit code of 0 to 3; on 2 and 3 one message and nothing written; on 0 no number that is not one.
//
// WEARWELL_FUZZ_RUNS sets how many are tried, WEARWELL_FUZZ_SEED which, WEARWELL_FUZZ_PATIENCE how many seconds a run may take.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "support/messages.h"
#include "support/run_command.h"
#include "support/scratch.h"
#include "wearwell/base/rng.h"

namespace wearwell {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct Example {
  const char *study, *data;
};
constexpr Example examples[] = {
    {"joint/study.toml", "joint/joint_wear.csv"},
    {"joint/lognormal_flat.toml", "joint/joint_wear.csv"},
    {"joint/pointwise.toml", "joint/joint_wear.csv"},
    {"bearing/study.toml", "bearing/inspections.csv"},
    {"spring/case1.toml", "spring/spring_life.csv"},
    {"spring/sensible.toml", "spring/spring_life.csv"},
};

// What people and machines write where a number or a word should stand.
const std::vector<std::string> odd_values = {"0",
                                             "-1",
                                             "1e308",
                                             "-1e308",
                                             "1e-320",
                                             "nan",
                                             "inf",
                                             "\"\"",
                                             "\"x\"",
                                             "[]",
                                             "{}",
                                             "true",
                                             "1e5",
                                             "0x10",
                                             "1,5",
                                             "35.000",
                                             "1.234.5",
                                             "1e",
                                             "\"1 m\"",
                                             "\"5\"",
                                             "\"nan mm\"",
                                             "2026-01-01",
                                             "999999999999999999999",
                                             "\"1e400 mm\"",
                                             "\"-3 um\"",
                                             "[1, 2, 3]",
                                             "\"\\u0007\"",
                                             "\"\xc2\xb5m\"",
                                             "\"\xff\""};
const std::vector<std::string> odd_cells = {
    "",       "0",    "-1", "1e308",   "1e-308",     "NaN",   "inf", "x",
    "35.000", "1,5",  "\"", "\"a,b\"", " ",          "#",     "-0",  "1e400",
    "\xb5",   "NULL", "'",  "1e9999",  "2026-01-01", "12:30", "true"};
const std::vector<std::string> odd_units = {"mm",         "1/mm", "N",   "cycles",      "rad",
                                            "degC",       "1",    "m^3", "lg(re 1 mm)", "furlong",
                                            "mm^3/(N m)", "%",    "2 3"};
const std::vector<std::string> options = {
    "--method exact", "--method nuts", "--method metropolis",
    "--chains 1",     "--chains 0",    "--draws 10",
    "--draws -5",     "--seed -1",     "--seed 99999999999999999999",
    "--threads 1",    "--threads 0",   "--no-report",
    "--warmup 0",     "--unknown",     "--draws x"};

class Mutator {
 public:
  explicit Mutator(std::uint64_t stream, std::uint64_t seed) : rng_(seed, stream) {}

  std::size_t below(std::size_t n) {
    return static_cast<std::size_t>(rng_.uniform() * static_cast<double>(n));
  }
  template <class T>
  const T& one_of(const std::vector<T>& of) {
    return of[below(of.size())];
  }

  std::string study(std::string text) {
    for (std::size_t n = below(2) + below(2); n-- > 0;) text = study_once(text);
    return text;
  }
  std::string data(std::string text) {
    for (std::size_t n = below(2) + below(2); n-- > 0;) text = data_once(text);
    return text;
  }

 private:
  static std::vector<std::string> lines(const std::string& text) {
    std::vector<std::string> all;
    std::stringstream stream(text);
    for (std::string line; std::getline(stream, line);) all.push_back(line);
    return all;
  }
  static std::string joined(const std::vector<std::string>& all) {
    std::string text;
    for (const std::string& line : all) text += line + "\n";
    return text;
  }

  // Cuts, doubles or moves lines, or spoils bytes: of any text.
  std::string text_once(const std::string& text) {
    std::vector<std::string> all = lines(text);
    if (all.empty()) return text;
    const std::size_t at = below(all.size());
    switch (below(6)) {
      case 0:
        all.erase(all.begin() + static_cast<std::ptrdiff_t>(at));
        return joined(all);
      case 1:
        all.insert(all.begin() + static_cast<std::ptrdiff_t>(at), all[below(all.size())]);
        return joined(all);
      case 2:
        std::swap(all[at], all[below(all.size())]);
        return joined(all);
      case 3:
        return text.substr(0, below(text.size()));
      case 4: {
        std::string spoiled = text;
        spoiled[below(spoiled.size())] = static_cast<char>(below(256));
        return spoiled;
      }
      default: {
        std::string spoiled = text;
        spoiled.erase(below(spoiled.size()), 1);
        return spoiled;
      }
    }
  }

  std::string study_once(const std::string& text) {
    std::vector<std::string> all = lines(text);
    std::vector<std::size_t> keys;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].find('=') != std::string::npos) keys.push_back(i);
    }
    if (keys.empty() || below(3) == 0) return text_once(text);
    std::string& line = all[one_of(keys)];
    const std::size_t equals = line.find('=');
    switch (below(4)) {
      case 0:
        line = line.substr(0, equals + 1) + " " + one_of(odd_values);
        break;
      case 1: {  // the first number of the value
        const std::size_t digit = line.find_first_of("0123456789", equals);
        if (digit == std::string::npos) break;
        const std::size_t end = line.find_first_not_of("0123456789.eE+-", digit);
        line.replace(digit, end == std::string::npos ? end : end - digit, one_of(odd_cells));
        break;
      }
      case 2: {
        const std::size_t unit = line.find("unit = \"");
        if (unit == std::string::npos) break;
        const std::size_t end = line.find('"', unit + 8);
        if (end != std::string::npos) line.replace(unit + 8, end - unit - 8, one_of(odd_units));
        break;
      }
      default:
        line.insert(below(equals + 1), 1, static_cast<char>('a' + below(26)));
    }
    return joined(all);
  }

  std::string data_once(const std::string& text) {
    std::vector<std::string> all = lines(text);
    if (all.size() < 2 || below(4) == 0) return text_once(text);
    switch (below(5)) {
      case 0:
        all.resize(1 + below(3));
        return joined(all);
      case 1:
        return "\xef\xbb\xbf" + text;
      default: {
        std::string& line = all[below(all.size())];
        std::vector<std::size_t> starts = {0};
        for (std::size_t i = 0; i < line.size(); ++i) {
          if (line[i] == ',') starts.push_back(i + 1);
        }
        const std::size_t start = one_of(starts), end = line.find(',', start);
        line.replace(start, end == std::string::npos ? end : end - start, one_of(odd_cells));
        return joined(all);
      }
    }
  }

  Rng rng_;
};

std::string slurp(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

int setting(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text ? std::atoi(text) : otherwise;
}

// Every number of a trusted answer is one: what JSON cannot hold was written as null.
void expect_numbers(const Json& summary, const std::string& what) {
  for (const auto& [name, parameter] : summary.at("parameters").items()) {
    for (const char* key : {"mean", "q05", "q50", "q95"}) {
      EXPECT_TRUE(parameter.at(key).is_number()) << what << ": parameters." << name << "." << key;
    }
  }
  for (const Json& prediction : summary.value("predictions", Json::array())) {
    for (const char* key : {"mean", "ci05", "ci95", "pi05", "pi95"}) {
      EXPECT_TRUE(prediction.at(key).is_number()) << what << ": predictions." << key;
    }
  }
}

class Contract : public ScratchTest {
 protected:
  void expect_kept(const CommandResult& run, const std::set<std::string>& before,
                   const std::string& what) const {
    ASSERT_GE(run.exit_code, 0) << what;
    ASSERT_LE(run.exit_code, 3) << what << run.err;
    if (run.exit_code >= 2) {
      EXPECT_EQ(run.out, "") << what;
      EXPECT_TRUE(run.err.starts_with("wearwell: ")) << what << run.err;
      EXPECT_EQ(messages_in(run.err), 1u) << what << run.err;
      EXPECT_LT(run.err.size(), 2500u) << what;
      for (const char* foreign : {"internal error", "exception", "Binder", "terminate"}) {
        EXPECT_EQ(run.err.find(foreign), std::string::npos) << what << run.err;
      }
      for (const char c : run.err) {
        EXPECT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= 0x20) << what << run.err;
      }
      EXPECT_EQ(names(), before) << what << ": something was written";
      return;
    }
    const Json summary = Json::parse(run.out, nullptr, false);
    ASSERT_FALSE(summary.is_discarded()) << what << run.out.substr(0, 300);
    EXPECT_EQ(summary.at("trusted").get<bool>(), run.exit_code == 0) << what;
    if (run.exit_code == 0) expect_numbers(summary, what);
  }

  std::set<std::string> names() const {
    std::set<std::string> all;
    for (const auto& entry : fs::directory_iterator(folder())) all.insert(entry.path().filename());
    return all;
  }
};

TEST_F(Contract, HoldsForWhateverIsGiven) {
  const int runs = setting("WEARWELL_FUZZ_RUNS", 40), seed = setting("WEARWELL_FUZZ_SEED", 1);
  const std::string patience = std::to_string(setting("WEARWELL_FUZZ_PATIENCE", 120));
  std::array<int, 4> codes{};
  for (int i = 0; i < runs; ++i) {
    Mutator mutate(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(seed));
    const Example& example = examples[mutate.below(std::size(examples))];
    const fs::path root = PROJECT_SOURCE_DIR "/examples";
    write("study.toml", mutate.study(slurp(root / example.study)));
    write(fs::path(example.data).filename(), mutate.data(slurp(root / example.data)));
    const std::string option =
        mutate.below(2) == 0 ? "--chains 2 --draws 100 --warmup 200" : mutate.one_of(options);
    const std::set<std::string> before = names();
    const std::string what =
        "run " + std::to_string(i) + " (" + example.study + " " + option + "): ";
    const CommandResult run =
        run_command("cd '" + folder().string() + "' && timeout --signal=ABRT " + patience +
                    " '" WEARWELL_BINARY "' fit study.toml -o out --json --no-report " + option +
                    " </dev/null");
    expect_kept(run, before, what);
    if (run.exit_code >= 0 && run.exit_code <= 3) ++codes[static_cast<std::size_t>(run.exit_code)];
    if (HasFailure()) {
      const fs::path kept = fs::temp_directory_path() / ("wearwell-contract-" + std::to_string(i));
      fs::remove_all(kept);
      fs::copy(folder(), kept, fs::copy_options::recursive);
      ADD_FAILURE() << what << "kept in " << kept;
    }
    fs::remove_all(folder() / "out");
    if (testing::Test::HasFatalFailure()) return;
  }
  std::printf("%d runs: %d trusted, %d not, %d refused, %d failed\n", runs, codes[0], codes[1],
              codes[2], codes[3]);
  EXPECT_EQ(codes[3], 0) << "nothing failed on this machine, and yet a run said so";
}

}  // namespace
}  // namespace wearwell
