// Sheets of .xlsx, made of the XML that ECMA-376 has for them; and files that are none.
#include "wearwell/input/workbook.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <zip.h>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/input/column_stream.h"
#include "wearwell/input/spreadsheet_cell.h"
#include "wearwell/input/table.h"

namespace wearwell {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

using Parts = std::map<std::string, std::string>;

class WorkbookTest : public ScratchTest {
 protected:
  std::filesystem::path zip_of(const Parts& parts, const char* name = "a.xlsx") const {
    const auto file = folder() / name;
    int error = 0;
    zip* archive = zip_open(file.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error);
    EXPECT_NE(archive, nullptr);
    for (const auto& [part, text] : parts)
      zip_file_add(archive, part.c_str(), zip_source_buffer(archive, text.data(), text.size(), 0),
                   0);
    EXPECT_EQ(zip_close(archive), 0);
    return file;
  }

  /// A workbook of sheets, each of them by the XML of its rows.
  static Parts parts_of(const std::map<std::string, std::string>& sheets) {
    Parts parts;
    std::string names, relations;
    int number = 0;
    for (const auto& [name, rows] : sheets) {
      ++number;
      names += fmt::format(R"(<sheet name="{}" sheetId="{}" r:id="rId{}"/>)", name, number, number);
      relations += fmt::format(
          R"(<Relationship Id="rId{0}" Type="http://x/relationships/worksheet" Target="worksheets/sheet{0}.xml"/>)",
          number);
      parts[fmt::format("xl/worksheets/sheet{}.xml", number)] =
          "<worksheet><sheetData>" + rows + "</sheetData></worksheet>";
    }
    parts["xl/workbook.xml"] =
        fmt::format(R"(<workbook xmlns:r="r"><workbookPr/><sheets>{}</sheets></workbook>)", names);
    parts["xl/_rels/workbook.xml.rels"] = "<Relationships>" + relations + "</Relationships>";
    parts["xl/sharedStrings.xml"] =
        "<sst><si><t>life</t></si><si><r><t>lo</t></r><r><t>ad [N]</t></r><rPh><t>xx</t></rPh></si>"
        "<si><t>a &amp; b,\nc</t></si></sst>";
    parts["xl/styles.xml"] =
        R"(<styleSheet><numFmts><numFmt numFmtId="164" formatCode="dd.mm.yyyy\ hh:mm"/>)"
        R"(<numFmt numFmtId="165" formatCode="0.0&quot; days&quot;"/></numFmts><cellXfs>)"
        R"(<xf numFmtId="0"/><xf numFmtId="14"/><xf numFmtId="164"/><xf numFmtId="46"/>)"
        R"(<xf numFmtId="9"/><xf numFmtId="165"/></cellXfs></styleSheet>)";
    return parts;
  }
  std::filesystem::path book(const std::string& rows) const {
    return zip_of(parts_of({{"Tabelle1", rows}}));
  }
  static Table read(const std::filesystem::path& file, const TableSettings& settings = {},
                    const std::optional<std::string>& sql = {}) {
    return read_table(file, sql, {}, settings);
  }
  static std::string refused(const std::filesystem::path& file,
                             const TableSettings& settings = {}) {
    return message_of<InputError>([&] { read(file, settings); });
  }
};

constexpr const char* two_columns =
    R"(<row r="1"><c r="A1" t="s"><v>0</v></c><c r="B1" t="s"><v>1</v></c></row>)"
    R"(<row r="2"><c r="A2"><v>35.000</v></c><c r="B2"><f>1+A9</f><v>1.234</v></c></row>)"
    R"(<row r="4"><c r="A4"><v>1.2E4</v></c><c r="B4"><v>0.1</v></c></row>)";

TEST_F(WorkbookTest, NumbersTextsAndFormulas) {
  const Table table = read(book(two_columns));
  ASSERT_EQ(table.rows, 2u);
  EXPECT_EQ(table.layout.text, "sheet 'Tabelle1'");
  EXPECT_THAT(si_numbers(table, "life", Unit{}), ElementsAre(35, 12000));
  EXPECT_THAT(si_numbers(table, "load [N]", Unit{}), ElementsAre(1.234, 0.1));
  EXPECT_EQ(place(table, "life", 1), table.source + ", row 2 (line 4), column 'life'");
  EXPECT_THAT(read(book(two_columns), {}, "select max(life) as x from data").columns[0].numbers,
              ElementsAre(12000));
  ColumnStream stream(book(two_columns));
  EXPECT_THAT(stream.headings(), ElementsAre("life", "load [N]"));
}

TEST_F(WorkbookTest, DatesDurationsAndOtherCells) {
  // 45352 is 2024-03-01 (Excel's own help for DATEVALUE counts from 1900-01-01 as day 1).
  const Table table = read(book(
      R"(<row r="1"><c r="A1" t="inlineStr"><is><t>day</t></is></c><c r="B1" t="str"><v>at</v></c>)"
      R"(<c r="C1" t="str"><v>ran</v></c><c r="D1" t="str"><v>slip</v></c><c r="E1" t="str"><v>age</v></c>)"
      R"(<c r="F1" t="str"><v>ok</v></c><c r="G1" t="str"><v>q</v></c><c r="H1" t="str"><v>note</v></c></row>)"
      R"(<row r="2"><c r="A2" s="1"><v>45352</v></c><c r="B2" s="2"><v>45352.52083333333</v></c>)"
      R"(<c r="C2" s="3"><v>1.5451388888888888</v></c><c r="D2" s="4"><v>0.05</v></c>)"
      R"(<c r="E2" s="5"><v>2.5</v></c><c r="F2" t="b"><v>1</v></c><c r="G2" t="e"><v>#DIV/0!</v></c>)"
      R"(<c r="H2" t="s"><v>2</v></c></row>)"));
  const auto cell = [&](const char* name) { return table.column(name).text[0]; };
  EXPECT_EQ(cell("day"), "2024-03-01");
  EXPECT_EQ(cell("at"), "2024-03-01 12:30:00");
  EXPECT_EQ(cell("ran"), "37:05:00");
  EXPECT_EQ(cell("slip"), "5 %");
  EXPECT_EQ(cell("ok"), "true");
  EXPECT_EQ(cell("q"), "#DIV/0!");
  EXPECT_EQ(cell("note"), "a & b, c");
  EXPECT_THAT(table.column("age").numbers, ElementsAre(2.5));
  EXPECT_THAT(message_of<InputError>([&] { si_numbers(table, "q", Unit{}); }),
              HasSubstr("row 1, column 'q': '#DIV/0!' is not a number"));
  EXPECT_EQ(table.column("slip").unit, "%");
  EXPECT_THAT(si_numbers(table, "slip", Unit{}), ElementsAre(5));
}

TEST_F(WorkbookTest, FormatsAsExcelHasThem) {
  EXPECT_EQ(format_of_code("General"), CellFormat::number);
  EXPECT_EQ(format_of_code("#,##0.00\\ \"mm\u00B3\""), CellFormat::number);
  EXPECT_EQ(format_of_code("0.00E+00"), CellFormat::number);
  EXPECT_EQ(format_of_code("#,##0.00_-[$\u20AC-407]"), CellFormat::number);
  EXPECT_EQ(format_of_code("[Red]0.0;[Blue]-0.0"), CellFormat::number);
  EXPECT_EQ(format_of_code("[$-407]d. mmmm yyyy;@"), CellFormat::date);
  EXPECT_EQ(format_of_code("hh:mm:ss"), CellFormat::time);
  EXPECT_EQ(format_of_code("yyyy-mm-dd\\Thh:mm"), CellFormat::date_and_time);
  EXPECT_EQ(format_of_code("[h]:mm:ss"), CellFormat::duration);
  EXPECT_EQ(format_of_code("0.0%"), CellFormat::percent);
  EXPECT_EQ(formatted("1", CellFormat::date, false), "1900-01-01");
  EXPECT_EQ(formatted("61", CellFormat::date, false), "1900-03-01");
  EXPECT_EQ(formatted("0", CellFormat::date, true), "1904-01-01");
  EXPECT_EQ(formatted("0.75", CellFormat::time, false), "18:00:00");
  EXPECT_EQ(formatted("-1", CellFormat::date, false), "#####");
}

TEST_F(WorkbookTest, SheetRangeAndHeadingRow) {
  const std::string other =
      R"(<row r="2"><c r="B2" t="str"><v>Versuch 3</v></c></row>)"
      R"(<row r="3"><c r="B3" t="str"><v>x</v></c><c r="C3" t="str"><v>y</v></c></row>)"
      R"(<row r="4"><c r="B4" t="str"><v>mm</v></c><c r="C4" t="str"><v>N</v></c></row>)"
      R"(<row r="5"><c r="B5"><v>1</v></c><c r="C5"><v>2</v></c></row>)"
      R"(<row r="6"><c r="B6"><v>3</v></c><c r="C6"><v>4</v></c></row>)"
      R"(<row r="8"><c r="B8" t="str"><v>Summe</v></c><c r="E8"><v>9</v></c></row>)";
  const auto file = zip_of(parts_of({{"A", two_columns}, {"B", other}, {"C", ""}}));
  EXPECT_THAT(refused(file),
              AllOf(HasSubstr("several sheets; state which in [data], for example sheet = \"A\""),
                    HasSubstr("(it has A, B)")));
  EXPECT_EQ(read(file, {.sheet = "A"}).rows, 2u);
  EXPECT_EQ(read(file, {.sheet = "1"}).rows, 2u);
  EXPECT_THAT(refused(file, {.sheet = "a"}),
              HasSubstr("has no sheet 'a'; it has A, B, C (nearest: 'A')"));
  EXPECT_THAT(refused(file, {.sheet = "C"}), HasSubstr("is empty"));
  const Table table = read(file, {.sheet = "B", .range = "B2:C6"});
  EXPECT_EQ(table.layout.text, "sheet 'B', headings in row 3, units in the row below the headings");
  EXPECT_EQ(table.column("y").unit, "N");
  EXPECT_THAT(si_numbers(table, "y", Unit{}), ElementsAre(2, 4));
  EXPECT_EQ(read(file, {.header_row = 3, .sheet = "B", .range = "$B$3:$C$5"}).rows, 1u);
  for (const char* bad : {"B3:", "3:4", "C6:B2", "B3:F20x", "", "ZZZZ1:B2"})
    EXPECT_THAT(refused(file, {.sheet = "B", .range = bad}), HasSubstr("is not a range of a sheet"))
        << bad;
  EXPECT_THAT(refused(file, {.delimiter = ';', .sheet = "B"}),
              HasSubstr("are keys for tables of text"));
  EXPECT_THAT(refused(write("a.csv", "x,y\n1,2\n"), {.sheet = "B"}), HasSubstr("keys for .xlsx"));
  EXPECT_THAT(refused(write("a.csv", "x,y\n1,2\n"), {.hidden_rows = false}),
              HasSubstr("keys for .xlsx"));
}

/// A row of cells from column A on: numbers as they are, texts behind a quote, nothing where empty.
std::string row_of(int number, const std::vector<std::string>& cells, const char* more = "") {
  std::string row = fmt::format(R"(<row r="{}" {}>)", number, more);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].empty()) continue;
    const std::string name = fmt::format("{}{}", column_letters(i + 1), number);
    row += cells[i].front() == '\''
               ? fmt::format(R"(<c r="{}" t="inlineStr"><is><t>{}</t></is></c>)", name,
                             cells[i].substr(1))
               : fmt::format(R"(<c r="{}"><v>{}</v></c>)", name, cells[i]);
  }
  return row + "</row>";
}

