#include "wearwell/present/number.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace wearwell {
namespace {

TEST(Number, IsWrittenAlikeOnPagesAndTerminals) {
  EXPECT_EQ(shown_number(0.7759, 4, Script::terminal), "0.7759");
  EXPECT_EQ(shown_number(0.0026, 2, Script::terminal), "0.0026");
  EXPECT_EQ(shown_number(21602.3, 4, Script::page), "21\u202f600");
  EXPECT_EQ(shown_number(21602.3, 4, Script::terminal), "21\u202f600");
  EXPECT_EQ(shown_number(9'996'000, 3, Script::terminal), "1.00\u00a0×\u00a010^7");
  EXPECT_EQ(shown_number(999.96, 4, Script::page), "1\u202f000");
  EXPECT_EQ(shown_number(9.9996e-9, 4, Script::page), "1.000\u00a0×\u00a010⁻⁸");
  EXPECT_EQ(shown_number(6.88e7, 3, Script::page), "6.88\u00a0×\u00a010⁷");
  EXPECT_EQ(shown_number(-6.88e-10, 3, Script::terminal), "-6.88\u00a0×\u00a010^-10");
  EXPECT_EQ(shown_number(0, 4, Script::terminal), "0");
  EXPECT_EQ(shown_number(std::numeric_limits<double>::quiet_NaN(), 4, Script::terminal), "-");
  EXPECT_EQ(shown_number(std::numeric_limits<double>::quiet_NaN(), 4, Script::page), "–");
}

TEST(Number, KeepsTheDigitsOfWhatWasGiven) {
  EXPECT_EQ(given_text(342.22, Script::terminal), "342.22");
  EXPECT_EQ(given_text(1e6, Script::terminal), "1\u202f000\u202f000");
  EXPECT_EQ(given_text(1e8, Script::terminal), "10^8");
  EXPECT_EQ(given_text(1e8, Script::page), "10⁸");
  EXPECT_EQ(given_text(1e-6, Script::terminal), "10^-6");
  EXPECT_EQ(given_text(2.5e-5, Script::page), "2.5\u00a0×\u00a010⁻⁵");
  EXPECT_EQ(fixed_text(1453.26, 1, Script::page), "1\u202f453.3");
}

// An error below one of the last digit that is shown, whatever the first.
TEST(Number, ShowsNoMoreDigitsThanItsErrorAllows) {
  EXPECT_EQ(digits_within(0), 4);
  EXPECT_EQ(digits_within(NAN), 4);
  EXPECT_EQ(digits_within(9e-5), 4);
  EXPECT_EQ(digits_within(9e-4), 4);
  EXPECT_EQ(digits_within(0.003), 3);
  EXPECT_EQ(digits_within(0.02), 2);
  EXPECT_EQ(digits_within(0.4), 2);
  EXPECT_EQ(digits_within(1e-7, 6), 6);
}

TEST(Number, OneUnitAndOnePowerOfARange) {
  EXPECT_EQ(range_text(18200, 26600, 3, Script::terminal), "18\u202f200 to 26\u202f600");
  EXPECT_EQ(range_text(6.2988e-4, 9.2198e-4, 4, Script::terminal),
            "6.299 to 9.220\u00a0×\u00a010^-4");
  EXPECT_EQ(unit_description("1e6 cycles", Script::terminal), "×\u00a010^6\u00a0cycles");
  EXPECT_EQ(unit_description("mm^3/(N m)", Script::page), "mm³/(N\u00a0m)");
}

// A lower end keeps its digits however far away the upper one is, and is never read with its power.
TEST(Number, EndsDecadesApartHaveTheirOwnPowers) {
  const auto text = [](double low, double high, int digits) {
    return range_text(low, high, digits, Script::terminal);
  };
  EXPECT_EQ(text(1.64e7, 3.5812e12, 3), "1.64\u00a0×\u00a010^7 to 3.58\u00a0×\u00a010^12");
  EXPECT_EQ(range_text(1.64e7, 3.5812e12, 4, Script::page),
            "1.640\u00a0×\u00a010⁷ to 3.581\u00a0×\u00a010¹²");
  EXPECT_EQ(text(8471, 2.31e7, 3), "8.47\u00a0×\u00a010^3 to 2.31\u00a0×\u00a010^7");
  EXPECT_EQ(text(5, 3.58e12, 3), "5.00\u00a0×\u00a010^0 to 3.58\u00a0×\u00a010^12");
  EXPECT_EQ(text(-2e7, 3.58e12, 3), "-2.00\u00a0×\u00a010^7 to 3.58\u00a0×\u00a010^12");
  EXPECT_EQ(text(-3.21e8, 5, 3), "-3.21\u00a0×\u00a010^8 to 5.00");
  EXPECT_EQ(text(-5, 2.5e-8, 2), "-5.0\u00a0×\u00a010^0 to 2.5\u00a0×\u00a010^-8");
  EXPECT_EQ(text(1.3e-9, 4.56e-4, 3), "1.30\u00a0×\u00a010^-9 to 4.56\u00a0×\u00a010^-4");
  EXPECT_EQ(text(1.3e-9, 12.5, 3), "1.30\u00a0×\u00a010^-9 to 12.5");
  EXPECT_EQ(text(0, 3.58e12, 3), "0 to 3.58\u00a0×\u00a010^12");
  EXPECT_EQ(text(1.64e7, std::numeric_limits<double>::infinity(), 3),
            "1.64\u00a0×\u00a010^7 to inf");
}

// Within a decade the power of both is written once, with three digits of the smaller end.
TEST(Number, EndsOfNeighbouringDecadesShareOnePower) {
  const auto text = [](double low, double high, int digits) {
    return range_text(low, high, digits, Script::terminal);
  };
  EXPECT_EQ(text(8.4712e6, 2.3149e7, 4), "0.847 to 2.315\u00a0×\u00a010^7");
  EXPECT_EQ(text(8.4712e6, 2.3149e7, 3), "0.847 to 2.31\u00a0×\u00a010^7");
  EXPECT_EQ(text(-1.2e7, 8e6, 3), "-1.20 to 0.800\u00a0×\u00a010^7");
  EXPECT_EQ(text(0.0012, 0.0212, 3), "0.00120 to 0.0212");
}

// A sentence that the program wrote; names of a user's stay as they are.
TEST(Number, IsFoundInASentence) {
  EXPECT_EQ(powers_text("within 9e-06 of 2e+07, 1e+06 cycles", Script::page),
            "within 9\u00a0×\u00a010⁻⁶ of 2\u00a0×\u00a010⁷, 1\u202f000\u202f000 cycles");
  EXPECT_EQ(powers_text("machine 100234, A1e+06, 1e6 cycles", Script::page),
            "machine 100234, A1e+06, 1e6 cycles");
  EXPECT_EQ(powers_text("depth = k * force / 5e-05 [m^2]", Script::page),
            "depth = k * force / 5e-05 [m^2]");
  EXPECT_EQ(numbers_text("survival to 500000 cycles", Script::terminal),
            "survival to 500\u202f000 cycles");
  EXPECT_EQ(numbers_text("at 1050 MPa, R = 0.123456, log10_a", Script::terminal),
            "at 1050 MPa, R = 0.123456, log10_a");
}

}  // namespace
}  // namespace wearwell
