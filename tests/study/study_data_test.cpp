// Where a study names its data: files, columns, second lives, whole numbers.
#include <gmock/gmock.h>

#include "support/posterior_study.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/input/columns.h"
#include "wearwell/models/clutch/clutch_tables.h"

namespace wearwell {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class StudyDataTest : public ScratchTest {
 protected:
  /// A study of lives; `life_until` of row 2 is as given.
  std::string sn_refusal(const std::string& data, const std::string& file = "t.csv") const {
    write(file, data);
    const auto study = write("s.toml", R"toml(model = "sn"
[law]
mean_stress = "none"
[data]
file = ")toml" + file + R"toml("
[data.columns]
alternating_stress = { column = "s", unit = "MPa" }
life = "n"
life_until = "until"
status = "status"
[prior]
log10_a = { distribution = "flat", unit = "log10(MPa)" }
b = { distribution = "flat" }
sigma = { distribution = "flat" }
)toml");
    return message_of<InputError>([&] { read_posterior_study(study); });
  }
};

TEST_F(StudyDataTest, SecondLivesThatAreNoNumbers) {
  const std::string head = "s,n,until,status\n300,1000,,F\n250,5000,";
  EXPECT_THAT(sn_refusal(head + "later,interval\n200,9000,,F\n"),
              HasSubstr("row 2, column 'until': 'later' is not a number"));
  EXPECT_THAT(sn_refusal(head + ",interval\n200,9000,,F\n"),
              HasSubstr("row 2, column 'until': no value; an interval ends at a second life"));
  EXPECT_THAT(sn_refusal(head + "inf,interval\n200,9000,,F\n"), HasSubstr("row 2"));
  EXPECT_THAT(sn_refusal(head + "4000,interval\n200,9000,,F\n"),
              HasSubstr("row 2, column 'until': 4000 must be more than the life"));
  // All of them numbers, but written as text.
  EXPECT_THAT(sn_refusal(R"([{"s": 300, "n": 1000, "until": "", "status": "F"},
                             {"s": 250, "n": 5000, "until": "4000", "status": "interval"}])",
                         "t.json"),
              HasSubstr("row 2, column 'until': 4000 must be more than the life"));
}

// As if each row were an interval, while the status says otherwise.
TEST_F(StudyDataTest, SecondLivesOfRowsThatAreNoIntervals) {
  const std::string head = "s,n,until,status\n300,1000,,F\n250,5000,";
  EXPECT_THAT(sn_refusal(head + "7000,F\n200,9000,,F\n"),
              AllOf(HasSubstr("row 2, column 'until': 7000 would end an interval"),
                    HasSubstr("write interval there")));
  EXPECT_THAT(sn_refusal(head + "7000,S\n200,9000,,F\n"), HasSubstr("row 2, column 'until'"));
  // A failure's own life, and a run-out's open end, say nothing else.
  EXPECT_THAT(sn_refusal(head + "inf,S\n200,9000,9000,F\n150,9000,,went on\n"),
              HasSubstr("row 4, column 'status': 'went on' is not a status"));
}

TEST_F(StudyDataTest, FilesAreNamedAtTheirKey) {
  const auto section = [&](const std::string& text) {
    return TomlReader::parse_file(write("s.toml", "title = 1\n[data]\n" + text))
        .required_table("data");
  };
  EXPECT_THAT(message_of<InputError>([&] {
                read_table(section("file = \"non.csv\"\n"), Source{{folder() / "study.toml", ""}});
              }),
              AllOf(HasSubstr("s.toml:3:8: data.file: no such file: "), HasSubstr("non.csv")));
  write("a.csv", "x\n1\n");
  EXPECT_THAT(message_of<InputError>([&] {
                read_table(section("file = \"a.csv\"\nsql = \"drop view data\"\n"),
                           Source{{folder() / "study.toml", ""}});
              }),
              HasSubstr("s.toml:4:7: data.sql: "));
  EXPECT_EQ(read_table(section("file = \"a.csv\"\n"), Source{{folder() / "study.toml", ""}}).rows,
            1U);
  EXPECT_THAT(message_of<InputError>([&] {
                read_table(section("file = \"\"\n"), Source{{folder() / "study.toml", ""}});
              }),
              HasSubstr("s.toml:3:8: data.file: is not given"));
}

// An int would make 1 of it.
TEST_F(StudyDataTest, PlatesBeyondAnInt) {
  const std::string heading =
      "plate,cycle,slip_speed [rpm],torque [N m],temperature [degC],closing_time [s],energy [J]\n";
  const auto file = write("c.csv", heading +
                                       "1,1,1700,50,170,2,9000\n4294967297,2,1700,50,170,2,"
                                       "9000\n");
  EXPECT_THAT(message_of<InputError>([&] { clutch::read_cycles(file); }),
              HasSubstr("row 2, column 'plate': 4294967297 is too large; at most 2000000000"));
}

}  // namespace
}  // namespace wearwell
