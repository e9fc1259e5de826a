#include "wearwell/input/csv_reader.h"

#include <gmock/gmock.h>

#include <cmath>

#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell {
namespace {

using testing::HasSubstr;

class CsvFile : public ScratchTest {
 protected:
  template <class F>
  std::string refused(const std::string& content, const F& read) const {
    const auto file = write("t.csv", content);
    return message_of<InputError>([&] {
      CsvReader csv(file);
      read(csv);
    });
  }
};

TEST_F(CsvFile, ReadsWhatItQuotes) {
  const std::vector<std::string> texts = {"plain", "a,b", "\"",  "\"\"", "say \"no\"", "two\nlines",
                                          "#1",    "",    " x ", ",",    "\",\"",      "mm³"};
  std::string content = "# comment\nlabel,x\n";
  for (const auto& text : texts) content += csv_cell(text) + ",1\n# comment\n";
  CsvReader csv(write("t.csv", content));
  for (const auto& text : texts) {
    ASSERT_TRUE(csv.next());
    EXPECT_EQ(csv.text(0), text);
    EXPECT_EQ(csv.text(1), "1");
  }
  EXPECT_FALSE(csv.next());
}

TEST_F(CsvFile, ReadsNumbersThatAreNotFinite) {
  CsvReader csv(write("t.csv", "x,y\ninf,nan\n-inf,5e-324\n"));
  ASSERT_TRUE(csv.next());
  EXPECT_EQ(csv.number(0), INFINITY);
  EXPECT_TRUE(std::isnan(csv.number(1)));
  ASSERT_TRUE(csv.next());
  EXPECT_EQ(csv.number(1), 5e-324);
}

TEST_F(CsvFile, NamesRowAndColumn) {
  EXPECT_THAT(refused("a,b\n1,2\n3\n",
                      [](CsvReader& csv) {
                        while (csv.next()) {
                        }
                      }),
              HasSubstr("t.csv, row 2: should have 2 cells"));
  EXPECT_THAT(refused("a,b\n1,zwei\n",
                      [](CsvReader& csv) {
                        csv.next();
                        csv.number(1);
                      }),
              HasSubstr("t.csv, row 1, column 'b': should be a number, and is 'zwei'"));
  EXPECT_THAT(refused("a\n1e999\n",
                      [](CsvReader& csv) {
                        csv.next();
                        csv.number(0);
                      }),
              HasSubstr("a number"));
  EXPECT_THAT(refused("a\n1.5\n",
                      [](CsvReader& csv) {
                        csv.next();
                        csv.integer(0);
                      }),
              HasSubstr("a whole number"));
  EXPECT_THAT(refused("a\n2\n",
                      [](CsvReader& csv) {
                        csv.next();
                        csv.flag(0);
                      }),
              HasSubstr("0 or 1"));
  EXPECT_THAT(refused("a\n", [](CsvReader& csv) { csv.column("b"); }),
              HasSubstr("has no column 'b'"));
  EXPECT_THAT(refused("# only\n", [](CsvReader&) {}), HasSubstr("is empty"));
  EXPECT_THAT(message_of<InputError>([&] { CsvReader csv(folder() / "none.csv"); }),
              HasSubstr("none.csv is missing"));
  EXPECT_THAT(message_of<InputError>([&] { CsvReader csv(folder()); }), HasSubstr("cannot read"));
}

}  // namespace
}  // namespace wearwell
