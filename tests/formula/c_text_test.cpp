// Expressions as C99: compiled, run, and held against what the program computes.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "formula/laboratory.h"
#include "support/run_command.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/formula/c_text.h"

namespace wearwell::formula {
namespace {

const std::vector<std::string> expressions = {
    "a + b * x - y / 3",
    "-(a - -b) * -x",
    "exp(a * x) + log(x) + log10(x) + sqrt(x) + abs(y)",
    "x^2 + x^-3 + y^7 + x^b + 2^y + b^a",
    "erf(y) + tanh(y) + sin(phi) * cos(phi) + log1p(x) + expm1(y)",
    "erfc(y) + gamma(x) + lgamma(x) + weibull_cdf(x, b, a) + lognormal_pdf(x, b, a)",
    "birnbaum_saunders_cdf(x, b, a) + exponentiated_weibull_pdf(x, b, a, 1.4) + frechet_cdf(x, b, "
    "a)",
    "min(x, y) + max(a, y) + min(x, 2)",
    "where(x < 2, a, b) + where(x <= 2 and not (y == 4), 1, 0) + where(x != 2 or y > 1, 3, 4)",
    "where(material == \"PEEK\", q[material], a) + q[\"PTFE\"]",
    "u * x + exp(0.1 * u)",
    "k * force * distance / area",
    "where(y > 0, x, 0 - x)^2",
    "1 / 3",
};

class CText : public ScratchTest {};

TEST_F(CText, ComputesWhatTheProgramDoes) {
  const Laboratory laboratory;
  const Program program = laboratory.program(expressions);
  const Rows rows = laboratory.rows();
  std::ostringstream source;
  source.precision(17);
  std::string functions;
  for (std::size_t o = 0; o < expressions.size(); ++o)
    functions += c_function(laboratory.lines, {"output", expressions[o]}, laboratory.symbols,
                            "f" + std::to_string(o));
  source << "#include <math.h>\n#include <stdio.h>\n" << c_helpers(functions) << functions;
  source << "int main(void) {\n";
  for (std::size_t row = 0; row < rows.count; ++row) {
    source << "  {\n    const double number[] = {";
    for (const auto& column : laboratory.columns) source << c_number(column[row]) << ", ";
    source << "};\n    const int label[] = {";
    for (const auto& label : laboratory.labels) source << label[row] << ", ";
    source << "};\n    const double parameter[] = {";
    for (const double each : laboratory.parameters) source << c_number(each) << ", ";
    source << "};\n    const double effect[] = {" << c_number(laboratory.by_row[0][row]) << "};\n";
    for (std::size_t o = 0; o < expressions.size(); ++o)
      source << "    printf(\"%.17g\\n\", f" << o << "(number, label, parameter, effect));\n";
    source << "  }\n";
  }
  source << "  return 0;\n}\n";
  write("formula.c", source.str());
  const CommandResult ran =
      run_command("cd " + folder().string() +
                  " && cc -std=c99 -pedantic -Wall -Wextra -Werror -O1 formula.c "
                  "-lm -o formula && ./formula");
  ASSERT_EQ(ran.exit_code, 0) << ran.err << source.str();
  std::istringstream printed(ran.out);
  const Data data = program.bind(rows);
  Workspace workspace = program.workspace(rows.count);
  const double* by_row[] = {laboratory.by_row[0].data()};
  program.forward(data, 0, rows.count, {laboratory.parameters, by_row}, workspace);
  for (std::size_t row = 0; row < rows.count; ++row) {
    for (std::size_t o = 0; o < expressions.size(); ++o) {
      double got = 0;
      std::string word;
      printed >> word;
      got = std::stod(word);
      const auto values = workspace.values(o);
      const double wanted = values[values.size() == 1 ? 0 : row];
      if (std::isnan(wanted)) {
        EXPECT_TRUE(std::isnan(got)) << expressions[o] << " in row " << row;
      } else {
        EXPECT_NEAR(got, wanted, 1e-13 * std::abs(wanted)) << expressions[o] << " in row " << row;
      }
    }
  }
}

TEST_F(CText, RefusesPaths) {
  const Laboratory laboratory;
  EXPECT_THAT(message_of<InputError>([&] {
                c_function(laboratory.lines, {"output", "cum(x)"}, laboratory.symbols, "f");
              }),
              testing::HasSubstr("depends on previous rows"));
}

TEST_F(CText, RefusesFunctionsThatCLacks) {
  const Laboratory laboratory;
  const auto message = [&](const char* text) {
    return message_of<InputError>([&] {
      c_function(laboratory.lines, {"output", text}, laboratory.symbols, "f");
    });
  };
  EXPECT_THAT(message("gamma_cdf(x, a, b)"),
              testing::HasSubstr("uses standard_gamma_cdf, which C does not have"));
  EXPECT_THAT(message("student_t_quantile(0.1*a, a, x, b)"),
              testing::HasSubstr("uses standard_student_t_quantile, which C does not have"));
}

TEST(CNumber, ReadsBackToTheSame) {
  for (const double x : {0.1, 1e300, 5e-324, 3.0, -0.0, 1.0 / 3, -2.5e-7}) {
    std::string text = c_number(x);
    if (text.front() == '(') text = text.substr(1, text.size() - 2);
    EXPECT_EQ(std::strtod(text.c_str(), nullptr), x) << text;
    EXPECT_NE(text.find_first_of(".e"), std::string::npos) << text;
  }
  EXPECT_EQ(c_number(HUGE_VAL), "INFINITY");
}

}  // namespace
}  // namespace wearwell::formula
