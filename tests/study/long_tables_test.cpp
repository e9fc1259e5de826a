#include "wearwell/study/long_tables.h"

#include <gmock/gmock.h>

#include <cmath>

#include "study/sample.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/study/json.h"

namespace wearwell {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

PosteriorSummary long_result(std::size_t rows) {
  PosteriorSummary result = sample_result();
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
  const PosteriorSummary result = long_result(most_rows_inline + 1);
  const auto tables = long_tables(result);
  ASSERT_THAT(tables, SizeIs(3));
  for (const auto& [name, content] : tables) write(name, content);
  const auto json = posterior_json(result);
  EXPECT_EQ(json["loo"]["table"], "loo.csv");
  EXPECT_EQ(json["coverage"]["table"], "coverage.csv");
  EXPECT_EQ(json["pointwise"]["table"], "pointwise.csv");
  EXPECT_LT(json.dump().size(), 10'000u);

  write("summary.json", summary_json(posterior_result(result)).dump());
  for (const auto& [name, content] : posterior_result(result).files) write(name, content);
  const LooSummary read = *read_saved_result(folder()).loo;
  EXPECT_EQ(read.loo.elpd(), result.loo->loo.elpd());
  EXPECT_EQ(read.loo.p_loo(), result.loo->loo.p_loo());
  EXPECT_EQ(read.loo.terms[1].khat, INFINITY);
  EXPECT_TRUE(read.loo.terms[5].refitted);
  EXPECT_THAT(tables[1].second, HasSubstr("3,\"type \"\"A\"\", #2\nnew\",failure"));
}

TEST_F(LongTables, ShortOnesStayInTheSummary) {
  const PosteriorSummary result = long_result(most_rows_inline);
  EXPECT_THAT(long_tables(result), SizeIs(0));
  const auto json = posterior_json(result);
  EXPECT_THAT(json["loo"]["pointwise"], SizeIs(most_rows_inline));
  EXPECT_THAT(json["coverage"]["rows"], SizeIs(most_rows_inline));
  EXPECT_THAT(json["pointwise"]["rows"], SizeIs(most_rows_inline));
}

TEST_F(LongTables, NamesWhatIsMissing) {
  write("summary.json", summary_json(posterior_result(long_result(most_rows_inline + 1))).dump());
  EXPECT_THAT(message_of<InputError>([&] { read_saved_result(folder()); }),
              HasSubstr("loo.csv is missing"));
  write("loo.csv", "observation,elpd,lpd,khat,count,refitted,tail\n1,-1,-1,0,0,0,1\n");
  EXPECT_THAT(message_of<InputError>([&] { read_saved_result(folder()); }),
              HasSubstr("loo.csv, row 1, column 'count': should be 1 or more, and is '0'"));
}

}  // namespace
}  // namespace wearwell
