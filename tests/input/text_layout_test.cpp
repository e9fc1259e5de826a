// Tables of text as spreadsheets and loggers of many countries write them: found out, said, settable.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/input/column_stream.h"
#include "wearwell/input/table.h"

namespace wearwell {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using namespace std::string_literals;

class TextLayoutTest : public ScratchTest {
 protected:
  Table read(const std::string& content, const TableSettings& settings = {},
             const std::optional<std::string>& sql = {}) const {
    return read_table(write("a.csv", content), sql, {}, settings);
  }
  std::vector<double> numbers(const std::string& content, const char* column,
                              const TableSettings& settings = {}) const {
    return si_numbers(read(content, settings), column, Unit{});
  }
  std::string refused(const std::string& content, const char* column,
                      const TableSettings& settings = {}) const {
    return message_of<InputError>([&] { numbers(content, column, settings); });
  }

  /// As UTF-16, of characters below U+0100.
  static std::string utf16(const std::string& latin, bool little) {
    std::string text = little ? "\xFF\xFE" : "\xFE\xFF";
    for (const char c : latin) text += little ? std::string{c, '\0'} : std::string{'\0', c};
    return text;
  }
};

// Excel in Germany: semicolons, decimal commas, points for thousands, CRLF, Windows-1252, rows of
// nothing at the end.
TEST_F(TextLayoutTest, GermanExcel) {
  const std::string body =
      "Lastwechsel;Volumen [mm\xB3];Gr\xF6\xDF"
      "e\r\n1.000;0,35;klein\r\n10.000;1,2;\r\n250.000;12,75;gro\xDF\r\n;;\r\n";
  const Table table = read(body);
  EXPECT_EQ(table.layout.text,
            "semicolons, decimal comma, thousands point, cp1252, 1 empty row left out");
  EXPECT_THAT(si_numbers(table, "Lastwechsel", Unit{}), ElementsAre(1000, 10000, 250000));
  EXPECT_THAT(si_numbers(table, "Volumen [mm\u00B3]", Unit{}), ElementsAre(0.35, 1.2, 12.75));
  EXPECT_THAT(si_numbers(table, "Volumen", Unit{}), SizeIs(3)) << "by its name without the unit";
  EXPECT_THAT(table
                  .column("Gr\u00F6\u00DF"
                          "e")
                  .text,
              ElementsAre("klein", "", "gro\u00DF"));
  // The same as "Unicode text", and from a machine with the other order of bytes.
  for (const bool little : {true, false}) {
    const Table wide = read(utf16(body, little));
    EXPECT_THAT(si_numbers(wide, "Volumen", Unit{}), ElementsAre(0.35, 1.2, 12.75));
    EXPECT_THAT(wide.layout.text, HasSubstr("UTF-16"));
  }
}

TEST_F(TextLayoutTest, FrenchSwissAndItalian) {
  EXPECT_THAT(numbers("charge\tcycles\n250,5\t35\u202F000\n240,5\t1\u202F060\u202F000\n", "cycles"),
              ElementsAre(35000, 1060000));
  EXPECT_THAT(numbers("charge;cycles\n250,5;35 000\n240,5;900\n", "cycles"),
              ElementsAre(35000, 900));
  EXPECT_THAT(numbers("Last,Zyklen\n250.5,35'000\n240.5,1'060'000\n", "Zyklen"),
              ElementsAre(35000, 1060000));
  EXPECT_THAT(numbers("\xEF\xBB\xBF"
                      "carico;cicli\r\n\"250,5\";\"35.000\"\r\n",
                      "cicli"),
              ElementsAre(35000));
  EXPECT_EQ(read("charge;cycles\n250,5;35 000\n").layout.text,
            "semicolons, decimal comma, thousands blank");
}

TEST_F(TextLayoutTest, WhatAStudySaysGoesFirst) {
  const char* const text = "load;life\n250;35.000\n240;60.000\n";
  EXPECT_THAT(refused(text, "life"), HasSubstr("'35.000' can mean 35 or"));
  EXPECT_THAT(numbers(text, "life", {.decimal = ','}), ElementsAre(35000, 60000));
  EXPECT_THAT(numbers(text, "life", {.decimal = '.'}), ElementsAre(35, 60));
  EXPECT_THAT(numbers(text, "life", {.thousands = '.'}), ElementsAre(35000, 60000));
  EXPECT_THAT(numbers("x;y\n1.5;2\n", "x", {.decimal = '.'}), ElementsAre(1.5));
  EXPECT_THAT(refused("x;y\n1.5;2\n", "x", {.decimal = ','}),
              HasSubstr("row 1, column 'x': '1.5' is not a number with a decimal comma"));
  EXPECT_THAT(refused("x;y\n1 500;2\n", "x", {.decimal = ',', .thousands = '.'}),
              HasSubstr("'1 500' is not a number with a decimal comma"));
  EXPECT_THAT(refused("x;y\n1.500;2\n", "x", {.decimal = ',', .thousands = '\0'}),
              HasSubstr("'1.500' is not a number"));
  EXPECT_THAT(numbers("a;b,c\n1;2,3\n4;5,6\n", "a", {.delimiter = ';'}), ElementsAre(1, 4));
  EXPECT_THAT(numbers("a;b,c\n1;2,3\n4;5,6\n", "c", {.delimiter = ','}), ElementsAre(3, 6));
  EXPECT_THAT(message_of<InputError>([&] { read("a;b,c\n1;2,3\n4;5,6\n"); }),
              HasSubstr("state which in [data], for example delimiter = \";\""));
  EXPECT_EQ(read("x,note\n1,\xC3\xA4\n", {.encoding = Encoding::cp1252}).columns[1].text[0],
            "\u00C3\u00A4");
  EXPECT_THAT(
      message_of<InputError>([&] { read("x,note\n1,\xE4\n", {.encoding = Encoding::utf8}); }),
      HasSubstr("line 2: "));
}

TEST_F(TextLayoutTest, LinesAboveTheHeadings) {
  const std::string preamble =
      "Pr\u00FCfstand 7\nPr\u00FCfer;M\u00FCller, Hans\n# 12 Proben\n\nZeit;Kraft;Weg\n";
  const Table table = read(preamble + "0,5;1,5;2,5\n1,5;2,5;3,5\n");
  EXPECT_EQ(table.layout.text, "semicolons, decimal comma, headings in line 5");
  EXPECT_THAT(si_numbers(table, "Kraft", Unit{}), ElementsAre(1.5, 2.5));
  // As Excel writes them, with all the semicolons.
  EXPECT_THAT(numbers("Bericht;;\nvom 3.4.2024;;\n;;\nZeit;Kraft;Weg\n1;2;3\n", "Weg"),
              ElementsAre(3));
  EXPECT_THAT(numbers("\nx,y\n1,2\n", "y"), ElementsAre(2));
  // A line may be named, and what stands in a wrong one is told by its line.
  EXPECT_THAT(numbers("a;b\nx;y\n1;2\n", "y", {.header_row = 2}), ElementsAre(2));
  EXPECT_THAT(message_of<InputError>([&] { read("a;b\n1;2\n", {.header_row = 9}); }),
              HasSubstr("has no line 9"));
  EXPECT_THAT(message_of<InputError>([&] { read("a;b\n\n1;2\n", {.header_row = 2}); }),
              HasSubstr("line 2: the line is empty"));
  EXPECT_THAT(refused(preamble + "0,5;1,5;2,5\n1,5;kaputt;3,5\n", "Kraft"),
              HasSubstr("row 2 (line 7), column 'Kraft': 'kaputt' is not a number"));
  EXPECT_THAT(message_of<InputError>([&] { read(preamble + "0,5;1,5;2,5\n1;2\n"); }),
              HasSubstr("line 7: 2 values but the heading has 3"));
  // Rows of data above what looks like headings are none that may be dropped.
  EXPECT_THAT(refused("1;2\nx;y\n3;4\n", "1"), HasSubstr("'x' is not a number"));
}

TEST_F(TextLayoutTest, CommentsAndCommasTooMany) {
  const char* const text = "x;y\n# warm\n1;2\n# cold; -5 degC\n3;4;\n";
  const Table table = read(text, {.comment = "#"});
  EXPECT_THAT(si_numbers(table, "y", Unit{}), ElementsAre(2, 4));
  EXPECT_EQ(table.layout.text, "semicolons, 2 comment lines left out");
  EXPECT_THAT(refused(text, "x"), HasSubstr("write comment = \"#\" in [data]"));
  EXPECT_THAT(numbers("x;y;\n1;2;\n3;4;\n", "y"), ElementsAre(2, 4));
  EXPECT_THAT(numbers("x;y\n1;2;;\n3;4;;\n", "y"), ElementsAre(2, 4));
  EXPECT_THAT(refused("x,y\n1,5,2\n", "x"),
              HasSubstr("line 2: 3 values but the heading has 2: '1,5,2' (if commas separate the "
                        "columns, quote numbers with a decimal comma"));
}

TEST_F(TextLayoutTest, ARowOfUnits) {
  const Table table = read("Zeit;Moment;Temp;Bemerkung\ns;Nm;\u00B0C;\n0,5;12,5;80;an\n1;13;81;\n");
  EXPECT_EQ(table.rows, 2u);
  EXPECT_EQ(table.column("Moment").unit, "Nm");
  EXPECT_EQ(table.column("Temp").unit, "\u00B0C");
  EXPECT_EQ(table.layout.text, "semicolons, decimal comma, units in the row below the headings");
  EXPECT_EQ(read("t,x\n[s],[mm]\n1,2\n").column("x").unit, "[mm]");
  EXPECT_EQ(read("t,x\n(s),-\n1,2\n").column("x").unit, "-");
  // Rows of data stay rows of data.
  EXPECT_EQ(read("status,label\nF,A\nS,A\n").rows, 2u);
  EXPECT_EQ(read("life,status\n100,F\n200,S\n").rows, 2u);
  EXPECT_EQ(read("status,label\nF,A\n1,2\n", {.units_row = false}).rows, 2u);
  // Dates are no units, with a blank beside them too.
  for (const char* const date : {"2024-02-01", "01.02.2024", "1/2/2024", "2024-02", "02/2024",
                                 "2024-02-01 08:30", "2024-02-01T08:30:00", "08:30"}) {
    const std::string day = date;
    const Table sales = read("sold,returned\n" + day + ",\n" + day + "," + day + "\n");
    EXPECT_EQ(sales.rows, 2u) << date;
    EXPECT_EQ(sales.column("sold").unit, "") << date;
  }
  EXPECT_EQ(read("t,x\ns,1/1000\n1,2\n").column("x").unit, "1/1000");
  EXPECT_EQ(read("x,y\nfurlong per lunar month,?\n1,2\n", {.units_row = true}).rows, 1u);
}

TEST_F(TextLayoutTest, ARowOfUnitsInGermanAndFrench) {
  const Table table =
      read("Nr.;Zyklen;Dauer;V\nEinheit;Lastwechsel;Std;mm\u00B3\n1;1000;2,5;0,1\n");
  EXPECT_EQ(table.rows, 1u);
  EXPECT_EQ(table.column("Nr.").unit, "");
  EXPECT_EQ(table.column("Zyklen").unit, "Lastwechsel");
  EXPECT_EQ(table.column("Dauer").unit, "Std");
  EXPECT_EQ(read("n;t;d\ntours;heures;mm\n1;2;3\n").column("t").unit, "heures");
}

TEST_F(TextLayoutTest, CellsWithoutAValue) {
  const Table table = read("x,y\n1,NA\nn/a,2.5\n3,#NV\n");
  EXPECT_TRUE(table.column("y").is_number);
  EXPECT_TRUE(std::isnan(table.column("y").numbers[0]));
  EXPECT_EQ(table.column("y").numbers[1], 2.5);
  EXPECT_EQ(
      table.layout.text,
      "commas, decimal point, 1 cell of 'x' without a value ('n/a'), 2 cells of 'y' without a "
      "value ('NA')");
  EXPECT_THAT(refused("x,y\n1,2\nNA,3\n", "x"),
              AllOf(HasSubstr("row 2, column 'x': no value"),
                    HasSubstr("sql = 'select * from data where \"x\" is not null'")));
  EXPECT_THAT(numbers("x,y\n1,2\nNA,3\n", "y"), ElementsAre(2, 3));
  // As a word it stays what it is.
  EXPECT_THAT(read("region,y\nNA,2\nEU,3\n").column("region").text, ElementsAre("NA", "EU"));
}

TEST_F(TextLayoutTest, CellsWithTheirUnit) {
  const Table table = read("d;y\n12 mm;1\n12,5 mm;2\n");
  EXPECT_EQ(table.column("d").unit, "mm");
  EXPECT_THAT(si_numbers(table, "d", Unit{}), ElementsAre(12, 12.5));
  EXPECT_EQ(table.layout.text, "semicolons, decimal comma, the unit mm in the cells of 'd'");
  EXPECT_THAT(table.column("d").text, ElementsAre("12 mm", "12,5 mm"));
  EXPECT_THAT(refused("d,y\n12 mm,1\n1.2 cm,2\n", "d"),
              AllOf(HasSubstr("row 1, column 'd': '12 mm'"), HasSubstr("'1.2 cm' in row 2")));
  EXPECT_THAT(refused("d,y\n12 mm,1\n13,2\n", "d"), HasSubstr("'13' in row 2 has none"));
  EXPECT_THAT(refused("d [cm],y\n12 mm,1\n", "d"), HasSubstr("in cm by its heading"));
  // Names of steels, and other words.
  EXPECT_THAT(refused("d,y\n304L,1\n", "d"), HasSubstr("'304L' is not a number"));
}

TEST_F(TextLayoutTest, CellsThatAreLimits) {
  const Table table = read("V;y\n<0,5;1\n1,25;2\n>5.000.000;3\n<LOD;4\n");
  const auto cell = [&](std::size_t row) { return cell_value(table, table.column("V"), row); };
  EXPECT_EQ(cell(0).sign, '<');
  EXPECT_EQ(cell(0).number, 0.5);
  EXPECT_EQ(cell(1).sign, 0);
  EXPECT_EQ(cell(2).sign, '>');
  EXPECT_EQ(cell(2).number, 5e6);
  EXPECT_TRUE(cell(3).unstated);
  EXPECT_THAT(table.layout.text, HasSubstr("3 cells of 'V' that are limits ('<0,5')"));
  EXPECT_THAT(message_of<InputError>([&] { si_numbers(table, "V", Unit{}); }),
              AllOf(HasSubstr("row 1, column 'V': '<0,5' is a limit"), HasSubstr("left-censored")));
}

TEST_F(TextLayoutTest, RowsOfMeansBelow) {
  const std::string rows = "Nr.;x\n1;2,5\n2;3,5\n";
  const Table table = read(rows + "Mittelwert;3\nStabw.;0,7\n");
  EXPECT_THAT(si_numbers(table, "x", Unit{}), ElementsAre(2.5, 3.5));
  EXPECT_EQ(table.layout.text,
            "semicolons, decimal comma, the last 2 rows left out (Mittelwert, Stabw.)");
  EXPECT_THAT(numbers(rows + ";\n;\nmean;3\n", "x"), ElementsAre(2.5, 3.5));
  EXPECT_THAT(numbers(rows + "Summe;6\n", "x", {.summary_rows = false}), ElementsAre(2.5, 3.5, 6));
  // Below names it can be one.
  const std::string named = "part,x\nA,2\nB,4\nmean,3\n";
  EXPECT_THAT(refused(named, "x"),
              AllOf(HasSubstr("line 4: 'mean' is ambiguous"), HasSubstr("summary_rows = \"last\""),
                    HasSubstr("\"none\"")));
  EXPECT_THAT(numbers(named, "x", {.summary_rows = true}), ElementsAre(2, 4));
  EXPECT_THAT(numbers(named, "x", {.summary_rows = false}), ElementsAre(2, 4, 3));
  // Above data it is a name.
  EXPECT_THAT(numbers("part,x\nmean,1\nmax,2\nA,3\nmax,4\n", "x"), ElementsAre(1, 2, 3, 4));
}

TEST_F(TextLayoutTest, MergedHeadings) {
  const Table table = read("Messung;;;\nPart;Load;;Wear\n1;2;3;4\n5;6;7;8\n");
  EXPECT_EQ(table.columns[2].name, "column3");
  EXPECT_THAT(si_numbers(table, "Wear", Unit{}), ElementsAre(4, 8));
  EXPECT_THAT(table.layout.text, AllOf(HasSubstr("headings in line 2"),
                                       HasSubstr("a column without a heading, read as 'column3'")));
}

TEST_F(TextLayoutTest, SqlSeesTheNumbers) {
  const Table table = read("Last;Zyklen\n250,5;35.000\n240,5;60.000\n", {},
                           "select sum(Zyklen) as n, min(Last) as low from data");
  EXPECT_THAT(table.column("n").numbers, ElementsAre(95000));
  EXPECT_THAT(table.column("low").numbers, ElementsAre(240.5));
  EXPECT_THAT(message_of<InputError>([&] {
                read("Last;Zyklen\n250;35.000\n", {}, "select Zyklen::double from data");
              }),
              HasSubstr("'35.000' can mean 35 or"));
}

TEST_F(TextLayoutTest, BrokenOnes) {
  EXPECT_THAT(message_of<InputError>([&] { read("\n\n\n"); }), HasSubstr("has no line"));
  EXPECT_THAT(message_of<InputError>([&] { read("\xEF\xBB\xBF"); }), HasSubstr("has no line"));
  EXPECT_THAT(message_of<InputError>([&] { read(";;;\n;;;\n"); }), HasSubstr("headings"));
  EXPECT_THAT(message_of<InputError>([&] { read("a;b\n"); }), HasSubstr("has no rows"));
  EXPECT_THAT(message_of<InputError>([&] { read("a;b\n;\n"); }), HasSubstr("has no rows"));
  EXPECT_THAT(message_of<InputError>([&] { read("a;b\n1;\"2\n3;4\n"); }),
              HasSubstr("line 2: a quote is not closed"));
  EXPECT_THAT(numbers("a;b\n1;2,5\n", "b"), ElementsAre(2.5));
  EXPECT_THAT(numbers("a\n2.5\n", "a"), ElementsAre(2.5));
  EXPECT_EQ(read("a, b, c\n1, \"x, y\", 2.5\n").column("b").text[0], "x, y");
  EXPECT_THAT(numbers("a, b, c\n1, \"x, y\", 2.5\n", "c"), ElementsAre(2.5));
  const Table quoted = read("\"a;1\";\"b\"\"2\"\n\"x\ny\";1,5\n");
  EXPECT_EQ(quoted.column("a;1").text[0], "x\ny");
  EXPECT_THAT(si_numbers(quoted, "b\"2", Unit{}), ElementsAre(1.5));
}

// What follows a closing quote would be one number with it: 2 and 5 are neither 2 nor 25.
TEST_F(TextLayoutTest, CellsThatGoOnBehindTheirQuote) {
  for (const char* content : {"n,v\n0,1\nx,\"2\"5\n", "n;v\n0;1,5\nx;\"2\" 5\n"})
    EXPECT_THAT(refused(content, "v"),
                AllOf(HasSubstr("a.csv, line 3: "), HasSubstr("behind its closing quote")))
        << content;
  EXPECT_THAT(numbers("n,v\n1,\"2\" \n", "v"), ElementsAre(2));
  std::string content = "n,v\n";
  for (int i = 0; i < 30'000; ++i) content += fmt::format("{},{}\n", i, i % 7);
  EXPECT_THAT(refused(content + "1,\"2\"x\n", "v"), HasSubstr("a.csv, line 30002: a cell goes on"));
  EXPECT_THAT(refused(content + "1,2,3\n", "v"), HasSubstr("a.csv, line 30002: 3 values"));
}

// Far below what a first look sees.
TEST_F(TextLayoutTest, SignsFarDown) {
  std::string content = "n;v\n";
  for (int i = 0; i < 30'000; ++i) content += fmt::format("{};{}\n", i, i % 7);
  EXPECT_THAT(numbers(content + "1;2,5\n", "v").back(), 2.5);
  EXPECT_THAT(refused(content + "1;2.500\n", "v"), HasSubstr("row 30001, column 'v'"));
  // Whole numbers in the first lines are no reason to round those that follow.
  EXPECT_EQ(numbers(content + "1;0.125\n2;2.500\n", "v").back(), 2.5);
  std::string json;
  for (int i = 0; i < 30'000; ++i) json += "{\"v\": 1}\n";
  const Table table = read_table(write("a.ndjson", json + "{\"v\": 2.5}\n"));
  EXPECT_EQ(si_numbers(table, "v", Unit{}).back(), 2.5);
}

}  // namespace
}  // namespace wearwell
