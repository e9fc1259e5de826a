#include "wearwell/base/unit.h"

#include <gmock/gmock.h>

#include <numbers>

#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr double pi = std::numbers::pi;

std::string refusal(const char* text, const char* si) {
  return message_of<InputError>([&] { read_unit(text, si); });
}
std::string quantity_refusal(const char* text, const char* si) {
  return message_of<InputError>([&] { read_quantity(text, si); });
}

// UDUNITS-2 reads "N/m^0.3" as N/m^0 times .3.
TEST(Unit, PowersAreWhole) {
  for (const char* text : {"N m^0.3", "N m**0.3", "N m^-0.5", "N m^1/2", "N (m^0.5)^2"})
    EXPECT_THAT(refusal(text, "N m"), HasSubstr("power of a unit must be a whole number")) << text;
  EXPECT_DOUBLE_EQ(read_unit("N mm^2/m", "N m").scale, 1e-6);
}

TEST(Unit, ConvertsToSi) {
  EXPECT_DOUBLE_EQ(read_unit("mm^3", "m^3").scale, 1e-9);
  EXPECT_DOUBLE_EQ(read_unit("mm^3/(N m)", "m^3/(N m)").scale, 1e-9);
  EXPECT_DOUBLE_EQ(read_unit("mm3/MJ", "m^3/(N m)").scale, 1e-15);
  EXPECT_DOUBLE_EQ(read_unit("N mm", "N m").scale, 1e-3);
  EXPECT_DOUBLE_EQ(to_si(read_unit("degC", "K"), 20), 293.15);
  EXPECT_DOUBLE_EQ(from_si(read_unit("degC", "K"), 293.15), 20);
  // NIST SP 811: t/degC = (t/degF - 32)/1.8.
  EXPECT_DOUBLE_EQ(to_si(read_unit("degF", "K"), 212), 373.15);
  EXPECT_DOUBLE_EQ(read_unit("degF", "K").scale, 1 / 1.8);
}

// Of a zeptodegree, one and two would be the same double.
TEST(Unit, TooSmallBesideItsZeroIsRefused) {
  EXPECT_DOUBLE_EQ(read_unit("udegC", "K").scale, 1e-6);
  EXPECT_THAT(refusal("zdegF", "K"), HasSubstr("too small compared with its zero point"));
  EXPECT_THAT(refusal("pdegC", "K"), HasSubstr("zero point at 273.15"));
}

// What a unit must be like may be any unit, and the same one again.
TEST(Unit, ItselfKeepsItsSize) {
  for (const char* si :
       {"1",   "m",         "m^3",   "m^3/(N m)", "m^3/J", "m^2/N", "1/Pa",  "Pa",  "N",
        "N m", "N m/cycle", "N m/s", "J",         "W",     "s",     "Hz",    "m/s", "K",
        "kg",  "A",         "V",     "cycle",     "rev",   "rev/s", "rad/s", "rad", "log10(Pa)"}) {
    EXPECT_EQ(read_unit(si, si).scale, 1) << si;
    EXPECT_EQ(read_unit(si, si).offset, 0) << si;
  }
  EXPECT_DOUBLE_EQ(read_unit("um", "um").scale, 1e-6);
  EXPECT_DOUBLE_EQ(read_unit("mm", "um").scale, 1e-3);
  EXPECT_DOUBLE_EQ(to_si(read_unit("degC", "degC"), 20), 293.15);
  EXPECT_DOUBLE_EQ(read_unit("log10(MPa)", "log10(MPa)").offset, 6);
  EXPECT_DOUBLE_EQ(read_quantity("5 km", "km").si(), 5000);
}

TEST(Unit, RefusesNonsenseAndWrongDimension) {
  EXPECT_THROW(read_unit("mmm^3", "m^3"), InputError);
  EXPECT_THROW(read_unit("mm^2", "m^3"), InputError);
  EXPECT_THROW(read_unit("", "m^3"), InputError);
}

