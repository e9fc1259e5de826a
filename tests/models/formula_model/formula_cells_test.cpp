// Cells that are limits, in what a formula measures and elsewhere.
#include <gmock/gmock.h>

#include <cmath>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/formula_model/formula_data.h"

namespace wearwell::formula_model {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class FormulaCells : public ScratchTest {
 protected:
  FormulaData read(const std::string& table, const std::string& columns) const {
    write("t.csv", table);
    const Source source =
        source_of(write("s.toml", "[data]\nfile = \"t.csv\"\n[data.columns]\n" + columns));
    return read_own_data(TomlReader::parse(source.study), source, {});
  }
  static Observed observed(const FormulaData& data) {
    return read_observed(data, "V", response_forms().front(), special_columns(data), {}, false);
  }
};

const std::string volume =
    "V = { column = \"V\", unit = \"mm^3\" }\ns = { column = \"s\", unit = \"m\" }\n";

TEST_F(FormulaCells, LimitsAreCensored) {
  const FormulaData data = read("V,s\n<0.5,1\n1.5,2\n>3,3\n", volume);
  const Observed found = observed(data);
  ASSERT_EQ(found.responses.size(), 3u);
  EXPECT_EQ(found.responses[0].seen, Censoring::left);
  EXPECT_DOUBLE_EQ(found.responses[0].at, 0.5e-9);
  EXPECT_EQ(found.responses[1].seen, Censoring::none);
  EXPECT_DOUBLE_EQ(found.responses[1].at, 1.5e-9);
  EXPECT_EQ(found.responses[2].seen, Censoring::right);
  EXPECT_DOUBLE_EQ(found.responses[2].at, 3e-9);
}

TEST_F(FormulaCells, AWordInAColumnThatQualifiesMeasurementsIsRefused) {
  for (const std::string name : {"count", "entry", "lower", "upper"}) {
    EXPECT_THAT(message_of<InputError>(
                    [&] { read("V,s,n\n1,1,2\n1.5,2,many\n", volume + name + " = \"n\"\n"); }),
                HasSubstr("row 2, column 'n': 'many' is not a number"))
        << name;
  }
}

TEST_F(FormulaCells, ALimitOfDetectionStandsInTheStudy) {
  const std::string table = "V,s\n<LOD,1\n1.5,2\n";
  EXPECT_THAT(message_of<InputError>([&] { read(table, volume); }),
              AllOf(HasSubstr("row 1, column 'V': '<LOD' does not state its limit"),
                    HasSubstr("detection_limit = \"0.05 mm^3\"")));
  const FormulaData data =
      read(table,
           "V = { column = \"V\", unit = \"mm^3\", detection_limit = \"0.02 mm^3\" "
           "}\ns = { column = \"s\", unit = \"m\" }\n");
  const Observed found = observed(data);
  EXPECT_EQ(found.responses[0].seen, Censoring::left);
  EXPECT_DOUBLE_EQ(found.responses[0].at, 0.02e-9);
}

TEST_F(FormulaCells, LimitsElsewhereAreRefused) {
  const FormulaData data = read("V,s\n1,<1\n1.5,2\n", volume);
  EXPECT_NO_THROW(data.require_complete(*data.number("V")));
  EXPECT_THAT(message_of<InputError>([&] { data.require_complete(*data.number("s")); }),
              HasSubstr("row 1, column 's': '<1' is a limit"));
}

TEST_F(FormulaCells, ALimitAndAStatusMustAgree) {
  const std::string table = "V,s,end\n<1,1,left\n1.5,2,F\n>2,3,",
                    columns = volume + "status = \"end\"\n";
  EXPECT_EQ(observed(read(table + "S\n", columns)).failures, 2u);
  const FormulaData data = read(table + "F\n", columns);
  EXPECT_THAT(
      message_of<InputError>([&] { observed(data); }),
      AllOf(HasSubstr("row 3, column 'V': '>2' is a limit"), HasSubstr("column 'end' has 'F'")));
}

TEST_F(FormulaCells, UnitsInCellsAndNoValues) {
  const FormulaData data =
      read("V,s\n0.5 mm^3,1\n1.5 mm^3,NA\n", "V = \"V\"\ns = { column = \"s\", unit = \"m\" }\n");
  EXPECT_DOUBLE_EQ(data.number("V")->values[1], 1.5e-9);
  EXPECT_TRUE(std::isnan(data.number("s")->values[1]));
  EXPECT_THAT(message_of<InputError>(
                  [&] { read("V,s\n0.5 mm^3,1\n", "V = { column = \"V\", unit = \"cm^3\" }\n"); }),
              HasSubstr("in mm^3 by its cells"));
}

}  // namespace
}  // namespace wearwell::formula_model
