#include "wearwell/models/fatigue/sn_figures.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "wearwell/models/fatigue/design_curve.h"
#include "wearwell/models/fatigue/standard_fit.h"
#include "wearwell/present/plot.h"
#include "wearwell/study/plot_study.h"

// Longer than others: the figures of one study share scales and marks.
namespace wearwell {
namespace {

using fatigue::LifeTest;
using fatigue::MeanStress;
using fatigue::MixedLife;
using fatigue::Outcome;
using fatigue::SnLaw;
using fatigue::Stress;
using fatigue::StressLine;
using Numbers = std::vector<double>;
namespace colour = plot::colour;

constexpr std::size_t curve_points = 40, density_points = 100, haigh_points = 24;
constexpr std::size_t most_rows = 14;
// A random limit makes a mixture of each point of the posterior.
constexpr Eigen::Index most_draws = 4000, most_draws_with_limit = 600;
constexpr std::size_t most_tests = 1000;  // drawn

Numbers spaced(double low, double high, std::size_t count) {
  Numbers points;
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back(std::lerp(low, high, static_cast<double>(i) / static_cast<double>(count - 1)));
  }
  return points;
}

// Overlapping points are spread vertically: their heights move, in steps of a share of the plot's,
// up and down in turn. `x` and `y` from 0 to 1 over the plot.
Numbers apart(const Numbers& x, Numbers y) {
  constexpr double near_x = 0.012, near_y = 0.02, step = 0.022;
  const Numbers where = y;
  for (std::size_t i = 0; i < x.size(); ++i) {
    int before = 0;
    for (std::size_t j = 0; j < i; ++j)
      before += std::abs(x[j] - x[i]) < near_x && std::abs(where[j] - where[i]) < near_y;
    y[i] += step * (before % 2 == 1 ? (before + 1) / 2 : -(before / 2));
  }
  return y;
}

// All tests, or an even selection.
SnData drawn_tests(const SnData& data) {
  if (data.tests.size() <= most_tests) return data;
  SnData few = data;
  few.tests.clear();
  few.labels.clear();
  for (std::size_t i = 0; i < most_tests; ++i) {
    const std::size_t row = i * (data.tests.size() - 1) / (most_tests - 1);
    few.tests.push_back(data.tests[row]);
    few.labels.push_back(data.labels[row]);
  }
  return few;
}

// What the figures share: the model, the data, and a thinned posterior.
class Drawing {
 public:
  Drawing(const SnLaw& law, const SnData& data, const SnPredictions& predictions, const Fit& fit)
      : law_(law),
        data_(drawn_tests(data)),
        thinned_(data.tests.size() > most_tests ? fmt::format(" {} of {} tests are drawn, evenly.",
                                                              most_tests, data.tests.size())
                                                : ""),
        predictions_(predictions),
        draws_(thinned(fit.exact ? fit.exact->nodes : fit.pooled,
                       law.integrated() ? most_draws_with_limit : most_draws)),
        line_(line_of_tests(law, data)),
        standard_(standard_fit(law, data)) {
    for (const LifeTest& test : data.tests) {
      shortest_ = std::min(shortest_, test.life);
      longest_ = std::max({longest_, test.life, test.until});
    }
  }

