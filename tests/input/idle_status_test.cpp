// Columns that look like a status and that no key names.
#include "wearwell/input/idle_status.h"

#include <gmock/gmock.h>

#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class IdleStatusTest : public ScratchTest {
 protected:
  Table table(const std::string& heading, const std::vector<std::string>& cells) const {
    std::string text = "hours," + heading + "\n";
    for (const std::string& each : cells) text += "12.5," + each + "\n";
    return read_table(write("t.csv", text));
  }
  // Of a study whose section [data] has `more`.
  void refuse(const Table& read, const std::string& more = "", RowKind kind = RowKind::life) const {
    const TomlReader root = TomlReader::parse_file(
        write("s.toml", "[data]\n" + more + "\n[data.columns]\nlife = \"hours\"\n"));
    refuse_idle_status(root.required_table("data"), read, kind);
  }
  std::string refusal(const std::string& heading, const std::vector<std::string>& cells,
                      RowKind kind = RowKind::life) const {
    return message_of<InputError>([&] { refuse(table(heading, cells), "", kind); });
  }
};

TEST_F(IdleStatusTest, ARefusalNamesBothReadings) {
  EXPECT_THAT(refusal("event", {"0", "1", "1"}),
              AllOf(HasSubstr("data.columns.status: is missing"), HasSubstr("'event'"),
                    HasSubstr("(0, 1)"), HasSubstr("all 3 rows count as failures"),
                    HasSubstr("status = \"event\""), HasSubstr("unused = [\"event\"]")));
  EXPECT_THAT(refusal("status", {"0", "1"}),
              AllOf(HasSubstr("status = { column = \"status\", failure = 1 } if 1 is a failure"),
                    HasSubstr("failure = 0")));
  EXPECT_THAT(refusal("outcome", {"failed", "running"}), HasSubstr("failure, runout, left"));
}

TEST_F(IdleStatusTest, RunOutsAmongFailureModesAreRefusedBesideLives) {
  EXPECT_THAT(refusal("cause", {"seal", "censored", "wear"}),
              AllOf(HasSubstr("'cause'"), HasSubstr("(censored, seal, wear)"),
                    HasSubstr("mode = \"cause\" and [failure_modes] column = \"mode\"")));
  EXPECT_NE(refusal("failure mode", {"seal", "censored", "wear"}), "");
  EXPECT_NO_THROW(refuse(table("grade", {"S", "A", "C"})));  // short words can be anything
  EXPECT_NO_THROW(refuse(table("cause", {"seal", "censored"}), "", RowKind::measurement));
  EXPECT_NO_THROW(refuse(table("cause", {"seal", "censored"}), "unused = [\"cause\"]"));
}

TEST_F(IdleStatusTest, HeadingsThatSaySoAreRefusedBesideAnyMeasurement) {
  for (const char* heading :
       {"event", "events", "Censored", "censor", "failed", "failure", "status", "state",
        "Suspended?", "is_dead", "event observed", "run-out"}) {
    EXPECT_NE(refusal(heading, {"0", "1"}, RowKind::measurement), "") << heading;
    EXPECT_NE(refusal(heading, {"True", "False"}, RowKind::measurement), "") << heading;
  }
  EXPECT_NE(refusal("status", {"F", "S"}, RowKind::measurement), "");
  EXPECT_NE(refusal("censored", {"1", "1"}, RowKind::measurement), "");  // none is a failure
}

TEST_F(IdleStatusTest, BesideLivesTruthValuesOfAnyHeadingAreRefused) {
  for (const auto& cells : std::vector<std::vector<std::string>>{
           {"0", "1"}, {"true", "false"}, {"yes", "no"}, {"Y", "N"}, {"F", "S"}}) {
    EXPECT_NE(refusal("d", cells), "") << cells[0];
    EXPECT_NO_THROW(refuse(table("d", cells), "", RowKind::measurement)) << cells[0];
  }
}

TEST_F(IdleStatusTest, WordsOfOtherLanguages) {
  EXPECT_NE(refusal("Ende", {"Bruch", "Durchl\u00E4ufer"}), "");
  EXPECT_NE(refusal("zensiert", {"0", "1"}, RowKind::measurement), "");
  EXPECT_NE(refusal("x", {"oui", "non"}), "");
}

TEST_F(IdleStatusTest, OtherColumnsAreLetPass) {
  EXPECT_NO_THROW(refuse(table("temperature", {"20", "80"})));
  EXPECT_NO_THROW(refuse(table("failure mode", {"seal", "bearing"})));
  EXPECT_NO_THROW(refuse(table("state", {"NSW", "WA"})));
  EXPECT_NO_THROW(refuse(table("failures", {"0", "17"})));
  EXPECT_NO_THROW(refuse(table("ring", {"1", "2"})));
  EXPECT_NO_THROW(refuse(table("note", {"", ""})));
}

TEST_F(IdleStatusTest, AColumnThatCallsEveryRowAFailureChangesNothing) {
  EXPECT_NO_THROW(refuse(table("event", {"1", "1"})));
  EXPECT_NO_THROW(refuse(table("censored", {"0", "0"})));
  EXPECT_NO_THROW(refuse(table("status", {"F", "F"})));
  EXPECT_NO_THROW(refuse(table("status", {"1", "1"})));
}

TEST_F(IdleStatusTest, TheStudyMaySayThatItKnows) {
  const Table read = table("event", {"0", "1"});
  EXPECT_NO_THROW(refuse(read, "unused = [\"event\"]"));
  EXPECT_NO_THROW(refuse(read, "unused = \"event\""));
  EXPECT_THROW(refuse(read, "unused = [\"events\"]"), InputError);
  EXPECT_NO_THROW(refuse(read, "sql = \"select * from data where Event = 1\""));
  EXPECT_THROW(refuse(read, "sql = \"select * from data\""), InputError);
  const TomlReader root =
      TomlReader::parse_file(write("s.toml", "[data.columns]\nlife = \"hours\"\nz = \"event\"\n"));
  EXPECT_NO_THROW(refuse_idle_status(root.required_table("data"), read, RowKind::life));
}

}  // namespace
}  // namespace wearwell
