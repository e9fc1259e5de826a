#include "wearwell/report/long_tables.h"

#include <gmock/gmock.h>

#include <cmath>

#include "report/sample.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/report/json.h"
#include "wearwell/report/read_summary.h"

namespace wearwell {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

StudyResult long_result(std::size_t rows) {
  StudyResult result = sample_result();
  result.loo->loo.terms.clear();
  result.pointwise->rows.clear();
  result.coverage = CoverageTable{"cycles", {}};
  for (std::size_t i = 0; i < rows; ++i) {
    const auto x = static_cast<double>(i);
    result.loo->loo.terms.push_back(
        {-1.0 / (x + 3), -0.5, i == 1 ? INFINITY : x / 7, 1 + int(i % 3), i % 5 == 0});
    result.pointwise->rows.push_back({x, 1 / (x + 1), 2, 3, 4e-300});
    result.coverage->rows.push_back({i + 1,
                                     i == 2 ? "type \"A\", #2\nnew" : "B",
                                     "failure",
                                     x + 1,
                                     {},
                                     0.25,
                                     1e-3,
                                     INFINITY,
                                     2});
    if (i % 2 == 0) result.coverage->rows.back().until = x + 2;
  }
  return result;
}

class LongTables : public ScratchTest {};

TEST_F(LongTables, StandBesideTheSummaryAndLoseNoBit) {
  const StudyResult result = long_result(most_rows_inline + 1);
  const auto tables = long_tables(result);
  ASSERT_THAT(tables, SizeIs(3));
  for (const auto& [name, content] : tables) write(name, content);
  const auto json = to_json(result);
  EXPECT_EQ(json["loo"]["table"], "loo.csv");
  EXPECT_EQ(json["coverage"]["table"], "coverage.csv");
  EXPECT_EQ(json["pointwise"]["table"], "pointwise.csv");
  EXPECT_LT(json.dump().size(), 10'000u);

  const StudyResult read = read_summary(JsonReader(json, "summary.json"), folder());
  EXPECT_EQ(to_json(read).dump(), json.dump());
  EXPECT_EQ(long_tables(read), tables);
  EXPECT_EQ(read.coverage->rows[2].label, "type \"A\", #2\nnew");
  EXPECT_EQ(read.loo->loo.terms[1].khat, INFINITY);
}

TEST_F(LongTables, ShortOnesStayInTheSummary) {
  const StudyResult result = long_result(most_rows_inline);
  EXPECT_THAT(long_tables(result), SizeIs(0));
  const auto json = to_json(result);
  EXPECT_THAT(json["loo"]["pointwise"], SizeIs(most_rows_inline));
  EXPECT_THAT(json["coverage"]["rows"], SizeIs(most_rows_inline));
  EXPECT_THAT(json["pointwise"]["rows"], SizeIs(most_rows_inline));
}

TEST_F(LongTables, NamesWhatIsMissing) {
  const auto json = to_json(long_result(most_rows_inline + 1));
  EXPECT_THAT(
      message_of<InputError>([&] { read_summary(JsonReader(json, "summary.json"), folder()); }),
      HasSubstr("loo.csv is missing"));
  write("loo.csv", "observation,elpd,lpd,khat,count,refitted,tail\n1,-1,-1,0,0,0,1\n");
  EXPECT_THAT(
      message_of<InputError>([&] { read_summary(JsonReader(json, "summary.json"), folder()); }),
      HasSubstr("loo.csv, row 1, column 'count': should be 1 or more, and is '0'"));
}

}  // namespace
}  // namespace wearwell
