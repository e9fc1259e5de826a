// New rows join those that a state holds: what comes out depends on which rows there are, on nothing else.
#include "wearwell/prognosis/new_data.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/input/toml_edit.h"
#include "wearwell/models/registry.h"
#include "wearwell/prognosis/carry.h"
#include "wearwell/prognosis/reweighted.h"
#include "wearwell/study/inference_data.h"

namespace wearwell::prognosis {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const std::string laser_study = R"(model = "formula"
[data]
file = "laser.csv"
[data.columns]
increase = { column = "increase_percent", unit = "%" }
time     = { column = "hours", unit = "h" }
laser    = "laser"
[formula]
growth = "rate * time"
[likelihood.increase]
family = "normal"
mean   = "growth"
sd     = "sigma"
[prior]
rate  = { distribution = "lognormal", median = "0.002 %/h", log_sd = 1 }
sigma = { distribution = "half-normal", scale = "0.5 %" }
scatter = { distribution = "half-normal", scale = 0.5 }
[random_effects.laser]
rate = { distribution = "lognormal", log_sd = "scatter" }
[predict]
along = "time"
)";

class NewData : public ScratchTest {
 protected:
  // A study with its table, carried.
  Source source(const std::string& study, const std::string& file, const std::string& table) {
    write(file, table);
    const Source read = source_of(write("study.toml", study));
    const auto known = read_study(read, all_models());
    return carried_source(read, require_posterior_study(*known));
  }
  Source lasers() {
    return source(
        laser_study, "laser.csv",
        "laser,hours,increase_percent\nb10,250,0.5\nb10,500,0.9\nb9,250,0.4\nb9,500,1.1\n");
  }
  Table rows(const std::string& text) { return wearwell::read_table(write("new.csv", text)); }
  JoinedData join(const Source& to, const std::string& text, Repeated repeated = Repeated::ask) {
    return joined_data(to, {rows(text)}, repeated);
  }
  std::string refused(const Source& to, const std::string& text) {
    return message_of<InputError>([&] { join(to, text); });
  }
};

std::string bytes_of(const Source& source) {
  CarriedState state;
  state.source = source;
  state.parameters = {"k"};
  state.posterior.values = Points::Ones(1, 1);
  state.posterior.weights = Eigen::VectorXd::Ones(1);
  return state_bytes(state);
}

TEST_F(NewData, PutsUnitsInTheirNaturalOrderAndReadingsAlongTheirLives) {
  const JoinedData joined =
      join(lasers(), "hours,laser,increase_percent\n750,b10,1.4\n100,b9,0.2\n250,c1,0.3\n");
  const Table& table = data_table(joined.source);
  EXPECT_THAT(table.column("laser").text, ElementsAre("b9", "b9", "b9", "b10", "b10", "b10", "c1"));
  EXPECT_THAT(table.column("hours").numbers, ElementsAre(100, 250, 500, 250, 500, 750, 250));
  EXPECT_EQ(joined.counted, 3u);
  EXPECT_THAT(joined.fresh, ElementsAre(0, 5, 6));
  EXPECT_THAT(joined.contradictions, IsEmpty());
}

// Rows that a monitor has marked: it found that they do not follow the forecast.
TEST_F(NewData, InDoubtAreNotLearnedSilently) {
  const Source first = lasers();
  EXPECT_THAT(refused(first, "laser,hours,increase_percent,doubt\nb9,750,1.6,0\nb10,750,9.4,1\n"),
              HasSubstr("1 of 2 rows have doubt = 1"));
  EXPECT_EQ(join(first, "laser,hours,increase_percent,doubt\nb9,750,1.6,0\n").counted, 1u);
  EXPECT_EQ(join(first, "laser,hours,increase_percent\nb9,750,1.6\nb10,750,9.4\n").counted, 2u);
}

