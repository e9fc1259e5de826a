#include "wearwell/input/toml_reader.h"

#include <gmock/gmock.h>

#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class TomlReaderTest : public ScratchTest {
 protected:
  TomlReader parse(const std::string& content) {
    return TomlReader::parse_file(write("a.toml", content));
  }

  // The message without the folder and without the excerpt behind it: "a.toml:2:1: ...".
  template <class F>
  std::string refusal(const std::string& content, const F& f) {
    const std::string message = message_of<InputError>([&] { f(parse(content)); });
    const std::string prefix = folder().string() + "/";
    EXPECT_THAT(message, StartsWith(prefix));
    return without_excerpt(message.substr(prefix.size()));
  }
};

TEST_F(TomlReaderTest, ReadsWhatIsThere) {
  const TomlReader root = parse(R"(
title = "Pin joint"
chains = 4
limit = "100 mm^3"
share = 0.25
cycles = [1, 2.5, "300"]
[prior.k]
distribution = "flat"
)");
  EXPECT_EQ(root.required_text("title"), "Pin joint");
  EXPECT_EQ(root.integer("chains", 1, 10), 4);
  EXPECT_DOUBLE_EQ(root.required_quantity("limit", "m^3").si(), 1e-7);
  EXPECT_EQ(root.required_quantity("limit", "m^3").unit.text, "mm^3");
  EXPECT_EQ(root.quantity("share", "1")->si(), 0.25);
  const auto cycles = root.quantities("cycles", "1");
  ASSERT_EQ(cycles.size(), 3u);
  EXPECT_EQ(cycles[1].si(), 2.5);
  EXPECT_EQ(cycles[2].si(), 300);
  EXPECT_EQ(root.quantities("share", "1").size(), 1u);
  EXPECT_EQ(
      root.required_table("prior").required_table("k").choice("distribution", {"flat", "normal"}),
      "flat");
  EXPECT_THAT(root.keys(), ElementsAre("title", "chains", "limit", "share", "cycles", "prior"));
  EXPECT_TRUE(root.is_text("title"));
  EXPECT_FALSE(root.is_text("chains"));
  root.finish();

  EXPECT_FALSE(root.has("absent"));
  EXPECT_FALSE(root.text("absent"));
  EXPECT_FALSE(root.integer("absent", 0, 1));
  EXPECT_FALSE(root.quantity("absent", "m"));
  EXPECT_TRUE(root.quantities("absent", "m").empty());
  EXPECT_FALSE(root.table("absent"));
}

TEST_F(TomlReaderTest, ReadsOneTextOrAList) {
  const TomlReader root = parse("one = \"A\"\nmore = [\"A\", \"B\"]\nmixed = [\"A\", 2]\n");
  EXPECT_THAT(root.texts("one"), ElementsAre("A"));
  EXPECT_THAT(root.texts("more"), ElementsAre("A", "B"));
  EXPECT_TRUE(root.texts("absent").empty());
  EXPECT_THAT(message_of<InputError>([&] { root.texts("mixed"); }),
              HasSubstr("mixed: must be a text in quotes, or a list of them"));
}

TEST_F(TomlReaderTest, FilesThatAreNoStudies) {
  const auto message = [](const std::filesystem::path& file) {
    return message_of<InputError>([&] { TomlReader::parse_file(file); });
  };
  EXPECT_THAT(message(folder() / "absent.toml"), HasSubstr("no such file"));
  EXPECT_THAT(message(folder()), HasSubstr("is a folder"));
  EXPECT_THAT(message(write("empty.toml", "# nothing\n")), HasSubstr("empty.toml is empty"));
  EXPECT_THAT(message(write("bad.toml", "a = 1\nb = = 2\n")), HasSubstr("bad.toml:2:5: "));
  EXPECT_THAT(message(write("twice.toml", "a = 1\na = 2\n")), HasSubstr("twice.toml:2:"));
}