  html::Figure curve() const {
    Numbers moved;
    for (const LifeTest& test : data_.tests) moved.push_back(moved_to_line(test.stress));
    const auto [least, most] = std::minmax_element(moved.begin(), moved.end());
    const double margin = std::max(1.03, std::pow(*most / *least, 0.15));
    const double low = *least / margin, high = *most * margin;
    Numbers stresses = spaced(std::log(low), std::log(high), curve_points);
    for (double& each : stresses) each = std::exp(each);
    struct Row {
      double pi05, pi95, ci05, ci50, ci95, bound;
    };
    std::vector<Row> rows(stresses.size());
    tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t i) {
      const Stress stress = line_.at(stresses[i]);
      MixedLife next = next_life(law_, draws_, stress);
      next.merge();
      const QuantityDistribution median(
          draws_, [&](const double* x) { return life_quantile(law_, x, stress, 0.5); });
      const auto at = [&](double p) { return shown(cycles(law_, median.quantile(p))); };
      const QuantityDistribution tenth(
          draws_, [&](const double* x) { return life_quantile(law_, x, stress, 0.1); });
      rows[i] = {shown(next.quantile(0.05)),
                 shown(next.quantile(0.95)),
                 at(0.05),
                 at(0.5),
                 at(0.95),
                 shown(cycles(law_, tenth.quantile(predictions_.levels.below())))};
    });
    Numbers y, pi05, pi95, ci05, ci50, ci95, bound;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      y.push_back(in_unit(stresses[i]));
      pi05.push_back(rows[i].pi05);
      pi95.push_back(rows[i].pi95);
      ci05.push_back(rows[i].ci05);
      ci50.push_back(rows[i].ci50);
      ci95.push_back(rows[i].ci95);
      bound.push_back(rows[i].bound);
    }
    const std::string confidence = fmt::format("{:.4g} %", 100 * (1 - predictions_.levels.below()));
    std::vector<plot::Json> marks = {
        plot::area({{"x", pi95}, {"x2", pi05}, {"y", y}}, {colour::wide, "90 % of lives", 0.28}),
        plot::area({{"x", ci95}, {"x2", ci05}, {"y", y}},
                   {colour::posterior, "90 % of the median life", 0.38}),
        plot::line({{"x", ci50}, {"y", y}, {"median life", ci50}, {"stress", y}},
                   {colour::posterior, "half outlast it", 1, 2}),
        plot::line({{"x", bound}, {"y", y}, {"B10 at least", bound}, {"stress", y}},
                   {colour::limit, "B10, at least with " + confidence, 1, 2, true})};
    add_standards(stresses, marks);
    add_tests(moved, low, high, marks);
    return {"sn-curve",
            law_.curve == fatigue::SnCurve::strain_life
                ? "Strain-life curve"
                : fmt::format("S-N curve: life against {}", driver_word(law_, data_)),
            fmt::format("{}. The dashed line is for design: nine in ten outlast it, with {} "
                        "confidence. The inner band is the 90 % interval of the median life, the "
                        "outer band that of the next life.{} Tests at one place are stacked.{}",
                        where_drawn(), confidence, arrows_note(), thinned_),
            plot::plot("Alternating stress against life, with bands and tests",
                       {life_title(), true, from_si(data_.life_unit, shortest_ / 20),
                        from_si(data_.life_unit, longest_ * 20)},
                       {fmt::format("Alternating {} [{}]", driver_word(law_, data_),
                                    html::unit(data_.stress_unit.text)),
                        true, in_unit(low), in_unit(high)},
                       marks, 380, true)};
  }

  // The predictive density of every tested or requested stress, stacked.
  html::Figure lives() const {
    std::vector<StressPoint> points = tested_points(law_, data_);
    for (const StressPoint& asked : predictions_.points) {
      if (std::none_of(points.begin(), points.end(),
                       [&](const StressPoint& each) { return each.name == asked.name; })) {
        points.push_back(asked);
      }
    }
    if (points.size() > most_rows) points.resize(most_rows);
    const double low = std::log10(shortest_) - 1.3, high = std::log10(longest_) + 1.3;
    const Numbers at = spaced(low, high, density_points);
    std::vector<Numbers> density(points.size(), Numbers(at.size()));
    Numbers b10(points.size());
    tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
      MixedLife life = next_life(law_, draws_, points[i].stress);
      life.merge();
      b10[i] = shown(life.quantile(0.1));
      for (std::size_t j = 0; j < at.size(); ++j) density[i][j] = life.density(at[j]);
    });
    double peak = 0;
    for (const Numbers& each : density) {
      peak = std::max(peak, *std::max_element(each.begin(), each.end()));
    }
    Numbers x;
    for (const double each : at) x.push_back(shown(std::pow(10, each)));
    std::vector<plot::Json> marks;
    std::vector<std::string> names;
    const std::size_t n = points.size();
    const auto base = [&](std::size_t i) { return static_cast<double>(n - i) - 0.45; };
    Numbers broke_x, broke_y, broke_life, on_x, on_y, on_life, b10_y;
    for (std::size_t i = 0; i < n; ++i) {
      Numbers top;
      for (const double each : density[i]) top.push_back(base(i) + 0.9 * each / peak);
      marks.push_back(plot::area({{"x", x}, {"y", top}, {"y2", Numbers(top.size(), base(i))}},
                                 {colour::posterior, "", 0.3}));
      marks.push_back(plot::line({{"x", x}, {"y", top}}, {colour::posterior, "", 1, 1.5}));
      names.push_back(points[n - 1 - i].name);
      b10_y.push_back(base(i) + 0.35);
      for (const LifeTest& test : data_.tests) {
        if (test.stress.alternating != points[i].stress.alternating ||
            test.stress.mean != points[i].stress.mean) {
          continue;
        }
        const bool runout = test.outcome == Outcome::runout;
        Numbers& on_line = runout ? on_x : broke_x;
        Numbers& heights = runout ? on_y : broke_y;
        int before = 0;  // at the same place
        for (std::size_t k = 0; k < on_line.size(); ++k)
          before += heights[k] > base(i) && heights[k] < base(i) + 0.9 &&
                    std::abs(std::log10(on_line[k] / shown(test.life))) < 0.02 * (high - low);
        on_line.push_back(shown(test.life));
        heights.push_back(base(i) + 0.1 + 0.1 * (before % 8));
        (runout ? on_life : broke_life).push_back(from_si(data_.life_unit, test.life));
      }
    }
    Numbers foot;
    for (const double y : b10_y) foot.push_back(y - 0.35);
    marks.push_back(plot::ranges({{"x", b10}, {"y", foot}, {"y2", b10_y}, {"B10 life", b10}},
                                 {colour::limit, "B10, posterior predictive", 1, 2}));
    if (!broke_x.empty()) {
      marks.push_back(plot::points({{"x", broke_x}, {"y", broke_y}, {"life", broke_life}},
                                   {colour::measured, "tests", 1, 0, false, 60}));
    }
    if (!on_x.empty()) {
      marks.push_back(plot::arrows({{"x", on_x}, {"y", on_y}, {"life", on_life}}, "triangle-right",
                                   {colour::chains[2], "run-outs", 1, 0, false, 90}));
    }
    html::Figure figure{
        "lives", fmt::format("Predictive life, by {}", driver_word(law_, data_)),
        std::string("The predictive density of log10 life under each stress, all on one scale, "
                    "with its tests. A test left of the short stroke lies below its B10.") +
            thinned_,
        plot::plot("Predicted density of life at each stress, with the tests",
                   {life_title(), true, shown(std::pow(10, low)), shown(std::pow(10, high))},
                   {"", false, {}, {}, names}, marks,
                   static_cast<int>(std::max<std::size_t>(220, 48 * n)))};
    figure.wide = true;  // names of stresses are long
    return figure;
  }

  // Mean against alternating stress of one life; empty if the mean does not matter.
  html::Figure haigh() const {
    double life = 0;
    if (!predictions_.allowed.empty()) {
      life = predictions_.allowed.front().life.si();
    } else {
      Numbers lives;
      for (const LifeTest& test : data_.tests) lives.push_back(test.life);
      std::nth_element(lives.begin(), lives.begin() + static_cast<long>(lives.size() / 2),
                       lives.end());
      life = lives[lives.size() / 2];
    }
    double least = 0, most = 0;
    for (const LifeTest& test : data_.tests) {
      least = std::min(least, test.stress.mean);
      most = std::max(most, test.stress.mean);
    }
    for (const StressPoint& point : predictions_.points) most = std::max(most, point.stress.mean);
    const double margin = 0.15 * std::max(most - least, 0.1 * data_.tests[0].stress.alternating);
    const Numbers means = spaced(least < 0 ? least - margin : 0, most + margin, haigh_points);
    struct Row {
      double ci05, ci50, ci95, b10;
    };
    std::vector<Row> rows(means.size());
    tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t i) {
      const StressLine line{means[i], {}};
      const QuantityDistribution median(draws_, [&](const double* x) {
        return alternating_allowed(law_, x, line, log10_reversed_allowed(law_, x, life, 0.5));
      });
      rows[i] = {median.quantile(0.05), median.quantile(0.5), median.quantile(0.95),
                 next_allowed(law_, draws_, line, life, 0.9)};
    });
    Numbers x, ci05, ci50, ci95, b10;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      x.push_back(in_unit(means[i]));
      ci05.push_back(in_unit(rows[i].ci05));
      ci50.push_back(in_unit(rows[i].ci50));
      ci95.push_back(in_unit(rows[i].ci95));
      b10.push_back(in_unit(rows[i].b10));
    }
    Numbers before_x, before_y, after_x, after_y;
    for (const LifeTest& test : data_.tests) {
      const bool failed = test.life < life && test.outcome != Outcome::runout;
      (failed ? before_x : after_x).push_back(in_unit(test.stress.mean));
      (failed ? before_y : after_y).push_back(in_unit(test.stress.alternating));
    }
    std::vector<plot::Json> marks = {
        plot::area({{"x", x}, {"y", ci95}, {"y2", ci05}},
                   {colour::posterior, "90 % of the stress that half outlast", 0.3}),
        plot::line({{"x", x}, {"y", ci50}, {"mean stress", x}, {"alternating stress", ci50}},
                   {colour::posterior, "", 1, 2}),
        plot::line({{"x", x}, {"y", b10}, {"mean stress", x}, {"alternating stress", b10}},
                   {colour::limit, "nine in ten outlast it (predictive)", 1, 1.5, true})};
    const std::string life_text =
        html::given(from_si(data_.life_unit, life)) + "\u00a0" + html::unit(data_.life_unit.text);
    // Far from the tests the band may be as wide as the prior: it is clipped.
    double highest = to_si(data_.stress_unit, *std::max_element(ci50.begin(), ci50.end()));
    for (const LifeTest& test : data_.tests) highest = std::max(highest, test.stress.alternating);
    if (!before_x.empty()) {
      marks.push_back(plot::points({{"x", before_x}, {"y", before_y}, {"alternating", before_y}},
                                   {colour::measured, "failed before", 1, 0, false, 60}));
    }
    if (!after_x.empty()) {
      marks.push_back(plot::points({{"x", after_x}, {"y", after_y}, {"alternating", after_y}},
                                   {colour::chains[2], "survived", 1, 0, false, 60}));
    }
    return {"haigh", fmt::format("Haigh diagram of {}", life_text),
            fmt::format("Alternating against mean stress for {}: median over specimens, and 90 % "
                        "predictive survival. Tests by whether they failed before.{}",
                        life_text, thinned_),
            plot::plot("Haigh diagram: alternating against mean stress at one life, with the tests",
                       {fmt::format("Mean {} [{}]", driver_word(law_, data_),
                                    html::unit(data_.stress_unit.text)),
                        false, x.front(), x.back()},
                       {fmt::format("Alternating {} [{}]", driver_word(law_, data_),
                                    html::unit(data_.stress_unit.text)),
                        false, 0.0, in_unit(1.25 * highest)},
                       marks, 340, true)};
  }

 private:
  double in_unit(double stress) const { return from_si(data_.stress_unit, stress); }

  // The standards' curves of the same tests, 90/90, if they apply.
  void add_standards(const Numbers& stresses, std::vector<plot::Json>& marks) const {
    if (!standard_.line) return;
    Numbers y, iso, owen;
    for (const double each : stresses) {
      const double x = standard_log10_stress(law_, line_.at(each));
      y.push_back(in_unit(each));
      iso.push_back(shown(std::pow(10, fatigue::iso_12107_limit(*standard_.line, x, 0.9, 0.9))));
      owen.push_back(shown(std::pow(10, fatigue::owen_limit(*standard_.line, x, 0.9, 0.9))));
    }
    marks.push_back(plot::line({{"x", iso}, {"y", y}, {"ISO 12107", iso}, {"stress", y}},
                               {colour::chains[1], "ISO 12107, 90/90", 1, 1.2, true}));
    marks.push_back(plot::line({{"x", owen}, {"y", y}, {"Owen", owen}, {"stress", y}},
                               {colour::chains[3], "Owen, 90/90", 1, 1.2, true}));
  }

  std::string life_title() const {
    return fmt::format("Life [{}]", html::unit(data_.life_unit.text));
  }

  // Lives far beyond the plot are drawn just outside it.
  double shown(double life) const {
    return from_si(data_.life_unit, std::clamp(life, shortest_ * 1e-4, longest_ * 1e4));
  }

  // The equally damaging alternating stress at the common mean stress, by the posterior median.
  double moved_to_line(const Stress& stress) const {
    if (law_.correction == MeanStress::none) return stress.alternating;
    return QuantityDistribution(draws_,
                                [&](const double* x) {
                                  return alternating_allowed(law_, x, line_,
                                                             law_.log10_reversed(x, stress));
                                })
        .quantile(0.5);
  }

  std::string where_drawn() const {
    if (law_.correction == MeanStress::none) return "Alternating stress as tested";
    if (line_.ratio) return fmt::format("At the stress ratio {:.4g} of the tests", *line_.ratio);
    return fmt::format(
        "At a mean stress of {}, the tests' average; other tests are drawn at the equally damaging "
        "alternating stress",
        html::quantity(in_unit(line_.mean), data_.stress_unit.text));
  }

  std::string arrows_note() const {
    const bool censored =
        std::any_of(data_.tests.begin(), data_.tests.end(),
                    [](const LifeTest& test) { return test.outcome != Outcome::failure; });
    return censored ? " Arrows mark run-outs and tests that failed before an inspection; they "
                      "point to where the life lies."
                    : "";
  }

  void add_tests(const Numbers& moved, double low, double high,
                 std::vector<plot::Json>& marks) const {
    Numbers lives, across, up;
    for (std::size_t i = 0; i < data_.tests.size(); ++i) {
      const LifeTest& test = data_.tests[i];
      lives.push_back(test.outcome == Outcome::interval ? std::sqrt(test.life * test.until)
                                                        : test.life);
      across.push_back(std::log(lives[i] / (shortest_ / 20)) /
                       std::log(400 * longest_ / shortest_));
      up.push_back(std::log(moved[i] / low) / std::log(high / low));
    }
    const Numbers heights = apart(across, up);
    struct Group {
      const char* name;
      const char* shape;
      const char* paint;
      Numbers x, y, stress;
    };
    Group groups[] = {{"failures", "circle", colour::measured, {}, {}, {}},
                      {"run-outs", "triangle-right", colour::chains[2], {}, {}, {}},
                      {"left-censored", "triangle-left", colour::chains[1], {}, {}, {}},
                      {"interval-censored", "diamond", colour::chains[3], {}, {}, {}}};
    for (std::size_t i = 0; i < data_.tests.size(); ++i) {
      Group& group = groups[static_cast<int>(data_.tests[i].outcome)];
      group.x.push_back(from_si(data_.life_unit, lives[i]));
      group.y.push_back(in_unit(low * std::pow(high / low, heights[i])));
      group.stress.push_back(in_unit(moved[i]));
    }
    for (const Group& group : groups) {
      if (group.x.empty()) continue;
      marks.push_back(plot::arrows(
          {{"x", group.x}, {"y", group.y}, {"life", group.x}, {"stress", group.stress}},
          group.shape, {group.paint, group.name, 1, 0, false, 70}));
    }
  }

  const SnLaw& law_;
  const SnData data_;
  const std::string thinned_;
  const SnPredictions& predictions_;
  WeightedDraws draws_;
  StressLine line_;
  StandardFit standard_;
  double shortest_ = INFINITY, longest_ = 0;
};

}  // namespace

const char* driver_word(const SnLaw& law, const SnData& data) {
  if (law.curve == fatigue::SnCurve::strain_life) return "strain";
  if (data.stress_si == "Pa") return "stress";
  return data.stress_si == "N" ? "force" : "load";
}

std::map<std::string, std::vector<html::Figure>> sn_figures(const SnLaw& law, const SnData& data,
                                                            const SnPredictions& predictions,
                                                            const Fit& fit) {
  const Drawing drawing(law, data, predictions, fit);
  std::map<std::string, std::vector<html::Figure>> figures;
  figures["verdict"].push_back(drawing.curve());
  figures["predictions"].push_back(drawing.lives());
  if (law.correction != MeanStress::none) {
    figures["predictions"].push_back(drawing.haigh());
  }
  return figures;
}

}  // namespace wearwell
