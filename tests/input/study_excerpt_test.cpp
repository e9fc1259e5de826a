// The line of a study behind a message.
#include "wearwell/input/study_excerpt.h"

#include <gmock/gmock.h>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/base/shown.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/study_keys.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

TEST(StudyExcerpt, ALineWithACaretAndWhatIsRight) {
  const char* const study = "[predict]\n  limt = \"5 mm\"  # worn\n";
  EXPECT_EQ(study_excerpt(study, 2, 10), "\n    limt = \"5 mm\"  # worn\n           ^");
  EXPECT_EQ(study_excerpt(study, 2, 10, {"limt", "limit", true}),
            "\n    limt = \"5 mm\"  # worn\n           ^\n    right: limit = \"5 mm\"  # worn");
  EXPECT_EQ(study_excerpt(study, 1, 1, {"predict", "prior", true}),
            "\n    [predict]\n    ^\n    right: [prior]");
  EXPECT_EQ(study_excerpt(study, 7, 1), "");
  EXPECT_EQ(study_excerpt(study, 0, 0), "");
}

TEST(StudyExcerpt, CaretsCountCharacters) {
  EXPECT_EQ(study_excerpt("l\u00E4nge = 5\n", 1, 9), "\n    l\u00E4nge = 5\n            ^");
  EXPECT_EQ(study_excerpt("\tx = 5\r\n", 1, 6), "\n    x = 5\n        ^");
}

TEST(StudyExcerpt, OnlyWholeWordsAreRepaired) {
  EXPECT_EQ(study_excerpt("a = 5.25", 1, 5, {"5", "\"5 mm\""}), "\n    a = 5.25\n        ^");
  EXPECT_THAT(study_excerpt("x_a = 1, a = 2", 1, 14, {"a", "b", true}),
              EndsWith("right: x_a = 1, b = 2"));
}

TEST(StudyExcerpt, LongLinesAreCut) {
  const std::string line = "a = \"" + std::string(300, 'x') + "\" ?";
  const std::string text = study_excerpt(line, 1, 308);
  EXPECT_THAT(text, HasSubstr("\n    ..."));
  EXPECT_LT(text.size(), 200u);
  EXPECT_EQ(shown("m" + text), "m" + text);
}

class StudyMessage : public ScratchTest {
 protected:
  TomlReader study(const std::string& text) const {
    return TomlReader::parse_file(write("s.toml", text));
  }
};

TEST_F(StudyMessage, AColumnThatIsNotThere) {
  const TomlReader root = study("[data.columns]\nvolume = { column = \"wer\", unit = \"mm^3\" }\n");
  const Table table = read_table(write("t.csv", "wear,n\n1,2\n"));
  const std::string message = message_of<InputError>([&] {
    read_column(root.required_table("data").required_table("columns"), "volume", "m^3", table);
  });
  EXPECT_THAT(message, HasSubstr("s.toml:2:10: data.columns.volume: "));
  EXPECT_THAT(message, HasSubstr("has no column 'wer' (nearest: 'wear')\n"));
  EXPECT_THAT(message,
              EndsWith("\n    volume = { column = \"wer\", unit = \"mm^3\" }\n             ^\n    "
                       "right: volume = { column = \"wear\", unit = \"mm^3\" }"));
  EXPECT_THAT(shown(message), EndsWith("right: volume = { column = \"wear\", unit = \"mm^3\" }"));
}

TEST_F(StudyMessage, AUnitThatIsMissing) {
  const Table table = read_table(write("t.csv", "wear,n\n1,2\n"));
  for (const char* written : {"\"wear\"", "{ column = \"wear\" }"}) {
    const TomlReader root = study(std::string("[data.columns]\nvolume = ") + written + "\n");
    EXPECT_THAT(message_of<InputError>([&] {
                  read_column(root.required_table("data").required_table("columns"), "volume",
                              "m^3", table);
                }),
                EndsWith("right: volume = { column = \"wear\", unit = \"m^3\" }"));
  }
  EXPECT_THAT(message_of<InputError>([&] { study("limit = 5 # mm").quantity("limit", "m"); }),
              EndsWith("\n    limit = 5 # mm\n            ^\n    right: limit = \"5 m\" # mm"));
}

TEST_F(StudyMessage, KeysThatAreMisspelt) {
  const TomlReader root = study("model = \"a\"\n[prdict]\nlimit = 1\n[data]\nfil = \"x.csv\"\n");
  root.required_text("model");
  StudyKeys keys;
  keys.push_back({"model", "\"a\"", "which"});
  keys.push_back({"predict.limit", "1", "when"});
  keys.push_back({"data.file", "\"x.csv\"", "where"});
  const std::string message = unused_keys(root, keys);
  EXPECT_THAT(message, HasSubstr("s.toml:2:1: prdict: unknown key; did you mean 'predict'?"));
  EXPECT_THAT(message,
              EndsWith("\n    [prdict]\n    ^\n    right: [predict]\n    fil = \"x.csv\"\n    "
                       "      ^\n    right: file = \"x.csv\""));
  EXPECT_EQ(shown(message), message);
  EXPECT_THAT(without_excerpt(message), Not(HasSubstr("\n")));
}

TEST_F(StudyMessage, ChoicesAndSlipsOfToml) {
  EXPECT_THAT(message_of<InputError>([&] {
                study("family = 'norml'").choice("family", {"normal", "gamma"});
              }),
              EndsWith("right: family = 'normal'"));
  EXPECT_THAT(message_of<InputError>([&] { study("a = 1\nb = 3,5\n"); }),
              HasSubstr("\n    b = 3,5\n"));
}

}  // namespace
}  // namespace wearwell