// Each of these broke an assertion of toml++ 3.3, ran out of stack, or is no file.
TEST_F(TomlReaderTest, TextThatTripsTheParser) {
  const auto message = [&](const std::string& content) {
    const auto file = write("trip.toml", content);
    return message_of<InputError>([&] { TomlReader::parse_file(file); });
  };
  EXPECT_THAT(message("a = 1\n[.=\n"), HasSubstr("trip.toml:2: invalid TOML"));
  EXPECT_THAT(message("a = 1\n\n[[=]]\nb = 2\n"), HasSubstr("trip.toml:3: invalid TOML"));
  EXPECT_THAT(message("a = 1\nb = [}\n"), HasSubstr("trip.toml:2"));
  std::string key = "k", nested = "a = ";
  for (int i = 0; i < 50'000; ++i) key += ".k";
  EXPECT_THAT(message("a = 1\n" + key + " = 1\n"),
              HasSubstr("trip.toml:2: the key has more than 32"));
  EXPECT_THAT(message("\n\n[" + key + "]\n"), HasSubstr("trip.toml:3: the key has more than 32"));
  EXPECT_THAT(message("a = { " + key + " = 1 }\n"), HasSubstr("the key has more than 32"));
  for (int i = 0; i < 50'000; ++i) nested += "{ a = ";
  EXPECT_THAT(message(nested), HasSubstr("trip.toml:1:"));
  EXPECT_THAT(message("a = " + std::string(50'000, '[')), HasSubstr("trip.toml:1:"));
  EXPECT_THAT(message("a = 1\n#" + std::string(1 << 20, 'x')), HasSubstr("larger than 1 MB"));
  EXPECT_THAT(message_of<InputError>([&] { TomlReader::parse_file("/dev/null"); }),
              HasSubstr("a pipe or a device"));
}

TEST_F(TomlReaderTest, DotsThatAreNoKeys) {
  const std::string dots(1000, '.');
  std::string numbers;
  for (int i = 0; i < 1000; ++i) numbers += "1.5, ";
  const TomlReader root =
      parse("# " + dots + "\na = \"" + dots + "\"\nb = '" + dots + "'\nc = \"\"\"\n" + dots +
            "\\\"\n" + dots + "\"\"\"\nd = [" + numbers + "]\n[e.\"" + dots + "\".f]\ng = 1\n");
  EXPECT_EQ(root.required_text("a"), dots);
  EXPECT_EQ(root.required_text("b"), dots);
  EXPECT_EQ(root.quantities("d", "1").size(), 1000U);
  EXPECT_TRUE(root.table("e")->table(dots)->table("f")->has("g"));
}

TEST_F(TomlReaderTest, NamesPlaceAndKey) {
  const auto expect = [&](const std::string& content, const auto& read, const std::string& start) {
    EXPECT_THAT(refusal(content, read), StartsWith(start));
  };
  using R = const TomlReader&;
  expect(
      "a = 1\nt = 5\n", [](R r) { r.text("t"); }, "a.toml:2:5: t: must be a text");
  expect(
      "a = 1\n", [](R r) { r.required_text("t"); }, "a.toml:1:1: t: is missing");
  expect(
      "n = 1.5\n", [](R r) { r.integer("n", 1, 9); }, "a.toml:1:5: n: must be a whole number");
  expect(
      "n = 10\n", [](R r) { r.integer("n", 1, 9); },
      "a.toml:1:5: n: 10 is out of range; use 1 to 9");
  expect(
      "n = 0\n", [](R r) { r.integer("n", 1, 9); }, "a.toml:1:5: n: 0 is out of range");
  expect(
      "a = 1\n", [](R r) { r.required_table("t"); }, "a.toml:1:1: t: is missing (a table)");
  expect(
      "\nt = 1\n", [](R r) { r.table("t"); }, "a.toml:2:5: t: must be a table");
  expect(
      "a = 1\n[x.y]\nt = 5\n", [](R r) { r.table("x")->table("y")->text("t"); },
      "a.toml:3:5: x.y.t: must be a text");
  expect(
      "a = 1\n[x]\nb = 2\n", [](R r) { r.table("x")->required_text("t"); },
      "a.toml:2:1: x.t: is missing");
  expect(
      "a = 1\n[x]\nb = 2\n", [](R r) { r.table("x")->fail("", "is wrong"); },
      "a.toml:2:1: [x]: is wrong");
  expect(
      "a = 1\nx = { b = 2 }\n", [](R r) { r.table("x")->required_text("t"); },
      "a.toml:2:5: x.t: is missing");
  // A table that only dotted keys made.
  expect(
      "a = 1\nx.b = 2\n", [](R r) { r.table("x")->required_text("t"); }, "a.toml:2:1: x.t: ");
  expect(
      "a = 1\n[x.y]\nb = 2\n", [](R r) { r.table("x")->required_text("t"); }, "a.toml:2:");
}

TEST_F(TomlReaderTest, ChoiceNamesTheNearest) {
  EXPECT_EQ(
      refusal("f = \"nomal\"\n",
              [](const auto& r) {
                r.choice("f", {"lognormal", "normal", "t"});
              }),
      "a.toml:1:5: f: 'nomal' is not allowed; use one of lognormal, normal, t (nearest: 'normal')");
}

TEST_F(TomlReaderTest, QuantitiesThatAreNone) {
  const auto message = [&](const std::string& value, const std::string& si) {
    return refusal("q = " + value + "\n", [&](const auto& r) { r.quantities("q", si); });
  };
  EXPECT_EQ(message("5", "mm"), "a.toml:1:5: q: 5 has no unit (write one like \"5 mm\")");
  EXPECT_THAT(message("\"5\"", "m"), StartsWith("a.toml:1:5: q: '5' has no unit"));
  EXPECT_THAT(message("\"5 s\"", "m"), HasSubstr("q: unit 's' has the wrong dimension"));
  EXPECT_THAT(message("\"5 parsnips\"", "m"), HasSubstr("q: 'parsnips' is not a unit"));
  EXPECT_THAT(message("\"many\"", "m"), HasSubstr("q: 'many' is not a number"));
  EXPECT_THAT(message("true", "1"), HasSubstr("q: must be a number"));
  EXPECT_THAT(message("2026-01-01", "1"), HasSubstr("q: must be a number"));
  EXPECT_THAT(message("nan", "1"), HasSubstr("q: must be finite"));
  EXPECT_THAT(message("-inf", "1"), HasSubstr("q: must be finite"));
  EXPECT_THAT(message("\"1e308 km\"", "m"), HasSubstr("q: '1e308 km' is infinite"));
  EXPECT_THAT(message("[1, \"2 m\"]", "1"), HasSubstr("q: entry 2: unit 'm' has the wrong"));
  EXPECT_THAT(message("[[1]]", "1"), HasSubstr("q: entry 1: must be a number"));
  EXPECT_THAT(message("{ a = 1 }", "1"), HasSubstr("q: must be a number"));
}

TEST_F(TomlReaderTest, FinishRefusesWhatNobodyAskedFor) {
  EXPECT_EQ(refusal("lowr = 1\n",
                    [](const auto& r) {
                      r.quantity("lower", "1");
                      r.quantity("upper", "1");
                      r.finish();
                    }),
            "a.toml:1:8: lowr: unknown key; did you mean 'lower'? (possible: lower, upper)");
  EXPECT_EQ(
      refusal("[prior.k]\nlw = \"flat\"\n",
              [](const auto& r) {
                r.required_table("prior").required_table("k").text("distribution");
                r.finish();
              }),
      "a.toml:2:6: prior.k.lw: unknown key; did you mean 'distribution'? (possible: distribution)");
  EXPECT_THAT(refusal("a = 1\n", [](const auto& r) { r.finish(); }),
              HasSubstr("a: unknown key; no keys are allowed here"));
  // The first in the order of the file.
  EXPECT_THAT(refusal("z = 1\na = 2\n", [](const auto& r) { r.finish(); }), HasSubstr(": z: "));
}

}  // namespace
}  // namespace wearwell