TEST(Unit, CountsHaveADimensionOfTheirOwn) {
  for (const char* one : {"cycle", "cycles", "rev", "revolution", "turns", "strokes", "closings",
                          "rotation", "1", "count", "r", "U"})
    EXPECT_EQ(read_unit(one, "cycle").scale, 1) << one;
  for (const char* thousand : {"kcycles", "krev", "kilocycles", "1e3 cycles", "1000", "10^3 turns"})
    EXPECT_DOUBLE_EQ(read_unit(thousand, "rev").scale, 1000) << thousand;
  EXPECT_DOUBLE_EQ(read_unit("Mstrokes", "cycle").scale, 1e6);
  EXPECT_EQ(read_unit("reversals", "cycle").scale, 0.5);
}

TEST(Unit, WhatIsCountedMayGoWithoutSaying) {
  EXPECT_DOUBLE_EQ(read_unit("kJ/stroke", "N m/cycle").scale, 1e3);
  EXPECT_DOUBLE_EQ(read_unit("kN m/kcycle", "N m/cycle").scale, 1);
  EXPECT_DOUBLE_EQ(read_unit("N mm", "N m/cycle").scale, 1e-3);
  EXPECT_THAT(refusal("J/rev", "N m"), HasSubstr("'J/rev' contains a count of cycles"));
  EXPECT_THAT(refusal("turns", "1"), HasSubstr("contains a count"));
  EXPECT_THAT(refusal("J turn", "N m/cycle"), HasSubstr("contains a count"));
}

TEST(Unit, AnAngleIsNoCountAndNoNumber) {
  for (const char* angle : {"rad", "deg", "°", "mrad", "grade"}) {
    for (const char* si : {"cycle", "rev", "1"})
      EXPECT_THAT(refusal(angle, si), HasSubstr("contains an angle")) << angle << " " << si;
  }
  EXPECT_THAT(refusal("J/rad", "N m"), HasSubstr("contains an angle"));
  EXPECT_THAT(refusal("J/rad", "N m/cycle"), HasSubstr("contains an angle"));
}

TEST(Unit, CountsHaveNoSmallParts) {
  EXPECT_THAT(refusal("mcycles", "cycle"),
              AllOf(HasSubstr("0.001 of one"), HasSubstr("'Mcycles'")));
  EXPECT_THAT(refusal("%", "rev"), HasSubstr("0.01 of one"));
}

TEST(Unit, SpeedsOfRotation) {
  for (const char* speed : {"rpm", "rev/min", "U/min", "r/min", "1/min", "min^-1", "turns/min"}) {
    EXPECT_DOUBLE_EQ(read_unit(speed, "rev/s").scale, 1. / 60) << speed;
    EXPECT_DOUBLE_EQ(read_unit(speed, "rad/s").scale, pi / 30) << speed;
  }
  EXPECT_DOUBLE_EQ(read_unit("kHz", "rad/s").scale, 2000 * pi);
  EXPECT_DOUBLE_EQ(read_unit("rad/s", "rev/s").scale, 1 / (2 * pi));
  EXPECT_DOUBLE_EQ(read_unit("deg/s", "rev/s").scale, 1. / 360);
  EXPECT_DOUBLE_EQ(read_unit("m^3/(J rpm)", "m^3 s/(J rad)").scale, 30 / pi);
}

TEST(Unit, ASpeedWithoutRevolutionsOrRadiansHasTwoReadings) {
  EXPECT_THAT(quantity_refusal("420 1/s", "rad/s"),
              AllOf(HasSubstr("420 rev/s = 2639 rad/s"), HasSubstr("420 rad/s = 66.85 rev/s")));
  EXPECT_THAT(quantity_refusal("90 1/h", "rev/s"), HasSubstr("0.025 rev/s = 0.1571 rad/s"));
  EXPECT_THAT(refusal("1/ms", "rev/s"), HasSubstr("write rev/s (rpm, Hz) or rad/s"));
  EXPECT_THAT(refusal("m^3 s/J", "m^3 s/(J rad)"), HasSubstr("differ by a factor of 2 pi"));
  EXPECT_THAT(refusal("s", "rad/s"), HasSubstr("reciprocal"));
  EXPECT_THAT(refusal("rev", "rev/s"), HasSubstr("wrong dimension"));
}

