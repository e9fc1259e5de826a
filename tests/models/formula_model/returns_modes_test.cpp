// Returns triangles by failure mode: likelihood and forecast against integrals by R (tests/golden/warranty_modes.R), other
// layouts of the same returns, unknown modes, messages.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "support/messages.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/models/formula_model/returns_report.h"

namespace wearwell::formula_model {
namespace {

using testing::HasSubstr;

constexpr double seconds_of_month = 3.15569259747e7 / 12;  // of UDUNITS

std::string modes_content(const std::string& file) {
  std::ifstream in(PROJECT_SOURCE_DIR "/" + file);
  return {std::istreambuf_iterator<char>(in), {}};
}

// A study of modes "seal" and "bearing".
std::string modes_study(const std::string& returns, const std::string& predict = "") {
  return fmt::format(
      "model = \"formula\"\n[data]\nfile = \"d.csv\"\n[data.returns]\n{}\n[failure_modes]\n"
      "column = \"mode\"\n[likelihood.life]\nfamily = \"weibull\"\nscale = \"eta[mode]\"\n"
      "shape = \"beta[mode]\"\n[prior]\n"
      "eta = {{ distribution = \"lognormal\", median = \"100 month\", log_sd = 2 }}\n"
      "beta = {{ distribution = \"lognormal\", median = 1.2, log_sd = 0.5 }}\n[predict]\n{}\n",
      returns, predict);
}

const std::string by_columns = "sold = \"sold\"\nquantity = \"shipped\"\nmode = \"mode\"\n";

class ReturnsModesTest : public ScratchTest {
 protected:
  struct Read {
    TomlReader root;
    Source source;
    std::shared_ptr<const FormulaModel> model;
  };
  Read read(const std::string& table, const std::string& text) {
    write("d.csv", table);
    const Source source = source_of(write("study.toml", text));
    TomlReader root = TomlReader::parse(source.study);
    auto model = read_formula_model(root, source);
    return {std::move(root), source, std::move(model)};
  }
  std::string refusal(const std::string& table, const std::string& text) {
    return message_of<InputError>([&] {
      const Read all = read(table, text);
      read_asked_returns(all.root, all.source, all.model);
    });
  }

