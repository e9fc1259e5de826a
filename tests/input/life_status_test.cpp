// How life tests ended: words, and codes that can be read two ways.
#include "wearwell/input/life_status.h"

#include <gmock/gmock.h>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/input/status_words.h"

namespace wearwell {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class LifeStatusTest : public ScratchTest {
 protected:
  Table table(const std::string& heading, const std::vector<std::string>& cells) const {
    std::string text = "n," + heading + "\n";
    for (const std::string& each : cells) text += "1," + each + "\n";
    return read_table(write("t.csv", text));
  }
  TomlReader columns(const std::string& status) const {
    return TomlReader::parse_file(write("s.toml", "[data.columns]\nstatus = " + status + "\n"))
        .required_table("data")
        .required_table("columns");
  }
  std::vector<Censoring> seen(const std::string& heading, const std::vector<std::string>& cells,
                              std::string status = "") const {
    if (status.empty()) status = "\"" + heading + "\"";
    const Table read = table(heading, cells);
    const auto column = read_life_status(columns(status), read);
    std::vector<Censoring> all;
    for (std::size_t i = 0; i < read.rows; ++i) all.push_back(seen_in(read, *column, i));
    return all;
  }
};

TEST_F(LifeStatusTest, WordsSayItThemselves) {
  EXPECT_THAT(
      seen("status", {"failure", "F", "runout", "run-out", "right", "S", "left", "interval"}),
      ElementsAre(Censoring::none, Censoring::none, Censoring::right, Censoring::right,
                  Censoring::right, Censoring::right, Censoring::left, Censoring::interval));
}

TEST_F(LifeStatusTest, WordsOfFourLanguages) {
  for (const char* word : {"failed", "FAILURE", "f", "Bruch", "ausgefallen", "n.i.O.",
                           "d\u00E9faillance", "rupture", "rotura", "fallo", "observed", "broken"})
    EXPECT_THAT(seen("z", {word}), ElementsAre(Censoring::none)) << word;
  for (const char* word : {"RO", "running", "C", "s", "Suspended", "censored", "Run Out",
                           "Durchl\u00E4ufer", "Durchlaeufer", "DURCHL\u00C4UFER", "kein Bruch",
                           "censur\u00E9", "non rompu", "sin rotura", "OK"})
    EXPECT_THAT(seen("z", {word}), ElementsAre(Censoring::right)) << word;
  EXPECT_THAT(seen("z", {"left-censored", "linkszensiert", "Intervall"}),
              ElementsAre(Censoring::left, Censoring::left, Censoring::interval));
  EXPECT_THAT(seen("ausgefallen", {"WAHR", "FALSCH"}),
              ElementsAre(Censoring::none, Censoring::right));
  EXPECT_THAT(seen("zensiert", {"ja", "nein"}), ElementsAre(Censoring::right, Censoring::none));
}

TEST_F(LifeStatusTest, WordsOfTheStudyComeFirst) {
  EXPECT_THAT(
      seen("z", {"kaputt", "l\u00E4uft weiter", "aus", "OK"},
           "{ column = \"z\", failure = \"kaputt\", runout = [\"L\u00E4uft weiter\", \"aus\"] }"),
      ElementsAre(Censoring::none, Censoring::right, Censoring::right, Censoring::right));
  EXPECT_THAT(seen("z", {"OK"}, "{ column = \"z\", failure = \"OK\" }"),
              ElementsAre(Censoring::none));
  EXPECT_THAT(seen("z", {"1", "0"}, "{ column = \"z\", failure = \"1\", runout = \"0\" }"),
              ElementsAre(Censoring::none, Censoring::right));
  EXPECT_THAT(
      seen("z", {"x", "1", "y"}, "{ column = \"z\", failure = 0, left = \"x\", interval = \"y\" }"),
      ElementsAre(Censoring::left, Censoring::right, Censoring::interval));
  EXPECT_THAT(seen("z", {"failed", ""}, "{ column = \"z\", runout = \"\" }"),
              ElementsAre(Censoring::none, Censoring::right));
  EXPECT_THAT(message_of<InputError>(
                  [&] { seen("z", {"x"}, "{ column = \"z\", failure = \"x\", runout = \"X\" }"); }),
              HasSubstr("data.columns.status.runout: 'X' is given for two statuses"));
}

TEST_F(LifeStatusTest, AWordThatIsNoneIsRefusedWithTheKey) {
  EXPECT_THAT(message_of<InputError>([&] {
                seen("Zustand", {"Bruch", "Brruch"});
              }),
              AllOf(HasSubstr("row 2, column 'Zustand': 'Brruch' is not a status"),
                    HasSubstr("(nearest: 'bruch')"),
                    HasSubstr("status = { column = \"Zustand\", failure = \"Brruch\" }")));
  EXPECT_THAT(message_of<InputError>([&] { seen("z", {"quux"}); }),
              testing::Not(HasSubstr("nearest")));
}

TEST_F(LifeStatusTest, CodesNeedAHeadingOrTheStudyToTell) {
  for (const char* heading : {"status", "c", "delta", "failed_or_censored"}) {
    EXPECT_THAT(
        message_of<InputError>([&] {
          seen(heading, {"0", "1"});
        }),
        AllOf(HasSubstr("s.toml:2:10: data.columns.status: "), HasSubstr("row 1"),
              HasSubstr("is ambiguous"), HasSubstr("failure = 0 }"), HasSubstr("failure = 1")))
        << heading;
  }
  for (const char* heading : {"censored", "Cens.", "Run-out", "suspended?"})
    EXPECT_THAT(seen(heading, {"0", "1"}), ElementsAre(Censoring::none, Censoring::right))
        << heading;
  for (const char* heading : {"event", "Failed", "is_broken", "died"})
    EXPECT_THAT(seen(heading, {"0", "1"}), ElementsAre(Censoring::right, Censoring::none))
        << heading;
  EXPECT_THAT(seen("failed", {"true", "false"}), ElementsAre(Censoring::none, Censoring::right));
  EXPECT_THAT(seen("failed", {"True", "FALSE"}), ElementsAre(Censoring::none, Censoring::right));
  EXPECT_THAT(seen("censored", {"true", "false"}), ElementsAre(Censoring::right, Censoring::none));
  EXPECT_THAT(seen("d", {"0", "1", "-1", "2"}, "{ column = \"d\", failure = 0 }"),
              ElementsAre(Censoring::none, Censoring::right, Censoring::left, Censoring::interval));
  EXPECT_THAT(seen("d", {"1", "0", "2", "3"}, "{ column = \"d\", failure = 1 }"),
              ElementsAre(Censoring::none, Censoring::right, Censoring::left, Censoring::interval));
  // What the study says outweighs the heading.
  EXPECT_THAT(seen("event", {"0", "1"}, "{ column = \"event\", failure = 0 }"),
              ElementsAre(Censoring::none, Censoring::right));
}

TEST_F(LifeStatusTest, CodesOfTheOtherSetAreRefused) {
  EXPECT_THAT(message_of<InputError>([&] {
                seen("event", {"1", "-1"});
              }),
              AllOf(HasSubstr("row 2, column 'event': '-1' is not a status"),
                    HasSubstr("1 failure, 0 runout, 2 left, 3 interval")));
  EXPECT_THAT(message_of<InputError>([&] {
                seen("censored", {"1", "3"});
              }),
              HasSubstr("row 2, column 'censored': '3' is not a status"));
  EXPECT_THAT(message_of<InputError>([&] {
                seen("status", {"failure", "brake"});
              }),
              HasSubstr("row 2, column 'status': 'brake' is not a status"));
  EXPECT_THAT(message_of<InputError>([&] { seen("d", {"0"}, "{ column = \"d\", failure = 2 }"); }),
              HasSubstr("failure"));
}

TEST(StatusWords, MisspeltRunOutsAreRecognized) {
  for (const char* word : {"still runing", "Runout!", "runnout", "rumout", "runuot", "survved",
                           "in sevrice", "Durchlaufr", "suspendet", "not faild"})
    EXPECT_EQ(misspelt_runout(word).has_value(), folded_word(word) != "runout") << word;
  for (const char* word : {"seal", "sensor", "rubbing", "burnout", "contact", "impact", "valve",
                           "tight", "running", "suspension", "crack", "mode 1", ""})
    EXPECT_FALSE(misspelt_runout(word)) << word;
  // Without the syllable that negates, these are other words, not negations misspelt.
  for (const char* word : {"angebrochen", "abgebrochen", "ausgebrochen", "eingebrochen",
                           "zerbrochen", "contacto", "intakt"})
    EXPECT_FALSE(misspelt_runout(word)) << word;
  for (const char* word :
       {"ungebrochn", "ungebrohcen", "unbrokn", "nicht gebrochn", "non rompuu", "intct"})
    EXPECT_TRUE(misspelt_runout(word)) << word;
}

TEST(StatusWords, AFailureOfNoModeNamesNoCause) {
  for (const char* word : {"failed", "FAILURE", "n.i.O.", "Ausfall", "en panne", "averiado"})
    EXPECT_TRUE(is_failure_of_no_mode(word)) << word;
  for (const char* word : {"crack", "Bruch", "rupture", "worn out", "suspended", "seal", ""})
    EXPECT_FALSE(is_failure_of_no_mode(word)) << word;
}

}  // namespace
}  // namespace wearwell
