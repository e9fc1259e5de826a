// docs/reference/priors.md against the reader: every line of its TOML is read, every key in it is needed, and no law is left out.
#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <regex>
#include <set>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/input/prior.h"
#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

struct Line {
  std::string name;
  std::vector<std::string> keys;  // "law = ...", "mean = ..."
};

std::string text_of_page() {
  std::ifstream file(PROJECT_SOURCE_DIR "/docs/reference/priors.md");
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<Line> lines_of_page() {
  const std::string page = text_of_page();
  const std::regex prior(R"((\w+) += \{ (distribution = [^}]*) \})");
  std::vector<Line> lines;
  for (std::sregex_iterator i(page.begin(), page.end(), prior), end; i != end; ++i) {
    Line line{(*i)[1], {}};
    const std::string keys = (*i)[2];
    const std::regex comma(", ");
    for (std::sregex_token_iterator k(keys.begin(), keys.end(), comma, -1), last; k != last; ++k) {
      line.keys.push_back(*k);
    }
    lines.push_back(line);
  }
  return lines;
}

class PriorDocs : public ScratchTest {
 protected:
  Parameter read(const std::string& name, const std::vector<std::string>& keys) {
    const std::map<std::string, ParameterSpec> specs = {
        {"k",
         {"k", "m^3/(N m)", 0, infinity, 7e-13,
          DefaultPrior{"lognormal", Lognormal{1e-13, 4}, "mm^3/(N m)"}}},
        {"sigma", {"sigma", "m^3", 0, infinity, 5e-9}},
        {"gamma", {"gamma", "1", 0, 1, 0.5}},
        {"log10_a", {"log10_a", "log10(Pa)", -infinity, infinity, 9.3}}};
    std::string toml = name + " = {";
    const char* separator = " ";
    for (const std::string& key : keys) {
      toml += separator + key;
      separator = ", ";
    }
    const auto root = TomlReader::parse_file(write("prior.toml", toml + " }\n"));
    Parameter parameter = read_prior(root, specs.at(name));
    root.finish();
    return parameter;
  }
};

TEST_F(PriorDocs, EveryLineIsReadAndEveryKeyInItIsNeeded) {
  const std::vector<Line> lines = lines_of_page();
  EXPECT_EQ(lines.size(), 28u);
  for (const Line& line : lines) {
    EXPECT_NO_THROW(read(line.name, line.keys)) << line.name << " " << line.keys.front();
    for (std::size_t i = 0; i < line.keys.size(); ++i) {
      std::vector<std::string> fewer = line.keys;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
      EXPECT_THROW(read(line.name, fewer), InputError)
          << line.keys.front() << " without " << line.keys[i];
    }
  }
}

TEST_F(PriorDocs, NoLawIsLeftOut) {
  std::set<std::string> documented;
  for (const Line& line : lines_of_page()) {
    documented.insert(line.keys.front().substr(16, line.keys.front().size() - 17));
  }
  // The reader lists what it knows.
  const std::string refusal =
      message_of<InputError>([&] { read("k", {"distribution = \"none such\""}); });
  std::smatch list;
  ASSERT_TRUE(std::regex_search(refusal, list, std::regex("use one of (.*) \\(nearest")))
      << refusal;
  const std::string names = list[1];
  const std::regex comma(", ");
  int known = 0;
  const std::string page = text_of_page();
  for (std::sregex_token_iterator i(names.begin(), names.end(), comma, -1), end; i != end; ++i) {
    ++known;
    EXPECT_TRUE(documented.contains(*i)) << *i;
    EXPECT_THAT(page, testing::HasSubstr("| `" + std::string(*i) + "` |")) << *i;
  }
  EXPECT_EQ(known, 23);
  EXPECT_EQ(documented.size(), 23u);
}

}  // namespace
}  // namespace wearwell
