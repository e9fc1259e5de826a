// wrong_formulas.txt: each block is a law that is refused, with the place and the words of its one message. Lines with := are lines
// of [formula], the line before the caret is the expression in which the caret stands; without a caret, the words follow a "!".
#include <gmock/gmock.h>

#include <fstream>

#include "formula/laboratory.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell::formula {
namespace {

using testing::HasSubstr;

struct Wrong {
  std::vector<std::string> lines;
  std::string place;  ///< as the message shows it: spaces and a caret; empty without one
  std::string words;
};

std::vector<Wrong> wrong_formulas() {
  std::ifstream file(PROJECT_SOURCE_DIR "/tests/formula/wrong_formulas.txt");
  std::vector<Wrong> all;
  Wrong block;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("# ") || (line.empty() && block.lines.empty())) continue;
    const std::size_t caret = line.find_first_not_of(' ');
    if (line.starts_with("! ")) {
      block.words = line.substr(2);
    } else if (caret != line.npos && line.substr(caret).starts_with("^ ") && !block.lines.empty() &&
               line.size() > caret + 3) {
      block.place = line.substr(0, caret + 1);
      block.words = line.substr(caret + 2);
    } else {
      block.lines.push_back(line);
      continue;
    }
    all.push_back(block);
    block = {};
  }
  return all;
}

std::string refusal(const Wrong& wrong) {
  Laboratory laboratory;
  std::string text = "a";
  for (const std::string& line : wrong.lines) {
    const std::size_t at = line.find(" := ");
    if (at == line.npos)
      text = line;
    else
      laboratory.lines.push_back({line.substr(0, at), line.substr(at + 4)});
  }
  return message_of<InputError>([&] { laboratory.program({text}); });
}

TEST(WrongLaws, HaveOneMessageWithThePlace) {
  const auto all = wrong_formulas();
  EXPECT_GE(all.size(), 250u);
  for (const Wrong& each : all) {
    SCOPED_TRACE(testing::PrintToString(each.lines));
    const std::string message = refusal(each);
    EXPECT_THAT(message, HasSubstr(each.words));
    if (each.place.empty())
      EXPECT_EQ(message.find('\n'), message.npos);
    else
      EXPECT_THAT(message, testing::EndsWith("\n    " + each.place));
  }
}

std::string refusal(const std::string& text) {
  const Laboratory laboratory;
  return message_of<InputError>([&] { laboratory.program({text}); });
}

std::string repeated(const std::string& part, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += part;
  return all;
}

TEST(WrongLaws, OfHostileSizeAreRefused) {
  EXPECT_THAT(refusal(repeated("(", 100000)), HasSubstr("has 100000 characters"));
  EXPECT_THAT(refusal(repeated("x + ", 250000) + "x"), HasSubstr("has 1000001 characters"));
  EXPECT_THAT(refusal(repeated("(", 9000) + "x" + repeated(")", 9000)),
              HasSubstr("more than 200 nested brackets"));
  for (const char* part : {"-", "+", "exp(", "not ", "2^", "where(x > 1, 2, ", "min(x, "})
    EXPECT_THAT(refusal(repeated(part, 1200) + "x"), HasSubstr("more than 200 nested brackets"))
        << part;
  EXPECT_THAT(refusal(repeated("x*a + ", 3000) + "x"), HasSubstr("1000 operations deep"));
  EXPECT_THAT(refusal("x^1" + repeated("0", 400)), HasSubstr("too large"));
  EXPECT_THAT(refusal(std::string("x + \0 y", 7)),
              HasSubstr("'\\x00' is not allowed in an expression"));
  EXPECT_THAT(refusal("x + \xff"), HasSubstr("'\\xff' is not allowed in an expression"));
  EXPECT_THAT(refusal(""), HasSubstr("the expression is empty"));
  EXPECT_THAT(refusal(" \n "), HasSubstr("the expression is empty"));
  // What is long but meant.
  const Laboratory laboratory;
  EXPECT_DOUBLE_EQ(laboratory.value(repeated("x + ", 400) + "x"), 401 * 1.5);
  EXPECT_DOUBLE_EQ(laboratory.value(repeated("(", 190) + "x" + repeated(")", 190)), 1.5);
}