// Whatever came first, and in how many parts.
TEST_F(NewData, HaveNoOrder) {
  const Source first = lasers();
  std::vector<std::string> lines;
  for (int laser = 1; laser <= 4; ++laser) {
    for (int reading = 1; reading <= 5; ++reading)
      lines.push_back("b" + std::to_string(7 + laser) + "," + std::to_string(1000 + 10 * reading) +
                      "," + std::to_string(1 + 0.1 * reading + laser) + "\n");
  }
  const std::string heading = "laser,hours,increase_percent\n";
  std::string all = heading;
  for (const std::string& line : lines) all += line;
  const std::string expected = bytes_of(join(first, all).source);
  std::mt19937 random(3);
  for (int run = 0; run < 20; ++run) {
    std::shuffle(lines.begin(), lines.end(), random);
    Source now = first;
    for (std::size_t at = 0; at < lines.size();) {
      std::string part = heading;
      for (std::size_t n = 1 + random() % 6; n-- > 0 && at < lines.size(); ++at) {
        part += lines[at];
        if (random() % 4 == 0) part += lines[random() % (at + 1)];  // given again
      }
      now = join(now, part).source;
    }
    EXPECT_EQ(bytes_of(now), expected);
  }
}

TEST_F(NewData, CountAReadingOnce) {
  const JoinedData joined =
      join(lasers(), "laser,hours,increase_percent\nb9,250,0.40\nb9,750,1.6\nb9,750,1.6\n");
  EXPECT_EQ(joined.repeated, 2u);
  EXPECT_EQ(joined.counted, 1u);
  EXPECT_EQ(data_table(joined.source).rows, 5u);
}

TEST_F(NewData, TellAnotherNumberAtTheSamePlace) {
  const JoinedData joined =
      join(lasers(), "laser,hours,increase_percent\nb9,250,0.7\nb9,600,1.2\nb9,600,1.3\n");
  ASSERT_THAT(joined.contradictions, SizeIs(2));
  EXPECT_EQ(joined.contradictions[0].place, "laser b9 at hours = 250");
  EXPECT_EQ(joined.contradictions[0].why,
            "increase_percent = 0.7, where increase_percent = 0.4 is already known");
  EXPECT_EQ(joined.contradictions[1].place, "laser b9 at hours = 600");
  EXPECT_EQ(joined.counted, 3u);  // not swallowed
}

TEST_F(NewData, ComeInOtherUnits) {
  const JoinedData joined =
      join(lasers(), "laser,time [d],increase [1],operator\nb9,2,0.011,Ann\n");
  const Table& table = data_table(joined.source);
  const auto& hours = table.column("hours").numbers;
  EXPECT_EQ(std::count(hours.begin(), hours.end(), 48.0), 1);
  const auto& increase = table.column("increase_percent").numbers;
  EXPECT_EQ(std::count(increase.begin(), increase.end(), 1.1), 2);
  EXPECT_THAT(joined.notes, testing::Contains("column 'time [d]' was converted from d to h"));
  EXPECT_THAT(joined.notes,
              testing::Contains("column 'operator' is not in the study's data and is ignored"));
}

TEST_F(NewData, AreRefusedWhereTheyDoNotFit) {
  const Source to = lasers();
  EXPECT_THAT(refused(to, "laser,hours\nb9,2\n"), HasSubstr("has no column 'increase_percent'"));
  EXPECT_THAT(refused(to, "laser,time,increase_percent\nb9,2,1\n"),
              HasSubstr("column 'time': has no unit and may be in any unit; the study's data have "
                        "'hours' in h"));
  EXPECT_THAT(refused(to, "laser,time [mm],increase_percent\nb9,2,1\n"),
              HasSubstr("these units have different dimensions"));
  EXPECT_THAT(refused(to, "laser,hours,increase_percent\nb9,two,1\n"), HasSubstr("'two'"));
  EXPECT_THAT(refused(to, "laser,time [h],time [d],increase_percent\nb9,2,2,1\n"),
              HasSubstr("may be 'time [h]' or 'time [d]'"));
}

// Two specimens may come out alike.
TEST_F(NewData, ThatEqualATestMayBeAnother) {
  const Source tests = source(
      "model = \"sn\"\n[data]\nfile = \"t.csv\"\n[data.columns]\nalternating_stress = \"S [MPa]\"\n"
      "life = \"cycles\"\nstatus = \"status\"\n[law]\nmean_stress = \"none\"\n",
      "t.csv", "S [MPa],cycles,status\n300,2e5,failure\n250,1e6,failure\n200,2e6,runout\n");
  const std::string again = "S [MPa],cycles,status\n200,2e6,runout\n210,1.5e6,failure\n";
  EXPECT_THAT(refused(tests, again),
              HasSubstr("new.csv, row 1 equals row 3 of the known data: it may be the same test "
                        "again, or another one"));
  EXPECT_EQ(join(tests, again, Repeated::once).counted, 1u);
  EXPECT_EQ(data_table(join(tests, again, Repeated::another).source).rows, 5u);
}

