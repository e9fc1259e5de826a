// Values and gradients of random expressions against ceres::Jet, and of what a program promises about rows.
#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <memory>

#include "formula/laboratory.h"
#include "wearwell/math/dual.h"

namespace wearwell::formula {
namespace {

using Jet = Dual<4>;  // by a, b, c and u

// An expression as a tree that writes itself and computes itself.
struct Tree {
  int kind = 0;
  double number = 0;
  std::vector<Tree> kids;
};

constexpr int leaves = 7, kinds = 22;

template <class T>
struct Values {
  T x, y, a, b, c, u;
};

template <class T>
T compute(const Tree& tree, const Values<T>& in) {
  using std::exp, std::log, std::sqrt, std::tanh;
  const auto kid = [&](std::size_t i) { return compute(tree.kids[i], in); };
  switch (tree.kind) {
    case 0:
      return in.x;
    case 1:
      return in.y;
    case 2:
      return in.a;
    case 3:
      return in.b;
    case 4:
      return in.c;
    case 5:
      return in.u;
    case 6:
      return T(tree.number);
    case 7:
      return kid(0) + kid(1);
    case 8:
      return kid(0) - kid(1);
    case 9:
      return kid(0) * kid(1);
    case 10: {
      const T below = kid(1);
      return kid(0) / (1.5 + below * below);
    }
    case 11:
      return -kid(0);
    case 12:
      return exp(tanh(kid(0)));
    case 13: {
      const T inner = kid(0);
      return log(1.25 + inner * inner);
    }
    case 14: {
      const T inner = kid(0);
      return sqrt(1.0 + inner * inner);
    }
    case 15: {
      const T left = kid(0), right = kid(1);
      return scalar(left) < scalar(right) ? left : right;
    }
    case 16: {
      const T left = kid(0), right = kid(1);
      return scalar(left) > scalar(right) ? left : right;
    }
    case 17:
      return scalar(kid(0)) < scalar(kid(1)) ? kid(2) : kid(1);
    case 18: {
      const T base = kid(0), exponent = tanh(kid(1));
      return exp(exponent * log(1.0 + base * base));
    }
    case 19: {
      const T inner = tanh(kid(0));
      return inner * inner * inner;
    }
    case 20: {
      const T inner = kid(0);
      const double at = scalar(inner);
      return chained(inner, std::erf(at), 2 / std::sqrt(M_PI) * std::exp(-at * at));
    }
    default: {
      const T inner = kid(0);
      const double at = scalar(inner);
      return chained(inner, std::atan(at), 1 / (1 + at * at));
    }
  }
}

std::string text_of(const Tree& tree) {
  const auto kid = [&](std::size_t i) { return text_of(tree.kids[i]); };
  static const char* names[] = {"x", "y", "a", "b", "c", "u"};
  switch (tree.kind) {
    case 0:
    case 1:
    case 2:
    case 3:
    case 4:
    case 5:
      return names[tree.kind];
    case 6:
      return fmt::format("{}", tree.number);
    case 7:
      return fmt::format("({} + {})", kid(0), kid(1));
    case 8:
      return fmt::format("({} - {})", kid(0), kid(1));
    case 9:
      return fmt::format("{} * {}", kid(0), kid(1));
    case 10:
      return fmt::format("{} / (1.5 + ({})^2)", kid(0), kid(1));
    case 11:
      return fmt::format("(-{})", kid(0));
    case 12:
      return fmt::format("exp(tanh({}))", kid(0));
    case 13:
      return fmt::format("log(1.25 + ({})^2)", kid(0));
    case 14:
      return fmt::format("sqrt(1 + ({})^2)", kid(0));
    case 15:
      return fmt::format("min({}, {})", kid(0), kid(1));
    case 16:
      return fmt::format("max({}, {})", kid(0), kid(1));
    case 17:
      return fmt::format("where({} < {}, {}, {})", kid(0), kid(1), kid(2), kid(1));
    case 18:
      return fmt::format("(1 + ({})^2)^tanh({})", kid(0), kid(1));
    case 19:
      return fmt::format("tanh({})^3", kid(0));
    case 20:
      return fmt::format("erf({})", kid(0));
    default:
      return fmt::format("atan({})/1 [rad]", kid(0));
  }
}

std::size_t arity(int kind) {
  if (kind < leaves) return 0;
  if (kind == 17) return 3;
  const bool two = kind <= 10 || kind == 15 || kind == 16 || kind == 18;
  return two ? 2 : 1;
}

Tree random_tree(int depth) {
  Tree tree;
  tree.kind = depth == 0 ? *rc::gen::inRange(0, leaves) : *rc::gen::inRange(0, kinds);
  if (tree.kind == 6) tree.number = 0.25 * *rc::gen::inRange(1, 12);
  for (std::size_t i = 0; i < arity(tree.kind); ++i) tree.kids.push_back(random_tree(depth - 1));
  return tree;
}

double random_number() {
  return 0.01 * *rc::gen::inRange(-200, 200);
}

RC_GTEST_PROP(Gradient, OfRandomExpressionsIsThatOfJets, ()) {
  Laboratory laboratory;
  for (auto* each : {&laboratory.columns[0], &laboratory.columns[1], &laboratory.by_row[0]})
    for (double& value : *each) value = random_number();
  for (std::size_t i = 0; i < 3; ++i) laboratory.parameters[i] = random_number();
  const std::vector<double> weight = {1, random_number(), random_number()};
  const Tree tree = random_tree(*rc::gen::inRange(1, 6));
  // A tree of one number leans on nothing; two leaves make it an expression of rows.
  const std::string text = text_of(tree) + " + 0*x*a";
  RC_LOG() << text << "\n";
  const auto values = laboratory.values(text);
  const auto slopes = laboratory.slopes(text, weight);
  double sum[3] = {};
  for (std::size_t r = 0; r < 3; ++r) {
    Values<Jet> in;
    in.x = Jet(laboratory.columns[0][r]);
    in.y = Jet(laboratory.columns[1][r]);
    in.a = Jet(laboratory.parameters[0], 0);
    in.b = Jet(laboratory.parameters[1], 1);
    in.c = Jet(laboratory.parameters[2], 2);
    in.u = Jet(laboratory.by_row[0][r], 3);
    const Jet wanted = compute(tree, in);
    RC_ASSERT(std::abs(values[r] - wanted.a) <= 1e-12 * (1 + std::abs(wanted.a)));
    for (int i = 0; i < 3; ++i) sum[i] += weight[r] * wanted.v[i];
    RC_ASSERT(std::abs(slopes.by_row[0][r] - weight[r] * wanted.v[3]) <=
              1e-9 * (1 + std::abs(wanted.v[3])));
  }
  for (std::size_t i = 0; i < 3; ++i)
    RC_ASSERT(std::abs(slopes.parameters[i] - sum[i]) <= 1e-9 * (1 + std::abs(sum[i])));
}

RC_GTEST_PROP(Text, IsReadAgainWithTheSameValues, ()) {
  const Laboratory laboratory;
  const Tree tree = random_tree(*rc::gen::inRange(1, 5));
  const std::string text = laboratory.program({text_of(tree)}).text(0);
  RC_LOG() << text_of(tree) << "\n" << text << "\n";
  const auto wanted = laboratory.values(text_of(tree)), found = laboratory.values(text);
  for (std::size_t r = 0; r < wanted.size(); ++r)  // constants are written with six digits
    RC_ASSERT(std::abs(found[r] - wanted[r]) <= 1e-3 * (1 + std::abs(wanted[r])));
}

// By differences, of whatever Jets do not know.
void expect_slopes(Laboratory laboratory, const std::string& text, double close = 1e-6) {
  const std::vector<double> weight = {1, -0.5, 2};
  const auto found = laboratory.slopes(text, weight).parameters;
  const auto total = [&] {
    const auto values = laboratory.values(text);
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += weight[i] * values[i];
    return sum;
  };
  for (std::size_t p = 0; p < found.size(); ++p) {
    double& parameter = laboratory.parameters[p];
    const double centre = parameter, h = 1e-5 * std::abs(centre);
    parameter = centre + h;
    const double up = total();
    parameter = centre - h;
    const double quotient = (up - total()) / (2 * h);
    parameter = centre;
    EXPECT_NEAR(found[p], quotient,
                close * (1e-300 + std::abs(quotient)) + 1e-9 * std::abs(found[p]))
        << text << " by parameter " << p;
  }
}

TEST(Gradient, OfPathsAndLabelsIsTheDifferenceQuotient) {
  const Laboratory laboratory;
  for (const char* text :
       {"q[material] * x + q[\"PEEK\"]",
        "cum(a * x) * b",
        "cum(b)*x",
        "log10(b) * x",
        "sin(a * phi) + cos(b * 1 [rad])",
        "abs(c) * x",
        "log1p(a*x) + expm1(c*x)",
        "x^a + (x + 1)^-3 * b",
        "b^x",
        "exp(q[material])/b",
        "exp(a*q[material])*x + exp(a*q[material])",
        "q[material]",
        "q[material]^2*b",
        "log(q[material]^2 + b)*force/1 [N]",
        "where(q[material] > 0, q[material]*b, a)*q[material]",
        "where(a > 0.5, x^b, log(-a))",
        "k*force*distance/area/1 [m]",
        "cum(q[material] * force)/1 [N]",
        "(a + b)/(x*b)",
        "-(a*x)/-b",
        "b*x*b*y",
        "tanh(a*x)^2*b^2",
        "erfc(a*x)*b",
        "probit(0.2*a)*x",
        "gamma(1 + a)*x + lgamma(b*x) + digamma(a + x)",
        "normal_cdf(x, a, b) + normal_pdf(x, b, a)",
        "lognormal_survival(x, b, a) + lognormal_quantile(0.1*a, b, a)",
        "weibull_cdf(x, b, a) * weibull_pdf(x, a, b)",
        "weibull_quantile(0.1*a, b, a) + loglogistic_pdf(x, b, a)",
        "smallest_extreme_value_pdf(x, a, b) + largest_extreme_value_cdf(x, a, b)",
        "log10_normal_cdf(x, b, a) + log10_normal_pdf(x, b, a)",
        "birnbaum_saunders_cdf(x, b, a) + birnbaum_saunders_quantile(0.1*a, b, a)",
        "frechet_cdf(x, b, a) + frechet_pdf(x, b, a) + frechet_quantile(0.1*a, b, a)",
        "exponentiated_weibull_survival(x, b, a, a) + exponentiated_weibull_quantile(0.1*a, b, a, "
        "b)",
        "gamma_cdf(x, a, b) + gamma_survival(b, x, a)",
        "gamma_pdf(x, a, b) + gamma_quantile(0.1*a, a, b)",
        "inverse_gaussian_cdf(x, a, b) + inverse_gaussian_pdf(x, a, b)",
        "inverse_gaussian_survival(x, a, b) + inverse_gaussian_quantile(0.1*a, a, b)",
        "generalized_gamma_cdf(x, b, a, a) + generalized_gamma_pdf(x, b, a, -b)",
        "generalized_gamma_survival(x, b, a, 0.1*b) + generalized_gamma_quantile(0.1*a, b, a, -b)",
        "student_t_cdf(x, 2 + a, b, a) + student_t_pdf(x, a, b, b)",
        "student_t_survival(x, 2 + a, b, a) + student_t_quantile(0.1*a, a, b, a)"})
    expect_slopes(laboratory, text);
}

TEST(Gradient, ABranchNotTakenLeavesNoNaN) {
  Laboratory laboratory;
  laboratory.columns[0] = {0, 1, 2};
  const auto found = laboratory.slopes("where(x > 0, a*log(x), b*x)", {1, 1, 1}).parameters;
  EXPECT_DOUBLE_EQ(found[0], std::log(2.0));
  EXPECT_DOUBLE_EQ(found[1], 0);
  laboratory.parameters[0] = 0;
  const auto root = laboratory.slopes("where(x > 5, sqrt(a*x), b)", {1, 1, 1}).parameters;
  EXPECT_EQ(root[0], 0);
  EXPECT_EQ(root[1], 3);
}

TEST(Program, RowsOfACallDoNotChangeEachOther) {
  Laboratory laboratory;
  const std::size_t n = 103;
  for (auto& column : laboratory.columns) {
    column.resize(n);
    for (std::size_t i = 0; i < n; ++i)
      column[i] = 0.1 + std::fmod(0.37 * static_cast<double>(i), 3.1);
  }
  for (auto& label : laboratory.labels) label.assign(n, 1);
  laboratory.by_row[0].assign(n, 0.3);
  const Program program = laboratory.program({"exp(a*x)*(1 + y^b)/log(2 + x*c^2)"});
  const Data data = program.bind(laboratory.rows());
  const auto at = laboratory.pointers();
  Workspace all = program.workspace(n), one = program.workspace(1);
  program.forward(data, 0, n, {laboratory.parameters, at}, all);
  for (std::size_t i = 0; i < n; ++i) {
    program.forward(data, i, i + 1, {laboratory.parameters, at}, one);
    EXPECT_EQ(one.values(0)[0], all.values(0)[i]) << i;
  }
}

TEST(Program, SeveralOutputsOfOneExpressionAddUp) {
  Laboratory laboratory;
  const Program program = laboratory.program({"a*x", "b", "a*x", "a*x + b", "x", "7"});
  const Data data = program.bind(laboratory.rows());
  Workspace work = program.workspace(3);
  program.forward(data, 0, 3, {laboratory.parameters}, work);
  for (std::size_t i = 0; i < 6; ++i)
    for (double& each : work.adjoints(i)) each = static_cast<double>(i + 1);
  std::vector<double> gradient(laboratory.parameters.size());
  program.reverse(data, 0, 3, {laboratory.parameters}, work, gradient);
  const double sum = 1.5 + 2 + 3.25;
  EXPECT_DOUBLE_EQ(gradient[0], (1 + 3 + 4) * sum);
  EXPECT_DOUBLE_EQ(gradient[1], 2 + 3 * 4);
  EXPECT_EQ(work.values(5)[0], 7);
  EXPECT_EQ(work.values(4)[2], 3.25);
}

TEST(Program, KnowsWhatItUses) {
  const Laboratory laboratory;
  const Program program = laboratory.program({"a * q[material] * x", "b"});
  EXPECT_TRUE(program.uses_parameter(0));
  EXPECT_TRUE(program.uses_parameter(1));
  EXPECT_FALSE(program.uses_parameter(2));
  EXPECT_TRUE(program.uses_column(0));
  EXPECT_FALSE(program.uses_column(1));
  EXPECT_TRUE(program.uses_label(0));
  EXPECT_FALSE(program.uses_label(1));
  EXPECT_FALSE(program.outputs()[0].uniform);
  EXPECT_TRUE(program.outputs()[1].uniform);
}

}  // namespace
}  // namespace wearwell::formula
