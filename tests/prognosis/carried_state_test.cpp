// state.bin: what is written is read back to the bit; what is not what was written is refused, whatever it is.
#include "wearwell/prognosis/carried_state.h"

#include <gmock/gmock.h>
#include <zlib.h>

#include <bit>
#include <cmath>
#include <random>

#include "wearwell/base/error.h"
#include "wearwell/base/sha1.h"
#include "wearwell/models/registry.h"
#include "wearwell/prognosis/carry.h"
#include "wearwell/study/inference_data.h"

namespace wearwell::prognosis {
namespace {

using testing::HasSubstr;

CarriedState example() {
  CarriedState state;
  state.model = "formula";
  state.source.study = {"study.toml", "title = \"\xc3\xa4\"\n"};
  Table table;
  table.source = "a.csv";
  table.layout.text = "commas";
  table.rows = 3;
  table.columns = {{"time", true, {1, NAN, -0.0}, {}, "h"},
                   {"unit", false, {}, {"J7", "", "\n,\""}}};
  table.columns[1].marks = NumberMarks{',', '.'};
  state.source.tables["as read\na.csv"] = table;
  state.parameters = {"k", "sigma"};
  WeightedDraws& draws = state.posterior;
  draws.values.resize(2, 2);
  draws.values << 1e-300, 2, 3, 0.1;
  draws.weights = Eigen::Vector2d(0.25, 0.75);
  draws.lower = {draws.values, draws.values};
  draws.upper = {2 * draws.values, draws.values};
  draws.cells = {draws.weights, draws.values, draws.values, draws.values};
  return state;
}

// With a right checksum over what is no state.
std::string signed_again(std::string bytes) {
  bytes.resize(bytes.size() - 40);
  return bytes + sha1_of(bytes);
}

TEST(CarriedState, IsReadBackToTheBit) {
  const CarriedState state = example();
  const std::string bytes = state_bytes(state);
  const CarriedState again = state_of_bytes(bytes, "state.bin");
  EXPECT_EQ(state_bytes(again), bytes);
  EXPECT_EQ(again.model, "formula");
  EXPECT_EQ(again.source.study.text, state.source.study.text);
  const Table& table = again.source.tables.at("as read\na.csv");
  EXPECT_EQ(table.columns[1].text, (std::vector<std::string>{"J7", "", "\n,\""}));
  EXPECT_EQ(table.columns[1].marks->thousands, '.');
  EXPECT_TRUE(std::signbit(table.columns[0].numbers[2]));
  EXPECT_EQ(again.posterior.upper[0], state.posterior.upper[0]);
  EXPECT_EQ(again.posterior.cells.mass, state.posterior.cells.mass);
}

// docs/how-to/state.md: where the version stands, and in which order its bytes.
TEST(CarriedState, BeginsAsTheDocumentationSays) {
  const std::string bytes = state_bytes(example());
  EXPECT_EQ(bytes.substr(0, 20), std::string("wearwell state\r\n\x01\0\0\0", 20));
}

TEST(CarriedState, RefusesAnotherVersion) {
  std::string bytes = state_bytes(example());
  bytes[16] = 2;
  try {
    state_of_bytes(signed_again(bytes), "r/state.bin");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("r/state.bin has version 2"));
  }
}

TEST(CarriedState, RefusesEveryTruncationAndEveryChangedBit) {
  const std::string bytes = state_bytes(example());
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_THROW(state_of_bytes(bytes.substr(0, n), "s"), InputError) << n;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string changed = bytes;
    changed[bit / 8] = static_cast<char>(changed[bit / 8] ^ (1 << (bit % 8)));
    EXPECT_THROW(state_of_bytes(changed, "s"), InputError) << bit;
  }
}

// Hostile bytes come with a checksum of their own: here around a body that was changed.
std::string around(const std::string& body) {
  const std::string head = state_bytes(example()).substr(0, 20);
  uLongf size = compressBound(body.size());
  std::string packed(size, '\0');
  EXPECT_EQ(compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                      reinterpret_cast<const Bytef*>(body.data()), body.size(), 1),
            Z_OK);
  packed.resize(size);
  std::string length;
  for (int i = 0; i < 8; ++i) length.push_back(static_cast<char>(body.size() >> (8 * i)));
  const std::string bytes = head + length + packed;
  return bytes + sha1_of(bytes);
}

