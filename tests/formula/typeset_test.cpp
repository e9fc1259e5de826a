#include "wearwell/formula/typeset.h"

#include <gtest/gtest.h>

#include "wearwell/base/error.h"

namespace wearwell::formula {
namespace {

std::string shown(const std::string& text) {
  return mathml(typeset({"[formula] x", text}));
}

TEST(Typeset, NamesAreSymbols) {
  EXPECT_EQ(mathml(typeset_name("eta")), "<mi>η</mi>");
  EXPECT_EQ(mathml(typeset_name("sigma_a")), "<msub><mi>σ</mi><mi>a</mi></msub>");
  EXPECT_EQ(mathml(typeset_name("k_0_beta")),
            "<msub><mi>k</mi><mrow><mn>0</mn><mo>,</mo><mi>β</mi></mrow></msub>");
  EXPECT_EQ(mathml(typeset_name("betamax")), "<mi>betamax</mi>");
  EXPECT_EQ(mathml(typeset_name("end_")), "<mi>end_</mi>");
}

TEST(Typeset, FractionsAndRootsNeedNoBrackets) {
  EXPECT_EQ(shown("(a + b) / (2 * c)"),
            "<mfrac><mrow><mi>a</mi><mo>+</mo><mi>b</mi></mrow>"
            "<mrow><mn>2</mn><mo>⋅</mo><mi>c</mi></mrow></mfrac>");
  EXPECT_EQ(shown("a / b / c"), "<mfrac><mfrac><mi>a</mi><mi>b</mi></mfrac><mi>c</mi></mfrac>");
  EXPECT_EQ(shown("sqrt((a))"), "<msqrt><mi>a</mi></msqrt>");
  // The brackets of a base and of a factor change what is meant.
  EXPECT_EQ(shown("(a + b)^2"),
            "<msup><mrow><mo>(</mo><mrow><mi>a</mi><mo>+</mo><mi>b</mi></mrow><mo>)</mo></mrow>"
            "<mn>2</mn></msup>");
  EXPECT_EQ(shown("a * (b - c)"),
            "<mrow><mi>a</mi><mo>⋅</mo><mrow><mo>(</mo><mrow><mi>b</mi><mo>−</mo><mi>c</mi>"
            "</mrow><mo>)</mo></mrow></mrow>");
}

// Without them e^x^2 would be read as e^(x^2), and 2 mm^2 as an area.
TEST(Typeset, ABaseOfPartsHasBrackets) {
  EXPECT_EQ(
      shown("exp(x)^2"),
      "<msup><mrow><mo>(</mo><msup><mi>e</mi><mi>x</mi></msup><mo>)</mo></mrow><mn>2</mn></msup>");
  EXPECT_EQ(shown("2 [mm]^2"),
            "<msup><mrow><mo>(</mo><mrow><mn>2</mn><mtext>\u00a0mm</mtext></mrow><mo>)</mo></mrow>"
            "<mn>2</mn></msup>");
  EXPECT_EQ(shown("k[material]^2"),
            "<msup><msub><mi>k</mi><mi>material</mi></msub><mn>2</mn></msup>");
}

TEST(Typeset, PrecedenceIsThatOfTheReader) {
  // -(a^2), a^(b^c), a^(-b), (a - b) - c
  EXPECT_EQ(shown("-a^2"), "<mrow><mo>−</mo><msup><mi>a</mi><mn>2</mn></msup></mrow>");
  EXPECT_EQ(shown("a^b^c"), "<msup><mi>a</mi><msup><mi>b</mi><mi>c</mi></msup></msup>");
  EXPECT_EQ(shown("a^-b"), "<msup><mi>a</mi><mrow><mo>−</mo><mi>b</mi></mrow></msup>");
  EXPECT_EQ(shown("a - b - c"), "<mrow><mi>a</mi><mo>−</mo><mi>b</mi><mo>−</mo><mi>c</mi></mrow>");
  EXPECT_EQ(shown("a * b / c"),
            "<mfrac><mrow><mi>a</mi><mo>⋅</mo><mi>b</mi></mrow><mi>c</mi></mfrac>");
  EXPECT_EQ(shown("a + b * c"),
            "<mrow><mi>a</mi><mo>+</mo><mrow><mi>b</mi><mo>⋅</mo><mi>c</mi></mrow></mrow>");
}

TEST(Typeset, NumbersUnitsLabelsAndFunctions) {
  EXPECT_EQ(shown("1e-06 [mm]"),
            "<mrow><msup><mn>10</mn><mrow><mo>−</mo><mn>6</mn></mrow></msup>"
            "<mtext>\u00a0mm</mtext></mrow>");
  EXPECT_EQ(shown("2.5e3"),
            "<mrow><mn>2.5</mn><mo>×</mo><msup><mn>10</mn><mn>3</mn></msup></mrow>");
  EXPECT_EQ(shown("k[material]"), "<msub><mi>k</mi><mi>material</mi></msub>");
  EXPECT_EQ(shown("log10(x)"),
            "<mrow><msub><mi>log</mi><mn>10</mn></msub><mo>\u2061</mo>"
            "<mrow><mo>(</mo><mi>x</mi><mo>)</mo></mrow></mrow>");
  EXPECT_EQ(shown("exp(-t/tau)"),
            "<msup><mi>e</mi><mfrac><mrow><mo>−</mo><mi>t</mi></mrow><mi>τ</mi></mfrac></msup>");
  EXPECT_EQ(shown("where(a <= 1 and not b == \"<c>\", 1, 2)"),
            "<mrow><mi>where</mi><mo>\u2061</mo><mrow><mo>(</mo><mrow><mrow><mi>a</mi><mo>≤</mo>"
            "<mn>1</mn></mrow><mtext>\u00a0and\u00a0</mtext><mrow><mtext>not\u00a0</mtext><mrow>"
            "<mi>b</mi><mo>=</mo><mtext>&lt;c&gt;</mtext></mrow></mrow></mrow><mo>,</mo><mn>1</mn>"
            "<mo>,</mo><mn>2</mn><mo>)</mo></mrow></mrow>");
}

TEST(Typeset, WhatIsNoExpressionIsRefused) {
  for (const char* each : {"", "a +", "(a", "a)", "a b", "k[", "f(", "f(,)", "a ^", "and", "k[3]"})
    EXPECT_THROW(shown(each), InputError) << each;
  EXPECT_THROW(shown(std::string(5000, '(')), InputError);
  std::string quotients = "1", sums = "1";
  for (int i = 0; i < 1000; ++i) quotients += "/2", sums += "+2";
  EXPECT_THROW(shown(quotients), InputError);
  EXPECT_EQ(shown(sums).find("<mrow>", 1), std::string::npos);
  EXPECT_THROW(shown(std::string(5000, '-') + "1"), InputError);
}

}  // namespace
}  // namespace wearwell::formula
