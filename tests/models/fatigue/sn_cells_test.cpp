// Lives and statuses as people write them in tables of life tests.
#include <gmock/gmock.h>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/fatigue/sn_data.h"

namespace wearwell {
namespace {

using fatigue::Outcome;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class SnCells : public ScratchTest {
 protected:
  SnData read(const std::string& table, const std::string& columns) const {
    write("t.csv", table);
    const Source source = source_of(
        write("s.toml",
              "[data]\nfile = \"t.csv\"\n[data.columns]\nalternating_stress = { column = \"S\", "
              "unit = \"MPa\" }\nlife = \"N\"\n" +
                  columns));
    return read_sn_data(TomlReader::parse(source.study), source, fatigue::MeanStress::none);
  }
  std::vector<Outcome> outcomes(const std::string& table, const std::string& columns) const {
    std::vector<Outcome> all;
    for (const fatigue::LifeTest& each : read(table, columns).tests) all.push_back(each.outcome);
    return all;
  }
  std::string refused(const std::string& table, const std::string& columns) const {
    return message_of<InputError>([&] { read(table, columns); });
  }
};

TEST_F(SnCells, ALifeWithASignIsCensoredAtThatValue) {
  const std::string table = "S;N\n300;120.000\n200;>5.000.000\n250;<1000\n280;12,5\n";
  const SnData data = read(table, "");
  EXPECT_THAT(outcomes(table, ""),
              ElementsAre(Outcome::failure, Outcome::runout, Outcome::left, Outcome::failure));
  EXPECT_EQ(data.tests[0].life, 120000);
  EXPECT_EQ(data.tests[1].life, 5e6);
  EXPECT_EQ(data.tests[2].life, 1000);
  EXPECT_THAT(data.layout.text, HasSubstr("2 cells of 'N' that are limits ('>5.000.000')"));
}

TEST_F(SnCells, ASignAndAStatusMustAgree) {
  const std::string table = "S,N,z\n300,120000,Bruch\n200,>5e6,";
  EXPECT_THAT(outcomes(table + "RO\n", "status = \"z\"\n"),
              ElementsAre(Outcome::failure, Outcome::runout));
  EXPECT_THAT(refused(table + "Bruch\n", "status = \"z\"\n"),
              AllOf(HasSubstr("row 2, column 'N': '>5e6' is a limit"),
                    HasSubstr("column 'z' has 'Bruch'")));
}

TEST_F(SnCells, WordsOfTheStudy) {
  EXPECT_THAT(outcomes("S,N,z\n300,120000,hin\n200,5e6,fertig\n",
                       "status = { column = \"z\", failure = \"hin\", runout = \"fertig\" }\n"),
              ElementsAre(Outcome::failure, Outcome::runout));
}

TEST_F(SnCells, AnEmptyLabelBelowAnotherIsRefused) {
  EXPECT_THAT(refused("S,N,part\n300,1e5,A\n200,2e5,\n250,3e5,B\n", "label = \"part\"\n"),
              AllOf(HasSubstr("row 2, column 'part': no value"),
                    HasSubstr("'A', the label of the rows above")));
  EXPECT_THAT(read("S,N,part\n300,1e5,\n200,2e5,\n", "label = \"part\"\n").labels,
              ElementsAre("", ""));
}

}  // namespace
}  // namespace wearwell