  // Scales in months and shapes, by mode.
  static std::vector<double> point(const FormulaModel& model, double eta_seal, double beta_seal,
                                   double eta_bearing, double beta_bearing) {
    std::vector<double> x;
    for (const auto& each : model.parameters) {
      const bool seal = each.name.find("seal") != std::string::npos;
      x.push_back(each.name.starts_with("eta") ? seconds_of_month * (seal ? eta_seal : eta_bearing)
                                               : (seal ? beta_seal : beta_bearing));
    }
    return x;
  }
  static double log_likelihood(const Read& all, const std::vector<double>& x,
                               std::span<double> gradient = {}) {
    const auto density = formula_likelihood(
        std::make_shared<const FormulaRows>(all.model, all.model->data.table.rows));
    return gradient.empty() ? density->value(x) : density->value_and_gradient(x, gradient);
  }
};

ReturnsResult modes_forecast(const AskedReturns& asked, const std::vector<double>& x) {
  WeightedDraws draws;
  draws.values = Points(1, static_cast<Eigen::Index>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) draws.values(0, static_cast<Eigen::Index>(i)) = x[i];
  draws.weights = Eigen::VectorXd::Ones(1);
  return returns_result(asked, draws, {.sales = true, .modes = true});
}

// The maximum of R's multinomial likelihood, its value there, and the expected returns of each mode.
TEST_F(ReturnsModesTest, AgreeWithIntegralsByR) {
  const Read all = read(modes_content("examples/warranty/modes.csv"),
                        modes_study(by_columns, "next = \"6 month\"\n"));
  const std::vector<double> x =
      point(*all.model, 340.774965752, 0.851322402, 64.917396523, 2.050492144);
  std::vector<double> gradient(x.size());
  EXPECT_NEAR(log_likelihood(all, x, gradient), -3030.949321149, 1e-6);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(gradient[i] * x[i], 0, 0.02) << i;

  const AskedReturns asked = read_asked_returns(all.root, all.source, all.model);
  ASSERT_EQ(asked.modes, (std::vector<std::string>{"seal", "bearing"}));
  const ReturnsResult result = modes_forecast(asked, x);
  const std::vector<ReturnsByMode>& next = result.forecast.front().by_mode;
  EXPECT_NEAR(next[0].number.expected, 29.4189723, 1e-5);
  EXPECT_NEAR(next[1].number.expected, 27.6725665, 1e-5);
  const std::vector<ReturnsByMode>& half_year = result.forecast.back().by_mode;
  EXPECT_NEAR(half_year[0].until.expected, 163.947295, 1e-4);
  EXPECT_NEAR(half_year[1].until.expected, 206.331797, 1e-4);
  // Modes add up, and each number is binomial given the parameters.
  for (const ReturnsPeriod& each : result.forecast)
    EXPECT_NEAR(each.by_mode[0].number.expected + each.by_mode[1].number.expected,
                each.number.expected, 1e-9);
  EXPECT_LT(next[0].number.sd, std::sqrt(next[0].number.expected));
  EXPECT_GT(next[0].number.sd, 0.99 * std::sqrt(next[0].number.expected));
  EXPECT_NEAR(next[0].number.count_low, 21, 1);  // qpois(0.05, 29.4)
  EXPECT_NEAR(next[0].number.count_high, 39, 1);
  // What came back, by mode.
  int seal = 0, all_returns = 0;
  for (const ReturnsPeriod& each : result.fitted) {
    seal += each.by_mode[0].observed;
    all_returns += *each.observed;
    EXPECT_EQ(each.by_mode[0].observed + each.by_mode[1].observed, *each.observed);
    EXPECT_NEAR(each.by_mode[0].number.expected + each.by_mode[1].number.expected,
                each.number.expected, 1e-9);
  }
  EXPECT_GT(seal, 100);
  EXPECT_LT(seal, all_returns);
}

// A multinomial by hand: two months of exponential lives.
TEST_F(ReturnsModesTest, ExponentialLivesInClosedForm) {
  const Read all = read("sold,mode,units,1,2\n1,seal,100,3,4\n1,bearing,100,1,2\n2,seal,50,,1\n",
                        modes_study("quantity = \"units\"\nmode = \"mode\"\nperiod = \"month\"\n",
                                    "next = \"2 month\"\n"));
  const std::vector<double> x = point(*all.model, 40, 1, 25, 1);
  const double a = 1.0 / 40, b = 1.0 / 25, h = a + b;
  const auto fails = [&](double rate, double from, double to) {
    return rate / h * (std::exp(-h * from) - std::exp(-h * to));
  };
  const double expected = 4 * std::log(fails(a, 0, 0.5)) + 4 * std::log(fails(a, 0.5, 1.5)) +
                          1 * std::log(fails(b, 0, 0.5)) + 2 * std::log(fails(b, 0.5, 1.5)) -
                          90 * 1.5 * h - 49 * 0.5 * h;
  EXPECT_NEAR(log_likelihood(all, x), expected, 1e-8);
  const ReturnsResult result =
      modes_forecast(read_asked_returns(all.root, all.source, all.model), x);
  const double left = 90 + 49;  // lives are memoryless
  EXPECT_NEAR(result.forecast[0].by_mode[1].number.expected, left * fails(b, 0, 1), 1e-5);
  EXPECT_NEAR(result.forecast[1].by_mode[0].until.expected, left * fails(a, 0, 2), 1e-5);
}

// A quantity may stand in one row of its month; rows may be in any order; single units count to the same triangle.
TEST_F(ReturnsModesTest, OtherLayoutsAreTheSameData) {
  const std::string returns = "quantity = \"units\"\nmode = \"mode\"\nperiod = \"month\"\n";
  const Read first = read("sold,mode,units,1,2\n1,seal,4,1,1\n1,bearing,4,0,1\n2,seal,3,,1\n",
                          modes_study(returns));
  const std::vector<double> x = point(*first.model, 40, 1.3, 25, 0.8);
  const double expected = log_likelihood(first, x);
  const Read second = read("mode,sold,units,1,2\nseal,2,3,,1\nbearing,1,4,0,1\nseal,1,,1,1\n",
                           modes_study(returns));
  EXPECT_NEAR(log_likelihood(second, point(*second.model, 40, 1.3, 25, 0.8)), expected, 1e-12);
  const Read units = read(
      "sold,back,cause\n1,1,seal\n1,2,seal\n1,2,bearing\n1,,\n2,2,seal\n2,,running\n2,,\n",
      modes_study("sold = \"sold\"\nreturned = \"back\"\nmode = \"cause\"\nuntil = 2\nperiod = "
                  "\"month\"\n"));
  EXPECT_NEAR(log_likelihood(units, point(*units.model, 40, 1.3, 25, 0.8)), expected, 1e-12);
}

// A return of unknown mode has the probability of a return, and stands in no row of a mode.
TEST_F(ReturnsModesTest, UnknownModes) {
  const std::string returns = "quantity = \"units\"\nmode = \"mode\"\nperiod = \"month\"\n";
  const Read all =
      read("sold,mode,units,1,2\n1,seal,9,1,0\n1,bearing,9,0,1\n1,,9,0,2\n1,seal|bearing,9,1,0\n",
           modes_study(returns + "hold_out = \"1 month\"\n"));
  const std::vector<double> x = point(*all.model, 40, 1, 25, 1);
  const double a = 1.0 / 40, b = 1.0 / 25, h = a + b;
  const double expected =
      std::log(a / h * -std::expm1(-0.5 * h)) + std::log(-std::expm1(-0.5 * h)) - 7 * 0.5 * h;
  // The mode bearing is known from the cell 'seal|bearing' only.
  EXPECT_NEAR(log_likelihood(all, x), expected, 1e-8);
  const ReturnsResult result =
      modes_forecast(read_asked_returns(all.root, all.source, all.model), x);
  EXPECT_EQ(result.fitted[0].masked, 1);
  EXPECT_EQ(result.fitted[0].by_mode[0].observed, 1);
  EXPECT_EQ(result.forecast[0].masked, 2);
  EXPECT_EQ(result.forecast[0].by_mode[1].observed, 1);
}

// A mode that came back in the held-out month only has no life: it is named, and is not of unknown mode.
TEST_F(ReturnsModesTest, ModesOfHeldOutMonthsAreNamed) {
  const std::string returns =
      "quantity = \"units\"\nmode = \"code\"\nperiod = \"month\"\nhold_out = \"1 month\"\n";
  const Read all = read(
      "sold,code,units,1,2,3\n1,seal|seal,90,3,4,2\n1,bearing,90,1,2,1\n1,motor,90,0,0,5\n1,,90,1,"
      "0,3\n",
      modes_study(returns));
  const AskedReturns asked = read_asked_returns(all.root, all.source, all.model);
  EXPECT_EQ(asked.modes, (std::vector<std::string>{"seal", "bearing"}));
  const std::vector<double> x = point(*all.model, 40, 1, 25, 1);
  const ReturnsResult result = modes_forecast(asked, x);
  EXPECT_EQ(result.forecast[0].unfitted, (std::map<std::string, int>{{"motor", 5}}));
  EXPECT_EQ(result.forecast[0].masked, 3);
  EXPECT_EQ(result.forecast[0].by_mode[0].observed, 2);
  EXPECT_EQ(result.fitted[0].masked, 1);
  EXPECT_EQ(result.fitted[0].by_mode[0].observed, 3);  // 'seal|seal' is a seal
  EXPECT_THAT(modes_remarks(asked, result),
              testing::ElementsAre(
                  HasSubstr("Of 11 returns in the fitted months (until 2), 1 is of unknown mode"),
                  HasSubstr("Of 11 returns in the held-out months, 3 are of unknown mode"),
                  HasSubstr("Held out: 5 returns by 'motor', which has no return in the fitted "
                            "months (until 2)")));
  const present::Table table = modes_forecast_table(asked, result);
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(std::get<std::string>(table.rows[2][1]), "motor");
  EXPECT_EQ(table.rows[2].size(), table.columns.size());
  EXPECT_EQ(std::get<double>(table.rows[2].back()), 5);
}

// In summary.json all returns of a period are those of its modes, of unknown mode and of modes that are not fitted.
TEST_F(ReturnsModesTest, ReturnsOfAPeriodAddUpInJson) {
  const Read all = read(
      "sold,code,units,1,2\n1,seal,90,3,4\n1,bearing,90,1,2\n1,motor,90,0,2\n1,?,90,1,1\n"
      "1,seal|bearing,90,2,0\n",
      modes_study("quantity = \"units\"\nmode = \"code\"\nperiod = \"month\"\n"
                  "hold_out = \"1 month\"\n",
                  "next = \"2 month\"\n"));
  const AskedReturns asked = read_asked_returns(all.root, all.source, all.model);
  WeightedDraws draws;
  const std::vector<double> x = point(*all.model, 40, 1, 25, 1);
  draws.values = Eigen::Map<const Eigen::RowVectorXd>(x.data(), 4);
  draws.weights = Eigen::VectorXd::Ones(1);
  const PresetAddition added = returns_addition(asked, draws);
  const auto& json = added.body.at("returns");
  for (const auto& each : {json["fitted"][0], json["forecast"][0]}) {
    int sum = each["unknown_mode"];
    for (const auto& mode : each["modes"]) sum += mode["observed"].get<int>();
    if (each.contains("unfitted_modes"))
      for (const auto& mode : each["unfitted_modes"]) sum += mode["observed"].get<int>();
    EXPECT_EQ(sum, each["observed"].get<int>()) << each;
  }
  EXPECT_EQ(json["fitted"][0]["unknown_mode"], 3);
  EXPECT_EQ(json["forecast"][0]["unknown_mode"], 1);
  EXPECT_EQ(json["forecast"][0]["unfitted_modes"][0]["mode"], "motor");
  EXPECT_FALSE(json["forecast"][1].contains("unknown_mode"));  // still to come
  EXPECT_THAT(added.text, HasSubstr("3 are of unknown mode"));
}

// Messages about modes name the cell of the file, in a triangle and in a table of single units.
TEST_F(ReturnsModesTest, MessagesNameTheCellOfTheFile) {
  const std::string triangle =
      "quantity = \"units\"\nmode = \"failure code\"\nperiod = \"month\"\n";
  EXPECT_THAT(refusal("sold,failure code,units,1,2\n1,seal,9,1,1\n1,bearing,9,1,1\n1,motor,9,0,0\n"
                      "2,failed,9,,1\n",
                      modes_study(triangle)),
              HasSubstr("d.csv, row 4, column 'failure code': 'failed' can mean"));
  const std::string units =
      "sold = \"sold\"\nreturned = \"back\"\nmode = \"cause\"\nuntil = 2\nperiod = \"month\"\n";
  EXPECT_THAT(refusal("sold,back,cause\n1,1,seal\n1,2,seal\n1,1,bearing\n1,,\n2,,\n2,2,failed\n",
                      modes_study(units)),
              HasSubstr("d.csv, row 6, column 'cause': 'failed' can mean"));
  EXPECT_THAT(refusal("sold,back,cause\n1,1,seal\n1,2,bearing|\n", modes_study(units)),
              HasSubstr("d.csv, row 2, column 'cause': 'bearing|' has an empty failure mode"));
}

// Which units failed is settled before: a word of one letter is a mode like any other.
TEST_F(ReturnsModesTest, EachWordOfATriangleIsAMode) {
  const std::string returns = "quantity = \"units\"\nmode = \"mode\"\nperiod = \"month\"\n";
  const std::string rows = "sold,mode,units,1,2\n1,S,9,1,1\n1,0,9,0,1\n1,C,9,1,0\n";
  const Read all = read(rows, modes_study(returns));
  EXPECT_EQ(all.model->modes->modes, (std::vector<std::string>{"S", "C", "0"}));
  std::string text = modes_study(returns);
  text.replace(text.find("column = \"mode\""), 15, "column = \"mode\"\nrunout = \"S\"");
  EXPECT_THAT(refusal(rows, text),
              HasSubstr("failure_modes.runout: does not go with a returns triangle: its rows count "
                        "returns, so each word of column 'mode' is a failure mode"));
  // A word of the study for an unknown mode; of single units also one for those that did not come back.
  text = modes_study(returns);
  text.replace(text.find("column = \"mode\""), 15, "column = \"mode\"\nunknown = \"open\"");
  const Read open = read("sold,mode,units,1,2\n1,S,9,1,1\n1,B,9,0,1\n1,open,9,1,0\n", text);
  EXPECT_EQ(open.model->modes->modes, (std::vector<std::string>{"S", "B"}));
  EXPECT_EQ(open.model->joint.size(), 4u);
  text = modes_study(
      "sold = \"sold\"\nreturned = \"back\"\nmode = \"cause\"\nuntil = 2\nperiod = \"month\"\n");
  text.replace(text.find("column = \"mode\""), 15, "column = \"mode\"\nrunout = \"fine\"");
  EXPECT_EQ(read("sold,back,cause\n1,1,S\n1,2,B\n1,,fine\n", text).model->modes->modes,
            (std::vector<std::string>{"S", "B"}));
  EXPECT_THAT(refusal("sold,back,cause\n1,1,S\n1,2,fine\n", text),
              HasSubstr("'fine' is a run-out, but column 'back' has a return, '2'"));
}

// A mode whose cells are all zero has no life; neither its row nor its table goes without a remark.
TEST_F(ReturnsModesTest, ModesWithoutAReturn) {
  const std::string returns = "quantity = \"units\"\nmode = \"mode\"\nperiod = \"month\"\n";
  const std::string rows = "sold,mode,units,1,2\n1,seal,9,1,1\n1,bearing,9,0,1\n1,motor,9,0,0\n";
  const Read all = read(rows, modes_study(returns));
  EXPECT_EQ(all.model->modes->modes.size(), 2u);
  EXPECT_THAT(notes_of_returns(*read_field_returns(all.root, all.source)),
              testing::Contains(HasSubstr("failure mode 'motor' has no return in the fitted months "
                                          "(until 2): it has no life in the fit")));
  const std::string table =
      "[failure_modes.motor]\nfamily = \"exponential\"\nmean = \"100 month\"\n[likelihood.life]";
  std::string text = modes_study(returns);
  text.replace(text.find("[likelihood.life]"), 17, table);
  EXPECT_THAT(refusal(rows, text), HasSubstr("failure_modes.motor: this failure mode has no return "
                                             "in the fitted months (until 2); remove its table"));
  // Of single units, one that came back after the end of the table.
  text = modes_study(
      "sold = \"sold\"\nreturned = \"back\"\nmode = \"cause\"\nuntil = 2\nperiod = \"month\"\n");
  text.replace(text.find("[likelihood.life]"), 17, table);
  EXPECT_THAT(refusal("sold,back,cause\n1,1,seal\n1,2,bearing\n1,3,motor\n", text),
              HasSubstr("failure_modes.motor: this failure mode has no return in the fitted"));
}

TEST_F(ReturnsModesTest, Refusals) {
  const std::string returns = "quantity = \"units\"\nmode = \"mode\"\nperiod = \"month\"\n";
  const auto of = [&](const std::string& rows) {
    return refusal("sold,mode,units,1,2\n" + rows, modes_study(returns));
  };
  EXPECT_THAT(of("1,seal,4,1,1\n1,seal,4,0,1\n1,bearing,4,1,0\n"),
              HasSubstr("row 2, column 'mode': 'seal': the same period of sale and failure mode as "
                        "in row 1; add them up"));
  EXPECT_THAT(of("1,seal,4,1,1\n1,bearing,5,0,1\n"),
              HasSubstr("row 2, column 'units': 5 units sold, but 4 in row 1 of the same period"));
  EXPECT_THAT(of("1,seal,4,2,1\n1,bearing,4,2,0\n"), HasSubstr("5 of the 4 units sold"));
  EXPECT_THAT(of("1,seal,4,1,1\n1,censored,4,1,0\n"),
              HasSubstr("row 2, column 'mode': 'censored' is a run-out, but the row has returns"));
  // A word with two readings is named with its row of the triangle.
  EXPECT_THAT(of("1,seal,9,1,1\n1,bearing,9,1,1\n1,failed,9,1,0\n"),
              HasSubstr("row 3, column 'mode': 'failed' can mean a failure of unknown mode"));
  EXPECT_THAT(refusal("sold,units,1,2\n1,4,1,1\n1,4,0,1\n",
                      "model = \"formula\"\n[data]\nfile = \"d.csv\"\n[data.returns]\nperiod = "
                      "\"month\"\n[likelihood.life]\nfamily = \"weibull\"\nscale = 1\nshape = 1\n"),
              HasSubstr("add them up, or name the column of failure modes: [data.returns] mode"));
  std::string text = modes_study("quantity = \"units\"\nperiod = \"month\"\n");
  EXPECT_THAT(refusal("sold,units,1,2\n1,4,1,1\n", text),
              HasSubstr("failure_modes.column: needs [data.returns] mode"));
  text = modes_study(returns +
                     "delay_to_use = { distribution = \"exponential\", mean = \"1 month\" }\n");
  EXPECT_THAT(refusal("sold,mode,units,1,2\n1,seal,4,1,1\n1,bearing,4,0,1\n", text),
              HasSubstr("is not possible with delays that vary"));
  const std::string units =
      "sold = \"sold\"\nreturned = \"back\"\nmode = \"cause\"\nuntil = 2\nperiod = \"month\"\n";
  EXPECT_THAT(refusal("sold,back,cause\n1,1,seal\n1,,bearing\n", modes_study(units)),
              HasSubstr("row 2, column 'cause': 'bearing' is a failure mode, but column 'back' has "
                        "no return"));
  EXPECT_THAT(refusal("sold,back,cause\n1,1,seal\n1,2,running\n", modes_study(units)),
              HasSubstr("'running' is a run-out, but column 'back' has a return, '2'"));
}

}  // namespace
}  // namespace wearwell::formula_model