TEST_F(WorkbookTest, NumbersInCellsOfText) {
  const auto with = [&](const std::vector<std::string>& cells) {
    std::string rows = row_of(1, {"'x", "'y"});
    for (std::size_t i = 0; i < cells.size(); ++i)
      rows += row_of(static_cast<int>(i) + 2, {cells[i], "1"});
    return book(rows);
  };
  const auto numbers = [&](const std::vector<std::string>& cells,
                           const TableSettings& settings = {}) {
    return si_numbers(read(with(cells), settings), "x", Unit{});
  };
  EXPECT_THAT(numbers({"'3,2", "3.4", "'1.234,5"}), ElementsAre(3.2, 3.4, 1234.5));
  EXPECT_EQ(read(with({"'3,2", "3.4"})).layout.text,
            "sheet 'Tabelle1', decimal comma in text cells");
  EXPECT_THAT(numbers({"'3.2", "'1,234.5"}), ElementsAre(3.2, 1234.5));
  // Beside a decimal comma a point is a mark for thousands; a cell that is a number has none.
  EXPECT_THAT(numbers({"'35.000", "'3,2", "35.000"}), ElementsAre(35000, 3.2, 35));
  EXPECT_THAT(numbers({"'35.000"}, {.decimal = '.'}), ElementsAre(35));
  EXPECT_THAT(numbers({"'35.000"}, {.thousands = '.'}), ElementsAre(35000));
  EXPECT_THAT(message_of<InputError>([&] {
                numbers({"1", "'35.000"});
              }),
              AllOf(HasSubstr("column 'x': row 3 of the sheet"), HasSubstr("35 or"),
                    HasSubstr("35000"), HasSubstr("decimal = \",\"")));
  EXPECT_THAT(message_of<InputError>([&] {
                numbers({"'3.2", "'3,2"});
              }),
              AllOf(HasSubstr("'3,2' in row 3"), HasSubstr("'3.2' in row 2")));
  // A column that nobody asks for may be as it is.
  EXPECT_THAT(si_numbers(read(with({"1", "'35.000"})), "y", Unit{}), ElementsAre(1, 1));
}

