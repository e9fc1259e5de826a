#include "wearwell/input/json_reader.h"

#include <gmock/gmock.h>

#include <cmath>

#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class JsonFile : public ScratchTest {
 protected:
  std::string refused(const std::string& content) const {
    const auto file = write("a.json", content);
    return message_of<InputError>([&] { read_json(file); });
  }
};

TEST_F(JsonFile, SaysWhereItIsNoJson) {
  EXPECT_THAT(refused("{\"a\": 1,\n  oops}"),
              HasSubstr("a.json is not valid JSON: error at line 2, column 3"));
  EXPECT_THAT(refused(""), HasSubstr("line 1"));
  EXPECT_THAT(refused("{\"a\": 1e999}"), HasSubstr("a number is too large"));
  EXPECT_THAT(refused("\"\xff\""), HasSubstr("is not valid JSON"));
  EXPECT_THAT(refused(std::string(100'000, '[')), HasSubstr("nested more than 64 deep"));
  EXPECT_THAT(refused(std::string(65, '[') + std::string(65, ']')), HasSubstr("nested more than"));
  EXPECT_NO_THROW(read_json(write("b.json", std::string(64, '[') + std::string(64, ']'))));
  EXPECT_THAT(message_of<InputError>([&] { read_json(folder() / "none.json"); }),
              HasSubstr("no such file"));
  EXPECT_THAT(message_of<InputError>([&] { read_json(folder()); }), HasSubstr("is a folder"));
}

class Reader : public testing::Test {
 protected:
  const nlohmann::ordered_json json_ = nlohmann::ordered_json::parse(R"({
    "a": {"b": [1, 2.5, null], "text": "t", "yes": true, "big": 18446744073709551615, "low": -1},
    "null": null})");
  JsonReader root() const { return {json_, "f.json"}; }
  JsonReader a() const { return root().at("a"); }
  template <class F>
  static std::string refused(const F& f) {
    return message_of<InputError>(f);
  }
};

TEST_F(Reader, ReadsWhatIsThere) {
  EXPECT_EQ(a().at("text").text(), "t");
  EXPECT_TRUE(a().at("yes").flag());
  EXPECT_EQ(a().at("b").items()[1].number(), 2.5);
  EXPECT_EQ(a().at("b").numbers_or(INFINITY), (std::vector<double>{1, 2.5, INFINITY}));
  EXPECT_EQ(root().at("null").number_or(7), 7);
  EXPECT_EQ(a().at("big").natural(), 18446744073709551615u);
  EXPECT_EQ(a().at("low").integer(-1), -1);
  EXPECT_FALSE(root().find("c"));
  EXPECT_EQ(root().members()[0].first, "a");
}

TEST_F(Reader, NamesFileKeyAndWhatMayStandThere) {
  EXPECT_EQ(refused([&] { a().at("c"); }), "f.json is not what wearwell writes: a.c is missing");
  EXPECT_EQ(refused([&] { a().at("text").number(); }),
            "f.json is not what wearwell writes: a.text should be a number, and is the text 't'");
  EXPECT_EQ(refused([&] { a().at("b").numbers(); }),
            "f.json is not what wearwell writes: a.b[2] should be a finite number, and is null");
  EXPECT_THAT(refused([&] { a().at("b").text(); }),
              HasSubstr("a.b should be a text, and is a list of 3"));
  EXPECT_THAT(refused([&] { a().items(); }), HasSubstr("a should be a list, and is an object"));
  EXPECT_THAT(refused([&] { root().items(); }), HasSubstr("it should be a list"));
  EXPECT_THAT(refused([&] { a().at("text").at("x"); }), HasSubstr("a.text should be an object"));
  EXPECT_THAT(refused([&] { a().at("text").flag(); }), HasSubstr("true or false"));
  EXPECT_THAT(refused([&] {
                a().at("text").one_of({"u", "v"});
              }),
              HasSubstr("one of \"u\", \"v\", and is the text 't'"));
}

TEST_F(Reader, HoldsNumbersToTheirRange) {
  const auto b = a().at("b").items();
  EXPECT_THAT(refused([&] { b[1].integer(0); }),
              HasSubstr("a whole number, 0 or more, and is 2.5"));
  EXPECT_THAT(refused([&] { a().at("big").integer(0); }), HasSubstr("18446744073709551615"));
  EXPECT_THAT(refused([&] { a().at("low").integer(0, 5); }), HasSubstr("from 0 to 5, and is -1"));
  EXPECT_THAT(refused([&] { a().at("low").natural(); }), HasSubstr("0 or more"));
  EXPECT_THAT(refused([&] { a().at("low").number(0); }), HasSubstr("0 or more"));
  EXPECT_THAT(refused([&] { a().at("low").positive(); }), HasSubstr("positive"));
  EXPECT_EQ(b[0].integer(1, 1), 1);
}

// Keys and values come from elsewhere: neither floods the terminal nor commands it.
TEST_F(Reader, QuotesCarefully) {
  const std::string key = "\x1b[2J" + std::string(10'000, 'k'),
                    value = "\x1b]0;" + std::string(10'000, 'v');
  const nlohmann::ordered_json evil = {{key, value}};
  const std::string message = refused([&] { JsonReader(evil, "f.json").at(key).number(); });
  EXPECT_LT(message.size(), 400u);
  EXPECT_THAT(message,
              AllOf(HasSubstr("\\x1b[2Jkkk"), HasSubstr("\\x1b]0;vvv"), Not(HasSubstr("\x1b"))));
}

}  // namespace
}  // namespace wearwell