// The query sees old and new rows together: an inspection of which half came before is averaged over both.
TEST_F(NewData, GoThroughTheQueryOfTheStudy) {
  const Source joint = source(
      "model = \"archard-joint\"\n[data]\nfile = \"j.csv\"\nsql = \"select cycles, avg(v) as "
      "volume "
      "from data group by cycles order by cycles\"\n[data.columns]\ncycles = \"cycles\"\n"
      "volume = { column = \"volume\", unit = \"mm^3\" }\n[conditions]\nwork_per_cycle = \"6 N "
      "m\"\n"
      "[likelihood]\nfamily = \"normal\"\n",
      "j.csv", "angle,cycles,v\n0,100,2\n\"pi\",100,4\n0,200,6\n");
  const JoinedData joined = join(joint, "angle,cycles,v\n\"pi\",200,10\n0,100,2\n0,300,12\n");
  EXPECT_EQ(joined.repeated, 1u);
  const Table& table = data_table(joined.source);
  EXPECT_THAT(table.column("volume").numbers, ElementsAre(3, 8, 12));
  ASSERT_THAT(joined.contradictions, SizeIs(1));
  EXPECT_EQ(joined.contradictions[0].why, "volume = 8, where volume = 6 is already known");
}

// Weights times the ratio of two densities are the other posterior.
TEST_F(NewData, MoveThePosteriorByItsWeights) {
  struct Normal final : LogDensity {
    explicit Normal(double mean) : mean_(mean) {}
    int dimension() const override { return 1; }
    double value(std::span<const double> x) const override {
      return -0.5 * (x[0] - mean_) * (x[0] - mean_);
    }
    double value_and_gradient(std::span<const double> x, std::span<double> g) const override {
      g[0] = mean_ - x[0];
      return value(x);
    }
    double mean_;
  };
  const auto of = [](double mean) {
    Parameter x;
    x.name = "x";
    x.si = "1";
    x.prior = make_distribution(Uniform{}, -20, 20);
    return Posterior({x}, std::make_shared<Normal>(mean));
  };
  WeightedDraws draws;
  draws.values.resize(8001, 1);
  draws.weights.resize(8001);
  for (int i = 0; i <= 8000; ++i) {
    draws.values(i, 0) = -10 + 0.0025 * i;
    draws.weights[i] = std::exp(-0.5 * draws.values(i, 0) * draws.values(i, 0));
  }
  draws.weights /= draws.weights.sum();
  const Reweighted moved = reweighted(draws, of(0), of(1.5));
  EXPECT_NEAR(moved.draws.weights.dot(draws.values.col(0)), 1.5, 1e-9);
  EXPECT_NEAR(moved.kept, 1, 1e-9);
  EXPECT_TRUE(resolves(moved));
}

TEST(WithPredict, ChangesWhatIsAskedAndNothingElse) {
  const TextFile study{
      "s.toml",
      "[predict] # now\nb_lives = [1,\n  2] # two\nlimit = \"1 \xc2\xb5m\"\nrisk = 0.1\n"
      "[prior]\nk = 1\n"};
  EXPECT_EQ(with_predict(study, {{"b_lives", "[5]"}, {"survived", "\"1 h\""}}).text,
            "[predict] # now\nb_lives = [5]\nsurvived = \"1 h\"\n # two\nlimit = \"1 \xc2\xb5m\"\n"
            "risk = 0.1\n[prior]\nk = 1\n");
  EXPECT_EQ(with_predict({"s", "a = 1\n"}, {{"risk", "0.1"}}).text,
            "a = 1\n\n[predict]\nrisk = 0.1\n");
  EXPECT_THROW(with_predict({"s", "predict = { risk = 0.2 }\n"}, {{"risk", "0.1"}}), InputError);
}

}  // namespace
}  // namespace wearwell::prognosis
