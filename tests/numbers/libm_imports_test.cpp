// What the program and its modules take from glibc's libm: only functions whose result is exact, hence the same on every processor.
#include <gmock/gmock.h>

#include <sstream>
#include <string>
#include <vector>

#include "support/run_command.h"

namespace wearwell {
namespace {

/// Undefined symbols of a program that libm.so.6 defines, without their versions.
std::vector<std::string> libm_imports(const std::string& file) {
  const CommandResult run =
      run_command("libm=$(ldd '" + file +
                  "' | awk '/libm[.]so/ {print $3}'); "
                  "test -r \"$libm\" && '" NM "' -D --undefined-only '" +
                  file +
                  "' | awk '{print $2}' | grep -v GLIBCXX "
                  "| sed 's/@.*//' | sort -u > /tmp/wearwell-imports-$$; "
                  "'" NM
                  "' -D --defined-only \"$libm\" | awk '{print $3}' | sed 's/@.*//' | sort -u "
                  "| comm -12 - /tmp/wearwell-imports-$$; rm -f /tmp/wearwell-imports-$$");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  std::vector<std::string> names;
  std::istringstream lines(run.out);
  for (std::string line; std::getline(lines, line);) names.push_back(line);
  return names;
}

const std::vector<std::string> exact = {
    "ceil",    "copysign", "fabs",    "floor",  "floorl", "fma",       "fmax",      "fmin",
    "fmod",    "frexp",    "frexpl",  "ilogb",  "ldexp",  "ldexpf",    "ldexpl",    "llrint",
    "llround", "logb",     "lrint",   "lround", "modf",   "nearbyint", "nextafter", "remainder",
    "rint",    "round",    "scalbln", "scalbn", "sqrt",   "sqrtl",     "trunc"};

std::string files() {
  std::string all = WEARWELL_BINARY;
#ifdef WEARWELL_PYTHON_MODULE
  all += "\n" WEARWELL_PYTHON_MODULE;
#endif
#ifdef WEARWELL_R_MODULE
  all += "\n" WEARWELL_R_MODULE;
#endif
  return all;
}

TEST(LibmImports, AreExactFunctions) {
  std::istringstream each(files());
  for (std::string file; std::getline(each, file);) {
    const std::vector<std::string> names = libm_imports(file);
    // floor is called everywhere: an empty list is a list that was not read.
    EXPECT_THAT(names, testing::Contains("floor")) << file;
    for (const std::string& name : names) EXPECT_THAT(exact, testing::Contains(name)) << file;
  }
}

// Shared libraries that the program loads (NLopt, DuckDB) find the program's functions before libm's.
TEST(LibmImports, OfTheProgramsLibrariesAreTheProgramsOwn) {
  const CommandResult run =
      run_command("'" NM "' -D --defined-only '" WEARWELL_BINARY "' | awk '{print $3}'");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::istringstream lines(run.out);
  std::vector<std::string> names;
  for (std::string line; std::getline(lines, line);) names.push_back(line);
  EXPECT_THAT(names, testing::IsSupersetOf({"exp", "log", "pow", "sin", "cos", "tan"}));
}

}  // namespace
}  // namespace wearwell
