#include "wearwell/models/clutch/clutch_model_file.h"

#include <gmock/gmock.h>

#include "models/clutch/sample_campaign.h"
#include "support/json_mutations.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/clutch/cycle_sum.h"

namespace wearwell::clutch {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

WearModel odd_model() {
  WearModel model = constant_model(mm3_per_MJ / 3, 0, {0.1 + 0.2, 4, 78e6 / 7, 6e6});
  model.title = "A \"title\" \u00e9";
  model.r = 1.2;
  model.q = 0.7;
  model.terms.push_back({"ds*Td*Mz", 1, 1, 1, 1.0 / 7, 2e6 / 3, -22 * mm3_per_MJ});
  model.covariance = Eigen::Matrix2d{{1e-32 / 3, 2e-33}, {2e-33, 5e-32 / 7}};
  model.run_in_covariance.setRandom();
  model.scatter = {ScatterKind::conditions, {1e-15, 2e-16 / 3, 3, 4, 5e-300}};
  model.scatter_floor = 1e-16 / 9;
  model.plate_sd = 0.041 / 3;
  model.replicates = {{{0.3, 0.4, {{0, 0, 0, 1.0 / 3}, {3, 0, 0, -1e-17}}}, {0, 1, 2, 3}}};
  return model;
}

class ClutchModelFile : public ScratchTest {};

TEST_F(ClutchModelFile, LosesNoBit) {
  const WearModel model = odd_model();
  const auto file = write("model.json", to_json(model).dump(1));
  const WearModel read = read_model(file);
  EXPECT_EQ(to_json(read), to_json(model));
  EXPECT_EQ(read.title, model.title);
  EXPECT_EQ(read.terms[1].minimum, model.terms[1].minimum);
  EXPECT_EQ(read.covariance, model.covariance);
  EXPECT_EQ(read.run_in_covariance, model.run_in_covariance);
  EXPECT_EQ(read.scatter.p, model.scatter.p);
  EXPECT_EQ(read.replicates[0].w.monomials[1].coefficient, -1e-17);
  const OperatingPoint at{200, 50, 170, 2};
  EXPECT_EQ(read.polynomial()(at), model.polynomial()(at));
  EXPECT_EQ(read.replicates[0].w(at), model.replicates[0].w(at));
}

TEST_F(ClutchModelFile, RefusesByWhatIsWrong) {
  const auto refused = [&](auto change) {
    auto json = to_json(odd_model());
    change(json);
    const auto file = write("model.json", json.dump());
    return message_of<InputError>([&] { read_model(file); });
  };
  EXPECT_THAT(refused([](auto& j) { j["format"] = "else"; }),
              HasSubstr("model.json: it is not a wearwell clutch wear model"));
  EXPECT_THAT(refused([](auto& j) { j["version"] = 2; }), HasSubstr("reads version 1"));
  EXPECT_THAT(refused([](auto& j) { j.erase("plate_sd"); }), HasSubstr("plate_sd"));
  EXPECT_THAT(refused([](auto& j) { j["map"]["terms"][1]["ds"] = 2; }),
              HasSubstr("degree above 3"));
  EXPECT_THAT(refused([](auto& j) { j["map"]["terms"][1]["range"] = 0; }),
              HasSubstr("range of a term must be positive"));
  EXPECT_THAT(refused([](auto& j) { j["map"]["covariance"].erase(0); }),
              HasSubstr("covariance has the wrong size"));
  EXPECT_THAT(refused([](auto& j) { j["scatter"]["p"].erase(0); }),
              HasSubstr("wrong number of parameters"));
  EXPECT_THAT(refused([](auto& j) { j["run_in"]["fast_energy"] = 0; }),
              HasSubstr("energies must be positive"));
  EXPECT_THAT(message_of<InputError>([&] { read_model(write("model.json", "{")); }),
              HasSubstr("model.json"));
  EXPECT_THAT(message_of<InputError>([&] { read_model(folder() / "none.json"); }),
              HasSubstr("no such file"));
}

// Whatever is changed in a file: it is read with finite numbers, or refused by file and key.
template <class Read>
void expect_read_or_refused(const std::string& what, const Read& read, int& refused) {
  try {
    read();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr(".json"), Not(HasSubstr("json.exception")), Not(HasSubstr("\x1b"))))
        << what;
    ++refused;
  } catch (const std::exception& error) {
    ADD_FAILURE() << what << ": " << error.what();
  }
}