std::string body_of(const std::string& bytes) {
  std::string body(4096, '\0');
  uLongf size = body.size();
  const std::string packed = bytes.substr(28, bytes.size() - 68);
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(body.data()), &size,
                       reinterpret_cast<const Bytef*>(packed.data()), packed.size()),
            Z_OK);
  body.resize(size);
  return body;
}

TEST(CarriedState, ReadsMutationsOrRefusesThem) {
  const std::string body = body_of(state_bytes(example()));
  EXPECT_EQ(state_bytes(state_of_bytes(around(body), "s")), state_bytes(example()));
  std::mt19937 random(7);
  int read = 0, refused = 0;
  for (int run = 0; run < 25'000; ++run) {
    std::string changed = body;
    for (int k = 0; k < 1 + run % 3; ++k) {
      const std::size_t at = random() % changed.size();
      // Lengths lie in the high bytes of few numbers: all bits set are the worst of them.
      changed[at] = static_cast<char>(random() % 2 ? random() : 0xff);
    }
    if (run % 7 == 0) changed.resize(random() % changed.size());
    try {
      const CarriedState state = state_of_bytes(around(changed), "s");
      EXPECT_EQ(state.parameters.size(), static_cast<std::size_t>(state.posterior.values.cols()));
      EXPECT_NEAR(state.posterior.weights.sum(), 1, 1e-6);
      ++read;
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(read, 1000);
  EXPECT_GT(refused, 1000);
}

TEST(CarriedState, RefusesLengthsThatAreNotThere) {
  std::string bytes = state_bytes(example());
  for (int i = 20; i < 28; ++i) bytes[static_cast<std::size_t>(i)] = '\xff';
  EXPECT_THROW(state_of_bytes(signed_again(bytes), "s"), InputError);
}

TEST(CarriedState, SaysThatAFolderHasNone) {
  try {
    read_state(PROJECT_SOURCE_DIR "/examples/joint");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("has no state.bin"));
  }
}

// Whatever a study reads, of files in any form, it reads again from its state alone.
class EveryExample : public testing::TestWithParam<const char*> {};
TEST_P(EveryExample, ReadsBackFromItsStateAlone) {
  const Source source =
      source_of(std::string(PROJECT_SOURCE_DIR "/examples/") + GetParam() + ".toml");
  const auto study = read_study(source, all_models());
  const PosteriorStudy& first = require_posterior_study(*study);
  CarriedState state;
  state.model = first.model;
  state.source = carried_source(source, first);
  for (const Parameter& each : first.parameters) state.parameters.push_back(each.name);
  state.posterior.values = Points::Ones(1, static_cast<Eigen::Index>(first.parameters.size()));
  state.posterior.weights = Eigen::VectorXd::Ones(1);
  const CarriedState again = state_of_bytes(state_bytes(state), "state.bin");
  EXPECT_TRUE(again.source.folder().empty());
  const auto read = read_study(again.source, all_models());
  const PosteriorStudy& second = require_posterior_study(*read);
  EXPECT_EQ(second.observed.size(), first.observed.size());
  for (std::size_t i = 0; i < first.observed.size(); ++i)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(second.observed[i]),
              std::bit_cast<std::uint64_t>(first.observed[i]));
  EXPECT_EQ(second.equation, first.equation);
  std::vector<double> x;
  for (const Parameter& each : first.parameters) x.push_back(each.start);
  EXPECT_EQ(second.likelihood(second.data_rows)->value(x),
            first.likelihood(first.data_rows)->value(x));
}
INSTANTIATE_TEST_SUITE_P(, EveryExample,
                         testing::Values("joint/study", "joint/pointwise", "bearing/study",
                                         "fatigue/study", "staircase/study", "spring/case1",
                                         "repairable/study", "degradation/study",
                                         "degradation/lines", "life/study", "accelerated/study",
                                         "formula/study", "warranty/study", "messy/german_excel",
                                         "messy/logger", "messy/workbook", "messy/rig"),
                         [](const auto& each) {
                           std::string name = each.param;
                           for (char& c : name) c = c == '/' ? '_' : c;
                           return name;
                         });

}  // namespace
}  // namespace wearwell::prognosis
