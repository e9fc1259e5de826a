// Lives of the next part and shares failed by each mode, averaged over whole posteriors, against tests/golden/failure_modes_lives.R: dense grids, where the part's
// cumulative hazard is a sum of independent ones (separate modes) or shares have a closed form (one shape).
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "support/scratch.h"
#include "wearwell/infer/exact.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/models/formula_model/life_groups.h"

namespace wearwell::formula_model {
namespace {

struct GoldenLife {
  std::string quantity;
  double at = 0, next = 0;
};

std::vector<GoldenLife> golden_lives(const std::string& study) {
  std::ifstream in(PROJECT_SOURCE_DIR "/tests/golden/failure_modes_lives.csv");
  std::vector<GoldenLife> all;
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    std::vector<std::string> cell;
    for (std::string each; std::getline(cells, each, ',');) cell.push_back(each);
    if (cell[0] != study) continue;
    all.push_back({cell[1], std::stod(cell[2]), std::stod(cell[3])});
  }
  return all;
}

std::string text_of(const std::string& file) {
  std::ifstream in(PROJECT_SOURCE_DIR "/" + file);
  std::ostringstream all;
  all << in.rdbuf();
  return all.str();
}

class FailureModeLives : public ScratchTest {
 protected:
  void compare(const std::string& study, const std::string& table, const std::string& text) {
    write("d.csv", table);
    const Source source =
        source_of(write("study.toml", "model = \"formula\"\n[data]\nfile = \"d.csv\"\n" + text));
    root_.emplace(TomlReader::parse(source.study));
    model_ = read_formula_model(*root_, source);
    const Posterior posterior(
        model_->parameters,
        formula_likelihood(std::make_shared<const FormulaRows>(model_, model_->data.table.rows)));
    ExactSettings settings;
    settings.tolerance = 1e-4;
    settings.cells = false;
    const ExactPosterior exact =
        integrate(posterior, whitening_at(find_mode(posterior, posterior.start())), settings);
    ASSERT_EQ(exact.failure, "");
    const std::vector<GoldenLife> all = golden_lives(study);
    ASSERT_GE(all.size(), 8u);
    for (const GoldenLife& each : all)
      EXPECT_NEAR(answer(each, exact.nodes) / each.next, 1, 1e-4)
          << each.quantity << " at " << each.at;
  }

 private:
  static std::string after(const std::string& prefix, const std::string& text) {
    return text.starts_with(prefix) ? text.substr(prefix.size()) : std::string();
  }
  // "B mode 1": mode 1 alone; "B": the part.
  double answer(const GoldenLife& asked, const WeightedDraws& nodes) {
    const std::string mode = after("B ", asked.quantity) + after("failed by ", asked.quantity);
    if (asked.quantity.starts_with("failed by "))
      return of({}, nodes).life->incidence(nodes, place(mode), asked.at).distribution.mean();
    if (asked.quantity == "survival") return 1 - of({}, nodes).next.cdf(asked.at);
    return of(mode, nodes).next.quantile(asked.at / 100);
  }
  std::size_t place(const std::string& mode) const {
    const auto& modes = model_->modes->modes;
    return static_cast<std::size_t>(std::find(modes.begin(), modes.end(), mode) - modes.begin());
  }
  struct Life {
    std::shared_ptr<const LifeDistribution> life;
    LifeDistribution::Next next;
  };
  const Life& of(const std::string& mode, const WeightedDraws& nodes) {
    const auto known = lives_.find(mode);
    if (known != lives_.end()) return known->second;
    const std::uint32_t modes = mode.empty() ? ~std::uint32_t{0} : std::uint32_t{1} << place(mode);
    const auto life = life_distribution(*root_, "likelihood", model_, {}, modes);
    return lives_[mode] = {life, life->next(nodes)};
  }

  std::optional<TomlReader> root_;
  std::shared_ptr<const FormulaModel> model_;
  std::map<std::string, Life> lives_;
};

std::string shocks(const std::string& shape) {
  return "[data.columns]\nlife = { column = \"km\", unit = \"1\" }\nmode = \"failure mode\"\n"
         "[failure_modes]\ncolumn = \"mode\"\n[likelihood.life]\nfamily = \"weibull\"\n"
         "scale = \"eta[mode]\"\nshape = \"" +
         shape +
         "\"\n[prior]\neta = { distribution = \"lognormal\", median = 30000, log_sd = 1 }\n"
         "beta = { distribution = \"lognormal\", median = 2, log_sd = 0.5 }\n";
}

TEST_F(FailureModeLives, OfSeparateModes) {
  compare("shocks", text_of("examples/life/shock_absorbers.csv"), shocks("beta[mode]"));
}

// Meeker and Escobar (1998), example 15.6: surge has a long tail of small shapes, wear does not.
TEST_F(FailureModeLives, OfDeviceG) {
  compare("device", text_of("tests/golden/device_g.csv"),
          "[data.columns]\nlife = { column = \"kilocycles\", unit = \"1\" }\nmode = \"cause\"\n"
          "[failure_modes]\ncolumn = \"mode\"\nrunout = \"C\"\n"
          "[likelihood.life]\nfamily = \"weibull\"\nscale = \"eta[mode]\"\nshape = \"beta[mode]\"\n"
          "[prior]\neta = { distribution = \"lognormal\", median = 300, log_sd = 1.5 }\n"
          "beta = { distribution = \"lognormal\", median = 1, log_sd = 1 }\n");
}

TEST_F(FailureModeLives, OfModesWithOneShape) {
  compare("common", text_of("examples/life/shock_absorbers.csv"), shocks("beta"));
}

// Every third failure, from the second on, can have been of either mode.
TEST_F(FailureModeLives, OfMaskedFailures) {
  std::istringstream lines(text_of("examples/life/shock_absorbers.csv"));
  std::string table, line;
  int failures = 0;
  while (std::getline(lines, line)) {
    const bool failed = line.find(",mode ") != std::string::npos;
    if (failed && ++failures % 3 == 2) line = line.substr(0, line.find(',')) + ",mode 1|mode 2";
    table += line + "\n";
  }
  ASSERT_EQ(failures, 11);
  compare("masked", table, shocks("beta"));
}

}  // namespace
}  // namespace wearwell::formula_model