TEST(Unit, OneOverIsAnotherDimension) {
  for (const auto& [text, si] : {std::pair{"1/N", "N"},
                                 {"1/year", "s"},
                                 {"mm^-3", "m^3"},
                                 {"MJ/mm3", "m^3/(N m)"},
                                 {"1/kcycle", "cycle"}})
    EXPECT_THROW(read_unit(text, si), InputError) << text;
  EXPECT_THAT(refusal("1/year", "s"), HasSubstr("reciprocal of the expected unit"));
}

TEST(Unit, LogarithmsAndPointsInTimeAreNoUnits) {
  for (const auto& [text, si] : {std::pair{"lg(re 1 N)", "N"},
                                 {"3 ln(re 1 MPa)", "Pa"},
                                 {"dB(re 20 uPa)", "Pa"},
                                 {"Np(re 1 m)", "m"},
                                 {"dBm", "N m/s"},
                                 {"h since 2001-05-17", "s"}})
    EXPECT_THROW(read_unit(text, si), InputError) << text;
  EXPECT_THAT(refusal("lg(re 1 N)", "N"), HasSubstr("logarithm"));
  EXPECT_EQ(read_unit("log10(kPa)", "log10(Pa)").offset, 3);
  EXPECT_THROW(read_unit("log10(1/kPa)", "log10(Pa)"), InputError);
}

TEST(Unit, EngineersSpellings) {
  EXPECT_EQ(read_unit("Nm", "N m").scale, 1);  // no nanometre
  EXPECT_DOUBLE_EQ(read_unit("kNm", "N m").scale, 1e3);
  EXPECT_DOUBLE_EQ(read_unit("Ncm", "N m").scale, 1e-2);
  EXPECT_DOUBLE_EQ(read_unit("mm³/Nm", "m^3/(N m)").scale, 1e-9);
  EXPECT_DOUBLE_EQ(read_unit("mm³/(N⋅m)", "m^3/(N m)").scale, 1e-9);
  EXPECT_DOUBLE_EQ(read_unit("kWh", "J").scale, 3.6e6);
  for (const char* micrometre :
       {"um", "µm", "μm", "micron", "microns", "Micron", "mikron", "Mikron"})
    EXPECT_DOUBLE_EQ(read_unit(micrometre, "m").scale, 1e-6) << micrometre;
  for (const char* celsius : {"degC", "°C", "celsius"})
    EXPECT_DOUBLE_EQ(read_unit(celsius, "K").offset, 273.15) << celsius;
  EXPECT_DOUBLE_EQ(read_unit("N/mm2", "Pa").scale, 1e6);
  EXPECT_NEAR(read_unit("ksi", "Pa").scale, 6.894757293168361e6, 1e-6);  // NIST SP 811
  for (const char* hour : {"h", "hr", "hours"}) EXPECT_EQ(read_unit(hour, "s").scale, 3600) << hour;
}

TEST(Unit, WordsOfTwoSizesAreRefusedWithBoth) {
  EXPECT_THAT(refusal("ton", "kg"), AllOf(HasSubstr("1000 kg"), HasSubstr("907.185 kg")));
  EXPECT_THAT(refusal("gallons", "m^3"), AllOf(HasSubstr("3.785 l"), HasSubstr("4.546 l")));
  EXPECT_THAT(refusal("gr", "kg"), HasSubstr("grain"));
  EXPECT_THAT(refusal("kton/m^3", "kg/m^3"), HasSubstr("is not a unit"));
  for (const char* thousandth : {"thou", "mil", "mils"})
    EXPECT_DOUBLE_EQ(read_unit(thousandth, "m").scale, 25.4e-6) << thousandth;
}

TEST(Unit, WhatMeansSomethingElseHasAnotherDimension) {
  for (const auto& [text, si] : {std::pair{"C", "K"},
                                 {"F", "K"},
                                 {"H", "s"},
                                 {"S", "s"},
                                 {"T", "kg"},
                                 {"nm", "N m"},
                                 {"kg", "N"},
                                 {"lb", "N"},
                                 {"a", "s"},
                                 {"M", "cycle"},
                                 {"h", "cycle"},
                                 {"\"", "m"}})
    EXPECT_THROW(read_unit(text, si), InputError) << text;
  EXPECT_THAT(refusal("C", "K"), HasSubstr("'degC'"));
  EXPECT_THAT(refusal("mm^3/N m", "m^3/(N m)"), HasSubstr("did you mean 'mm^3/(N m)'?"));
}