TEST_F(WorkbookTest, MergedCellsStandInEachRow) {
  Parts parts = parts_of({{"A", ""}});
  parts["xl/worksheets/sheet1.xml"] =
      "<worksheet><sheetData>" + row_of(1, {"'part", "'life"}) + row_of(2, {"'A", "1"}) +
      row_of(3, {"", "2"}) + row_of(4, {"'B", "3"}) + row_of(5, {"", "4"}) + row_of(6, {"", "5"}) +
      R"(</sheetData><mergeCells><mergeCell ref="A2:A3"/><mergeCell ref="A4:A5"/></mergeCells></worksheet>)";
  const Table table = read(zip_of(parts));
  EXPECT_THAT(table.column("part").text, ElementsAre("A", "A", "B", "B", ""));
  EXPECT_EQ(table.layout.text, "sheet 'A', merged cells A2:A3, A4:A5 read in each of their rows");
}

TEST_F(WorkbookTest, HiddenRowsAreSaid) {
  const auto file = book(row_of(1, {"'x", "'y"}) + row_of(2, {"1", "2"}) +
                         row_of(3, {"3", "4"}, R"(hidden="1")") + row_of(4, {"5", "6"}));
  const Table table = read(file);
  EXPECT_EQ(table.rows, 3u);
  EXPECT_EQ(table.layout.text, "sheet 'Tabelle1', 1 hidden row read like the others (3)");
  const Table without = read(file, {.hidden_rows = false});
  EXPECT_THAT(si_numbers(without, "x", Unit{}), ElementsAre(1, 5));
  EXPECT_EQ(without.layout.text, "sheet 'Tabelle1', 1 hidden row left out (3)");
}

