// Tables that are no tables as they stand: what is wrong, and in which line.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <zlib.h>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/input/column_stream.h"
#include "wearwell/input/table.h"

namespace wearwell {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using namespace std::string_literals;

class TextFileTest : public ScratchTest {
 protected:
  static std::string refusal(const std::filesystem::path& file) {
    return message_of<InputError>([&] { read_table(file); });
  }
  std::string refused(const std::string& content) { return refusal(write("a.csv", content)); }

  static std::string gzipped(const std::string& content) {
    z_stream stream = {};
    deflateInit2(&stream, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
    std::string packed(content.size() + 1000, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
    stream.avail_in = static_cast<unsigned>(content.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<unsigned>(packed.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
  }
};

TEST_F(TextFileTest, RaggedLinesAreNamed) {
  EXPECT_THAT(refused("x,y\n1,2\n3,4,5\n"),
              HasSubstr("a.csv, line 3: 3 values but the heading has 2: '3,4,5'"));
  EXPECT_THAT(refused("x,y\n1,2\n\n3\n"), HasSubstr("line 4: 1 value but the heading has 2: '3'"));
  EXPECT_THAT(refused("x,y,z\n1,2\n3,4\n"), HasSubstr("line 2: 2 values but the heading has 3"));
  EXPECT_THAT(refused("x;y\n1;2;3\n4;5;6\n"), HasSubstr("line 2: 3 values but the heading has 2"));
  EXPECT_THAT(refused("x,y\n1,2\n\"3,4\n5,6\n"), HasSubstr("line 3: a quote is not closed"));
  EXPECT_THAT(refused("v\n1,5\n2,5\n"), HasSubstr("line 2: 2 values but the heading has 1"));
  // Far below what a guess looks at.
  std::string content = "x,y\n";
  for (int i = 0; i < 60'000; ++i) content += "1,2\n";
  EXPECT_THAT(refused(content + "1\n"), HasSubstr("line 60002: 1 value but the heading has 2"));
  content += "1,2,3\n";
  const auto file = write("b.csv", content);
  EXPECT_THAT(message_of<InputError>([&] {
                ColumnStream stream(file);
                stream.select({"x"});
                ColumnStream::Batch batch;
                while (stream.next(batch)) {
                }
              }),
              HasSubstr("b.csv, line 60002: 3 values but the heading has 2"));
}

TEST_F(TextFileTest, LinesAreNeitherCommentsNorSkipped) {
  EXPECT_THAT(refused("x,y\n# a comment\n1,2\n"),
              HasSubstr("line 2: 1 value but the heading has 2: '# a comment' (comment lines are "
                        "not allowed by default; to omit them write comment = \"#\" in [data])"));
  // A cell that begins with '#' is a cell.
  const Table table = read_table(write("a.csv", "#x,y\n1,2\n#5,6\n"));
  EXPECT_EQ(table.rows, 2u);
  EXPECT_THAT(table.column("#x").text, ElementsAre("1", "#5"));
  EXPECT_THAT(read_table(write("b.csv", "v\n1\n# 2\n3\n")).column("v").text,
              ElementsAre("1", "# 2", "3"));
}

TEST_F(TextFileTest, OtherEncodings) {
  EXPECT_THAT(refused("x,y\n1,\xC3\xA4\n2,Gr\xF6\xDF"
                      "e\n"),
              AllOf(HasSubstr("line 3: "), HasSubstr("is not UTF-8, unlike the lines above it")));
  EXPECT_THAT(refused("x,note\n1,Gr\x81\n"), HasSubstr("neither UTF-8 nor cp1252"));
  EXPECT_THAT(refused("\xFF\xFEx\0,\0y\0\n\0001\0,\0\x00\xDC"s), HasSubstr("UTF-16"));
  EXPECT_THAT(refused("x,\0y\n1,2\n"s), HasSubstr("is not a text file: line 1 has zero bytes"));
  EXPECT_THAT(refused("x,y\r1,2\r"), HasSubstr("only a carriage return"));
  EXPECT_THAT(refused("x,y\r\n1,2\r\n3,4\n"), HasSubstr("line 3: its line ending"));
  const Table table = read_table(write("b.csv", "\xEF\xBB\xBFx,y\r\n1,2\r\n"));
  EXPECT_THAT(table.column("x").numbers, ElementsAre(1));
}

TEST_F(TextFileTest, ColumnsAreSeparatedInOneWay) {
  for (const char* content : {"x;y\n1;2\n", "x\ty\n1\t2\n", "x|y\n1|2\n", "x,y\n1,2\n",
                              "\"x;1\",y\n1,2\n", "x [N, m];y\n1;2\n"}) {
    const Table table = read_table(write("a.csv", content));
    ASSERT_EQ(table.columns.size(), 2u) << content;
    EXPECT_THAT(table.columns[1].numbers, ElementsAre(2)) << content;
  }
  EXPECT_THAT(refused("a;b,c\n1;2,3\n4;5,6\n"),
              HasSubstr("both ';' and ',' can separate its columns"));
  EXPECT_THAT(refused("n,N\n1,2\n"),
              HasSubstr("'n' (column 1) and 'N' (column 2), whose names differ only in case"));
}

TEST_F(TextFileTest, CutOrDamagedGzip) {
  std::string content = "x,y\n";
  for (int i = 0; i < 5000; ++i) content += fmt::format("{},{}\n", i, i * 37 % 1001);
  const std::string packed = gzipped(content);
  EXPECT_EQ(read_table(write("a.csv.gz", packed)).rows, 5000u);
  for (const double share : {0.1, 0.35, 0.7, 0.999}) {
    const auto size = static_cast<std::size_t>(share * static_cast<double>(packed.size()));
    EXPECT_THAT(refusal(write("a.csv.gz", packed.substr(0, size))), HasSubstr("is cut off"))
        << size;
  }
  EXPECT_THAT(refusal(write("a.csv.gz", packed.substr(0, packed.size() - 1))),
              HasSubstr("is cut off"));
  std::string damaged = packed;
  damaged[damaged.size() - 6] ^= 1;  // of the checksum
  EXPECT_THAT(refusal(write("a.csv.gz", damaged)), HasSubstr("damaged"));
  EXPECT_THAT(refusal(write("a.csv.gz", packed + gzipped("6,7\n"))),
              HasSubstr("more than one gzip stream"));
  EXPECT_THAT(refusal(write("a.csv.gz", content)), HasSubstr("not a gzip file"));
  EXPECT_THAT(refusal(write("a.csv", packed)), HasSubstr(".gz"));
  EXPECT_THAT(read_table(write("a.json.gz", gzipped(R"([{"x": 1}, {"x": 2}])"))).columns[0].numbers,
              ElementsAre(1, 2));
}

TEST_F(TextFileTest, WhatIsNoFile) {
  EXPECT_THAT(refusal("/dev/zero"), HasSubstr("a pipe or a device"));
  const auto pipe = folder() / "pipe.csv";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(refusal(pipe), HasSubstr("a pipe or a device"));
  EXPECT_THAT(refusal(write("a.docx", "x")), HasSubstr("its extension is unknown"));
  EXPECT_THAT(refusal(write("a.xls", "x")),
              HasSubstr(".xls is not supported; save it as .xlsx or .csv"));
  EXPECT_THAT(refusal(write("bad.parquet", "no parquet at all")),
              AllOf(HasSubstr("bad.parquet: "), Not(HasSubstr("/proc/self"))));
  EXPECT_THAT(refusal(write("bad.json", "[{\"x\": 1}, {\"x\"")), HasSubstr("bad.json: "));
}

}  // namespace
}  // namespace wearwell