TEST(Unit, ItsSizeIsAboveZeroAndItsZeroKnown) {
  for (const auto& [text, si] : {std::pair{"-1 mm", "m"},
                                 {"0 mm", "m"},
                                 {"1e-320 m", "m"},
                                 {"1e300 Em^3", "m^3"},
                                 {"mm @ 5", "m"},
                                 {"2 degC", "K"},
                                 {"MPa from 3", "Pa"}})
    EXPECT_THROW(read_unit(text, si), InputError) << text;
}

TEST(Unit, ANumberBehindIsAFactorOrAPower) {
  EXPECT_THAT(refusal("mm 2", "m"), HasSubstr("a factor or a power"));
  EXPECT_THROW(read_unit("N m 10", "N m"), InputError);
  EXPECT_DOUBLE_EQ(read_unit("mm^3/(1000 N m)", "m^3/(N m)").scale, 1e-12);
}

TEST(Quantity, ReadsNumberAndUnit) {
  EXPECT_DOUBLE_EQ(read_quantity("5.966 N m", "J").si(), 5.966);
  EXPECT_DOUBLE_EQ(read_quantity(" -1.5e2 mm ", "m").si(), -0.15);
  EXPECT_DOUBLE_EQ(read_quantity("3", "1").si(), 3);
  EXPECT_DOUBLE_EQ(read_quantity("5 %", "1").si(), 0.05);
  EXPECT_DOUBLE_EQ(read_quantity("7e4", "cycle").si(), 7e4);
  EXPECT_DOUBLE_EQ(read_quantity("70 kcycles", "cycle").si(), 7e4);
  EXPECT_DOUBLE_EQ(read_quantity("45 1/min", "rev/s").si(), 0.75);
}

TEST(Quantity, NamesWhatIsMissing) {
  EXPECT_THROW(read_quantity("5.966", "N m"), InputError);
  EXPECT_THROW(read_quantity("mm", "m"), InputError);
  EXPECT_THROW(read_quantity("nan mm", "m"), InputError);
  EXPECT_THROW(read_quantity("", "1"), InputError);
  EXPECT_EQ(quantity_refusal("5 mm", "m^3"),
            "unit 'mm' has the wrong dimension (expected one like 'm^3')");
  EXPECT_EQ(quantity_refusal("2800", "rad/s"), "'2800' has no unit (write one like '2800 rad/s')");
}

TEST(Quantity, RefusesAGapInANumber) {
  EXPECT_THAT(quantity_refusal("12 500 turns", "cycle"),
              AllOf(HasSubstr("a gap"), HasSubstr("12 times 500, which is 6000")));
  for (const char* text : {"1.5.2 mm", "10-3 mm", "3 1e-3 m"})
    EXPECT_THAT(quantity_refusal(text, "m"), HasSubstr("is ambiguous")) << text;
}

TEST(Unit, SpellingsOfOtherLanguagesAndTypesetters) {
  for (const char* one : {"LW", "Lastwechsel", "cyc", "tr", "Umdr", "Umdrehungen"})
    EXPECT_EQ(read_unit(one, "cycle").scale, 1) << one;
  EXPECT_DOUBLE_EQ(read_unit("MLW", "cycle").scale, 1e6);
  for (const char* speed : {"tr/min", "Umdr/min", "min⁻¹"})
    EXPECT_DOUBLE_EQ(read_unit(speed, "rev/s").scale, 1. / 60) << speed;
  for (const char* rate :
       {"mm³ N⁻¹ m⁻¹", "mm³N⁻¹m⁻¹", "mm³/Nm", "mm^3/N/m", "mm3/Nm", "mm³ N−1 m−1"})
    EXPECT_DOUBLE_EQ(read_unit(rate, "m^3/(N m)").scale, 1e-9) << rate;
  EXPECT_DOUBLE_EQ(read_unit("10⁻⁶ mm³/Nm", "m^3/(N m)").scale, 1e-15);
  EXPECT_DOUBLE_EQ(read_unit("g/cm3", "kg/m^3").scale, 1000);
  EXPECT_DOUBLE_EQ(read_unit("ksi", "Pa").scale, 6894757.293168361);  // NIST SP 811, appendix B.8
}