TEST_F(WorkbookTest, WhatIsRefused) {
  EXPECT_THAT(refused(write("a.xlsx", "no zip at all")),
              HasSubstr("truncated, damaged or not an .xlsx"));
  EXPECT_THAT(refused(write("a.xlsx", "\xD0\xCF\x11\xE0 and so on")),
              HasSubstr("has a password or is an old .xls"));
  EXPECT_THAT(refused(zip_of({{"word/document.xml", "<w/>"}})), HasSubstr("not an Excel workbook"));
  EXPECT_THAT(refused(book("<row><c r=\"A1\"><f>1+1</f></c></row>")),
              HasSubstr("cell A1 of sheet 'Tabelle1' has a formula without its value"));
  EXPECT_THAT(refused(book("<row r=\"1\"><c r=\"A1\" t=\"s\"><v>77</v></c></row>")),
              HasSubstr("refers to a text that the file does not contain"));
  EXPECT_THAT(refused(book("<row r=\"1\"><c r=\"A1\">")), HasSubstr("mismatched tag"));
  EXPECT_THAT(refused(book("")), HasSubstr("is empty"));
  EXPECT_THAT(refused(book("<row r=\"1048577\"><c r=\"A1048577\"><v>1</v></c></row>")),
              HasSubstr("has no cell"));
  EXPECT_THAT(refused(book(R"(<row r="1"><c r="A1"><v>1</v></c></row>)"
                           R"(<row r="1048576"><c r="XFD1048576"><v>1</v></c></row>)")),
              HasSubstr("too many for a table; give its range"));
  Parts parts = parts_of({{"A", two_columns}});
  parts["xl/sharedStrings.xml"] =
      "<!DOCTYPE x [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;&a;\">]><sst><si><t>&b;</t></si></sst>";
  EXPECT_THAT(refused(zip_of(parts)), HasSubstr("custom entities"));
  parts["xl/sharedStrings.xml"] = "<sst>" + std::string(70 << 20, ' ') + "</sst>";
  EXPECT_THAT(refused(zip_of(parts)), HasSubstr("unpacks to more than 64 MB"));
  // Cut anywhere, it is refused with one message.
  const auto file = book(two_columns);
  std::ifstream stream(file, std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(stream)), {});
  for (std::size_t size = 1; size < whole.size(); size += 37)
    EXPECT_THAT(refused(write("cut.xlsx", whole.substr(0, size))),
                HasSubstr("truncated, damaged or not an .xlsx"));
  for (std::size_t at = 0; at < whole.size(); at += 11) {
    std::string damaged = whole;
    damaged[at] ^= 0x41;
    try {
      read(write("damaged.xlsx", damaged));
    } catch (const InputError& error) {
      EXPECT_STRNE(error.what(), "");
    }
  }
}

}  // namespace
}  // namespace wearwell