// Each line of a chain doubles what it says; it is one node all the same.
TEST(WrongLaws, ThatExplodeWhenWrittenOutAreShort) {
  Laboratory laboratory;
  laboratory.lines.push_back({"l0", "a*x"});
  for (int i = 1; i < 300; ++i)
    laboratory.lines.push_back(
        {fmt::format("l{}", i), fmt::format("l{}*0.5 + l{}*0.5", i - 1, i - 1)});
  const Program program = laboratory.program({"l299"});
  EXPECT_DOUBLE_EQ(laboratory.value("l299"), 0.7 * 1.5);
  EXPECT_LT(program.text(0).size(), 5000u);
}

TEST(WrongLaws, ShowLongTextsAroundThePlace) {
  const std::string message = refusal(repeated("x + ", 100) + "force" + repeated(" + x", 100));
  EXPECT_THAT(message, HasSubstr("\n    ...x + x"));
  const std::size_t line = message.rfind('\n', message.rfind('\n') - 1);
  EXPECT_LT(message.size() - line, 200u);
  EXPECT_THAT(refusal("x\n  + y\n  + force"), testing::EndsWith("\n      + force\n      ^"));
}

std::string symbols_refusal(Symbols symbols) {
  return message_of<InputError>([&] { compile({}, {{"output", "1"}}, symbols); });
}

TEST(WrongSymbols, HaveOneMessage) {
  EXPECT_THAT(symbols_refusal({{{"k", {}}}, {}, {{"k", {}}}, {}}),
              HasSubstr("'k' is the name of a column and of a parameter"));
  EXPECT_THAT(symbols_refusal({{{"k", {}}, {"k", {}}}, {}, {}, {}}), HasSubstr("two columns 'k'"));
  EXPECT_THAT(symbols_refusal({{{"k", {}}}, {{"k", {}}}, {}, {}}),
              HasSubstr("a column and of a label"));
  EXPECT_THAT(symbols_refusal({{}, {}, {{"k", {}}}, {{"k", {}}}}),
              HasSubstr("a parameter and of a constant"));
  EXPECT_THAT(symbols_refusal({{{"exp", {}}}, {}, {}, {}}), HasSubstr("name of a keyword"));
  EXPECT_THAT(symbols_refusal({{{"2x", {}}}, {}, {}, {}}), HasSubstr("does not have a valid name"));
  EXPECT_THAT(symbols_refusal({{{"", {}}}, {}, {}, {}}), HasSubstr("does not have a valid name"));
  EXPECT_THAT(symbols_refusal({{}, {}, {{"q", {}, Scope::per_level, "lab"}}, {}}),
              HasSubstr("varies by 'lab', which is not a label"));
}

TEST(WrongOutputs, SayWhatTheyMustBe) {
  const Laboratory laboratory;
  const auto refused = [&](Wanted wanted) {
    return message_of<InputError>([&] { compile({}, {wanted}, laboratory.symbols); });
  };
  EXPECT_EQ(refused({"[likelihood.depth] mean", "force*x", read_any_unit("um").powers,
                     "the column 'depth'"}),
            "[likelihood.depth] mean: 'force*x' is N, but must be m, as the column 'depth'; their "
            "ratio is N/m; check for a missing factor or power\n    force*x\n    ^");
  EXPECT_EQ(refused({"[predict.quantities] q", "a + x*b", {}, {}, true}),
            "[predict.quantities] q: 'x' varies from row to row, but this must be one number; use "
            "only parameters and constants\n    a + x*b\n        ^");
  EXPECT_THAT(refused({"q", "cum(1)", {}, {}, true}), HasSubstr("varies from row to row"));
  EXPECT_THAT(refused({"q", "q[material]", {}, {}, true}), HasSubstr("'q' varies from row to row"));
}

}  // namespace
}  // namespace wearwell::formula
