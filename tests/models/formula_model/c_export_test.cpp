// Units as C99: compiled by the machine's compiler without a warning, and held against the tracker's own numbers.
#include "wearwell/models/formula_model/c_export.h"

#include <gmock/gmock.h>

#include <fstream>

#include "models/formula_model/watched.h"
#include "support/run_command.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"

namespace wearwell::formula_model {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string strict =
    "cc -std=c99 -pedantic -Wall -Wextra -Wshadow -Wstrict-prototypes -Werror ";

std::vector<Column> rows_of(double scale, bool lognormal = false) {
  std::vector<double> depth, time;
  std::vector<std::string> unit;
  Rng rng(5, 0);
  for (int u = 0; u < 4; ++u) {
    const double rate = std::exp(0.3 * rng.normal());
    for (int i = 1; i <= 5; ++i) {
      time.push_back(i);
      const double wear = rate * i;
      depth.push_back(
          scale * (lognormal ? wear * std::exp(0.1 * rng.normal()) : wear + 0.2 * rng.normal()));
      unit.push_back("u" + std::to_string(u));
    }
  }
  return {numbers("depth", depth), numbers("time", time), texts("unit", unit)};
}

// A few points as they may come of a fit: median rate, error, scatter, in the order of the study's priors.
WeightedDraws some(std::size_t parameters, const std::vector<double>& middle) {
  std::vector<std::vector<double>> x;
  Rng rng(9, 0);
  for (int i = 0; i < 40; ++i) {
    std::vector<double> one;
    for (std::size_t p = 0; p < parameters; ++p)
      one.push_back(middle[p] * std::exp(0.15 * rng.normal()));
    x.push_back(one);
  }
  return points(x);
}

prognosis::CarriedState state_of(const FormulaDesign& design, const WeightedDraws& posterior) {
  prognosis::CarriedState state;
  state.model = "formula";
  state.source = design.source;
  for (const Parameter& each : design.model->parameters) state.parameters.push_back(each.name);
  state.posterior = posterior;
  return state;
}

std::vector<double> middles(const FormulaDesign& design) {
  std::vector<double> middle;
  for (const Parameter& each : design.model->parameters) {
    const std::string& name = each.name;
    middle.push_back(name == "b" ? um / h : name == "sigma" ? 0.25 * um : 0.3);
  }
  return middle;
}

class CExported : public ScratchTest {
 protected:
  // Compiles it and its test, strictly, and runs that.
  void expect_same_numbers(const CExport& made, const std::string& name = "unit") {
    write(name + "_unit.h", made.header);
    write(name + "_unit.c", made.source);
    write(name + "_test.c", made.test);
    const std::string in = "cd " + folder().string() + " && ";
    const CommandResult built =
        run_command(in + strict + "-O1 -c " + name + "_unit.c && " + strict + "-O1 " + name +
                    "_test.c " + name + "_unit.o -lm -o run");
    ASSERT_EQ(built.exit_code, 0) << built.out << built.err;
    const CommandResult ran = run_command(in + "./run");
    EXPECT_EQ(ran.exit_code, 0) << ran.out;
    EXPECT_THAT(ran.out, HasSubstr("the same numbers"));
    // What memory was told is what it takes.
    EXPECT_THAT(ran.out, HasSubstr(std::to_string(made.unit_bytes) + " bytes a unit"));
    EXPECT_THAT(ran.out, HasSubstr(std::to_string(made.scratch_bytes) + " bytes of scratch"));
    const CommandResult symbols = run_command(in + "nm " + name + "_unit.o");
    for (const char* word : {"malloc", "calloc", "realloc", "free", " B ", " b ", " D ", " d "})
      EXPECT_THAT(symbols.out, Not(HasSubstr(word))) << word;
  }

  static std::string refusal(const std::string& study, const std::vector<Column>& columns,
                             const CExportChoice& choice = {}) {
    const FormulaDesign design(study, columns);
    return message_of<InputError>([&] {
      c_export(state_of(design, some(design.model->parameters.size(), middles(design))), choice,
               "1");
    });
  }
};

TEST_F(CExported, AStraightLawHasTheTrackersNumbers) {
  const FormulaDesign design(straight, rows_of(1));
  expect_same_numbers(c_export(state_of(design, some(3, middles(design))), {}, "1"));
}

TEST_F(CExported, AUnitOfTheStudyGoesOnFromWhatItShowed) {
  const FormulaDesign design(straight, rows_of(1));
  const CExportChoice choice{"pump", "u2", 64};
  const CExport made = c_export(state_of(design, some(3, middles(design))), choice, "1");
  EXPECT_THAT(made.header, HasSubstr("PUMP_NODES"));
  EXPECT_THAT(made.header, Not(HasSubstr("EDGE")));
  expect_same_numbers(made, "pump");
}

TEST_F(CExported, ALawWithPowersAndALognormalScatter) {
  std::string study = straight;
  const auto put = [&](const std::string& from, const std::string& to) {
    study.replace(study.find(from), from.size(), to);
  };
  put("wear = \"b * time\"",
      "wear = \"b * where(time < 2 [h], time, 2 [h] * (time / 2 [h])^0.8)\"");
  put("family = \"normal\"\nmean = \"wear\"\nsd = \"sigma\"",
      "family = \"lognormal\"\nmedian = \"wear\"\nlog_sd = \"sigma\"");
  put("scale = \"0.5 um\"", "scale = 0.5");
  const FormulaDesign design(study, rows_of(1, true));
  std::vector<double> middle = middles(design);
  for (std::size_t p = 0; p < middle.size(); ++p)
    if (design.model->parameters[p].name == "sigma") middle[p] = 0.1;
  expect_same_numbers(c_export(state_of(design, some(3, middle)), {}, "1"));
}

TEST_F(CExported, RefusesWhatHasNoC) {
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = straight;
    return changed.replace(changed.find(from), from.size(), to);
  };
  EXPECT_THAT(refusal(with("family = \"normal\"\nmean = \"wear\"\nsd = \"sigma\"",
                           "family = \"gamma-process\"\nmean = \"wear\"\nscale = \"sigma\""),
                      rows_of(1)),
              HasSubstr("random increments"));
  EXPECT_THAT(refusal(with("wear = \"b * time\"", "\"d(wear)/d(time)\" = \"b\""), rows_of(1)),
              HasSubstr("depends on earlier rows"));
  EXPECT_THAT(refusal(with("family = \"normal\"\nmean = \"wear\"\nsd = \"sigma\"",
                           "family = \"largest-extreme-value\"\nlocation = \"wear\"\nscale = "
                           "\"sigma\""),
                      rows_of(1)),
              HasSubstr("largest-extreme-value family; C export supports"));
  EXPECT_THAT(refusal(straight, rows_of(1), {"unit", "u9", 0}), HasSubstr("no unit 'u9'"));
  EXPECT_THAT(refusal(straight, rows_of(1), {"1st", "", 0}), HasSubstr("not a valid C name"));
}

}  // namespace
}  // namespace wearwell::formula_model