TEST_F(ClutchModelFile, ReadsOrRefusesWhateverIsChanged) {
  int refused = 0;
  mutations(to_json(odd_model()), [&](const std::string& what, const nlohmann::ordered_json& json) {
    const auto file = write("model.json", json.dump());
    const auto read = [&] {
      const WearModel model = read_model(file);
      EXPECT_TRUE(model.covariance.allFinite() && model.run_in_covariance.allFinite()) << what;
      EXPECT_TRUE(model.worn_out > 0 && std::isfinite(model.worn_out)) << what;
      for (const ModelTerm& term : model.terms)
        EXPECT_TRUE(std::isfinite(term.coefficient) && std::isfinite(term.minimum)) << what;
      CycleSum sum(model, true);
    };
    expect_read_or_refused(what, read, refused);
  });
  EXPECT_GT(refused, 300);
}

TEST_F(ClutchModelFile, ReadsOrRefusesAnyState) {
  PlateWear one, two;
  one.plate = 1;
  two.plate = 2;
  for (PlateWear* p : {&one, &two}) {
    p->cycles = p->last_number = 10;
    p->energy = 1e6;
    p->volume = 1e-6;
    p->variance = 1e-15;
    p->replicates = Eigen::ArrayXd{{1e-6, 2e-6}};
  }
  const std::string whole = state_text({one, two}, "abc");
  int refused = 0;
  mutations(nlohmann::ordered_json::parse(whole), [&](const std::string& what, const auto& json) {
    const auto file = write("state.json", json.dump());
    const auto read = [&] {
      for (const PlateWear& p : read_state(file, "abc", 2)) {
        EXPECT_TRUE(std::isfinite(p.sd()) && std::isfinite(p.energy) && p.energy >= 0) << what;
        EXPECT_TRUE(p.replicates.size() == 2 && p.replicates.isFinite().all()) << what;
      }
    };
    expect_read_or_refused(what, read, refused);
  });
  EXPECT_GT(refused, 100);
  auto twice = nlohmann::ordered_json::parse(whole);
  twice["plates"][1]["plate"] = 1;
  const auto file = write("state.json", twice.dump());
  EXPECT_THAT(message_of<InputError>([&] { read_state(file, "abc", 2); }),
              HasSubstr("plates[1] is plate 1 a second time"));
  twice["plates"][1]["variance"] = nullptr;
  write("state.json", twice.dump());
  EXPECT_THAT(message_of<InputError>([&] { read_state(file, "abc", 2); }),
              HasSubstr("plates[1].variance should be a number, and is null"));
}

TEST_F(ClutchModelFile, StateLosesNoBit) {
  PlateWear p;
  p.plate = 12;
  p.cycles = 1'000'000'007;
  p.last_number = 2'000'000'011;
  p.energy = 1e9 / 3;
  p.outliers = {3, 1'000'000'005, 2.5e9 / 3, 1e5 / 7};
  p.volume = 1e-6 / 7;
  p.variance = 1e-15 / 11;
  p.outside = {1, 2, 3, 4};
  p.outside_any = 5;
  p.clamped = 6;
  p.replicates = Eigen::ArrayXd{{1.0 / 3, 1e-300}};
  const auto file = write("state.json", state_text({p}, "abc"));
  const auto plates = read_state(file, "abc", 2);
  ASSERT_EQ(plates.size(), 1u);
  EXPECT_EQ(state_text(plates, "abc"), state_text({p}, "abc"));
  EXPECT_EQ(plates[0].energy, p.energy);
  EXPECT_EQ(plates[0].outliers.worst_ratio, p.outliers.worst_ratio);
  EXPECT_EQ(plates[0].variance, p.variance);
  EXPECT_TRUE((plates[0].replicates == p.replicates).all());
  EXPECT_THAT(message_of<InputError>([&] { read_state(file, "abd", 2); }),
              HasSubstr("belongs to another model"));
  EXPECT_THAT(message_of<InputError>([&] { read_state(file, "abc", 0); }),
              HasSubstr("it has 2 replicates, but 0 are needed"));
}

TEST_F(ClutchModelFile, StateWithoutANumberIsNamed) {
  PlateWear p;
  p.plate = 12;
  p.variance = std::numeric_limits<double>::infinity();
  EXPECT_THAT(message_of<InputError>(
                  [&] { read_state(write("state.json", state_text({p}, "abc")), "abc", 0); }),
              HasSubstr("plates[0].variance should be a number, and is null"));
}

}  // namespace
}  // namespace wearwell::clutch