TEST(Unit, OtherCapitalsAreOfferedNeverTaken) {
  EXPECT_THAT(refusal("mpa", "Pa"), HasSubstr("; did you mean 'mPa' or 'MPa'?"));
  EXPECT_THAT(refusal("KSI", "Pa"), HasSubstr("; did you mean 'ksi'?"));
  EXPECT_THAT(refusal("KN", "N"), HasSubstr("did you mean 'kN'?"));
  EXPECT_THAT(refusal("Kg", "kg"), HasSubstr("did you mean 'kg'?"));
  EXPECT_THAT(refusal("MM^3", "m^3"), HasSubstr("did you mean 'Mm^3' or 'mm^3'?"));
  EXPECT_THAT(refusal("H", "s"), HasSubstr("did you mean 'h'?"));
  EXPECT_THAT(refusal("parsnips", "m"), Not(HasSubstr("did you mean")));
}

TEST(Quantity, ADecimalCommaIsSaid) {
  EXPECT_EQ(quantity_refusal("0,1 mm", "m"),
            "'0,1 mm' has a decimal comma; use a decimal point; write '0.1 mm'");
  EXPECT_THAT(quantity_refusal("-9,5e-6 m", "m"), HasSubstr("write '-9.5e-6 m'"));
  EXPECT_THAT(quantity_refusal("0,125 mm", "m"), HasSubstr("write '0.125 mm'"));
  EXPECT_THAT(quantity_refusal("1234,567 mm", "m"), HasSubstr("write '1234.567 mm'"));
  EXPECT_THAT(quantity_refusal("0,5", "1"), HasSubstr("write '0.5'"));
  EXPECT_THAT(quantity_refusal("1.009,5 mm", "m"), HasSubstr("write '1009.5 mm'"));
}

TEST(Quantity, MarksForThousandsAreSaid) {
  for (const char* text : {"1,234,567 cycles", "1'234'567 cycles", "1.234.567 cycles"})
    EXPECT_THAT(quantity_refusal(text, "cycle"),
                AllOf(HasSubstr("has thousands separators"), HasSubstr("write '1234567 cycles'")))
        << text;
  EXPECT_THAT(quantity_refusal("1,009.5 mm", "m"), HasSubstr("write '1009.5 mm'"));
  // Both readings.
  EXPECT_THAT(quantity_refusal("20,585 cycles", "cycle"),
              AllOf(HasSubstr("20.585"), HasSubstr("20585"), HasSubstr("thousands separator")));
}

TEST(Quantity, APowerOfTenIsWrittenWithAnE) {
  for (const char* text : {"2 x 10^-6 mm^3/Nm", "2×10⁻⁶ mm³/Nm", "2*10^-6 mm^3/Nm",
                           "2 10^-6 mm^3/Nm", "2 · 10-6 mm^3/Nm", "2*10**-6 mm^3/Nm"})
    EXPECT_THAT(quantity_refusal(text, "m^3/(N m)"), HasSubstr("with e, for example 2e-6")) << text;
}

TEST(Quantity, IsFiniteAndAboveAbsoluteZero) {
  EXPECT_THAT(quantity_refusal("-280 degC", "K"), HasSubstr("below absolute zero"));
  EXPECT_THAT(quantity_refusal("-1 K", "K"), HasSubstr("below absolute zero"));
  EXPECT_THAT(quantity_refusal("1e308 km", "m"), HasSubstr("infinite"));
}

TEST(Quantity, APlainNumberBesideAUnitHasTwoReadings) {
  const Unit hundreds = read_unit("1e2 cycles", "cycle");
  const Quantity seven = read_quantity("7", "cycle");
  EXPECT_THAT(message_of<InputError>([&] { refuse_two_readings(seven, hundreds); }),
              AllOf(HasSubstr("is ambiguous: 7,"), HasSubstr("= 700")));
  EXPECT_NO_THROW(refuse_two_readings(read_quantity("7 cycles", "cycle"), hundreds));
  EXPECT_NO_THROW(refuse_two_readings(read_quantity("0", "cycle"), hundreds));
  EXPECT_NO_THROW(refuse_two_readings(seven, read_unit("turns", "cycle")));
}

}  // namespace
}  // namespace wearwell
