#include "wearwell/models/formula_model/life_paper.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "wearwell/models/formula_model/exposure_lives.h"
#include "wearwell/models/formula_model/group_colour.h"
#include "wearwell/models/formula_model/life_groups.h"
#include "wearwell/models/formula_model/life_stress.h"
#include "wearwell/present/plot.h"
#include "wearwell/prob/plotting_positions.h"
#include "wearwell/prob/standard_distribution.h"
#include "wearwell/prob/threshold_form.h"
#include "wearwell/study/plot_study.h"

// Longer than others: paper, points, lines and bands share one scale.
namespace wearwell::formula_model {
namespace {

using Numbers = std::vector<double>;

// Number of conditions per plot, and number of conditions drawn in all.
constexpr std::size_t most_together = group_colours, most_drawn = 24, most_conditions = 2000;
constexpr std::size_t curve_points = 40;
// Maximum number of points drawn per condition: further points overlap.
constexpr std::size_t most_points = 2000;
constexpr Eigen::Index few_draws = 1000;

// The observations by condition with the distribution of each; of many conditions those with the
// most failures, in order of their values.
std::vector<LifeGroup> drawn_groups(const TomlReader& root,
                                    const std::shared_ptr<const FormulaModel>& model,
                                    std::vector<LifeGroup> groups) {
  if (groups.size() > most_drawn) {
    std::stable_sort(groups.begin(), groups.end(), [](const LifeGroup& a, const LifeGroup& b) {
      return a.failures() > b.failures();
    });
    groups.resize(most_drawn);
  }
  if (groups.size() > most_together) {
    std::stable_sort(groups.begin(), groups.end(), [](const LifeGroup& a, const LifeGroup& b) {
      return std::pair(a.conditions.labels, a.conditions.numbers) <
             std::pair(b.conditions.labels, b.conditions.numbers);
    });
  }
  for (LifeGroup& each : groups)
    each.life = life_distribution(root, "likelihood", model, each.conditions, each.modes);
  return groups;
}

class Drawing {
 public:
  Drawing(const FormulaModel& model, const std::vector<LifeGroup>& groups, std::size_t left_out,
          const Fit& fit, bool equivalent = false)
      : measured_(model.measured.front()),
        modes_(model.modes && model.measured.size() > 1),
        varies_(model.has_random_effects()),
        groups_(groups),
        left_out_(left_out),
        equivalent_(equivalent),
        // A test with changing stress has its family with a threshold.
        paper_(equivalent ? without_threshold(*measured_.form).paper : measured_.form->paper),
        draws_(thinned(fit.exact ? fit.exact->nodes : fit.pooled, few_draws)) {
    for (const LifeGroup& group : groups) {
      for (const Response& each : group.responses) {
        cover(each.at);
        if (each.seen == Censoring::interval) cover(each.until);
      }
      // The failures' own ages are not known where delays vary.
      positions_.push_back(measured_.reporting ? std::vector<PlottingPosition>()
                                               : plotting_positions(group.responses, group.counts));
      for (const PlottingPosition& each : positions_.back()) {
        least_ = std::min(least_, 0.5 * each.p);
        most_ = std::max(most_, 1 - 0.5 * (1 - each.p));
      }
    }
    if (!(low_ <= high_)) low_ = high_ = measured_.unit.scale;  // no finite observation
    double room = positive() ? std::max(1.5, std::pow(high_ / low_, 0.15))
                             : 0.1 * std::max(high_ - low_, 1e-9 * std::abs(high_));
    if (room == 0) room = measured_.unit.scale;  // all readings are zero
    low_ = positive() ? low_ / room : low_ - room;
    high_ = positive() ? high_ * room : high_ + room;
    for (std::size_t i = 0; i < curve_points; ++i) {
      const double share = static_cast<double>(i) / (curve_points - 1);
      at_.push_back(positive() ? low_ * std::pow(high_ / low_, share)
                               : std::lerp(low_, high_, share));
    }
  }

  // Plots of up to `most_together` conditions each, on common axes.
  std::vector<html::Figure> papers() const {
    std::vector<html::Figure> figures;
    const std::size_t count = (groups_.size() + most_together - 1) / most_together;
    const std::size_t each = (groups_.size() + count - 1) / count;
    for (std::size_t first = 0; first < groups_.size(); first += each)
      figures.push_back(paper(first, std::min(first + each, groups_.size())));
    return figures;
  }

  // Empty if no curve is finite anywhere.
  std::optional<html::Figure> hazard() const {
    std::vector<plot::Json> marks;
    const double per = measured_.unit.scale;
    double least = INFINITY, most = 0;
    const std::size_t step = (groups_.size() + most_together - 1) / most_together;
    for (std::size_t g = 0; g < groups_.size(); g += step) {
      const std::vector<Numbers> bands = over_places([&](double life) {
        const QuantityDistribution known = groups_[g].life->hazard(draws_, life).distribution;
        return Numbers{per * known.quantile(0.05), per * known.quantile(0.5),
                       per * known.quantile(0.95)};
      });
      Numbers x, low, middle, high;
      for (std::size_t i = 0; i < at_.size(); ++i) {
        if (!std::isfinite(bands[i][0]) || !(bands[i][0] > 0) || !std::isfinite(bands[i][2]))
          continue;
        x.push_back(shown(at_[i]));
        low.push_back(bands[i][0]);
        middle.push_back(bands[i][1]);
        high.push_back(bands[i][2]);
        least = std::min(least, middle.back());
        most = std::max(most, middle.back());
      }
      if (x.empty()) continue;
      const char* colour = group_colour(g / step);
      marks.push_back(plot::area({{"x", x}, {"y", high}, {"y2", low}}, {colour, "", 0.25}));
      marks.push_back(
          plot::line({{"x", x}, {"y", middle}, {"hazard", middle}}, {colour, label(g), 1, 2}));
    }
    if (marks.empty()) return {};
    const std::string unit = measured_.unit.text == "1"
                                 ? ""
                                 : fmt::format(" [{}]", html::unit(per_unit(measured_.unit)));
    return html::Figure{"hazard",
                        "Hazard rate: failures per unit of life among those still running",
                        "The line is the posterior median, the band holds 90 %.",
                        plot::plot(fmt::format("Hazard against {}", measured_.column), axis(),
                                   {"Hazard" + unit, true, least > 0 ? least / 5 : 1e-12, 5 * most},
                                   marks, 280, true)};
  }

 private:
  html::Figure paper(std::size_t first, std::size_t end) const {
    std::vector<plot::Json> marks;
    for (std::size_t g = first; g < end; ++g) add_law(g, g - first, marks);
    for (std::size_t g = first; g < end; ++g) add_points(g, g - first, marks);
    plot::Axis shares{"Failed [%]", false, height(least_), height(most_)};
    shares.ticks = share_ticks();
    std::string id = "probability-paper",
                title = fmt::format("Probability plot on {} paper", paper_.name);
    if (first > 0) id += fmt::format("-{}", first);
    if (end - first < groups_.size()) title += ": " + label(first) + " to " + label(end - 1);
    return {id, title, first == 0 ? caption() : "",
            plot::plot(
                fmt::format("Share failed against {}, on {} paper", measured_.column, paper_.name),
                axis(), shares, marks, 340, true)};
  }

  // As on printed probability paper, the most read first; a label that would overlap another is
  // left out. 63.2 % of a Weibull distribution have failed at its scale.
  std::vector<std::pair<double, std::string>> share_ticks() const {
    constexpr double least_apart = 0.038;  // of the axis: the height of a label
    const double span = height(most_) - height(least_);
    std::vector<std::pair<double, std::string>> ticks;
    for (const double percent : {10., 50., 1., 90., 63.2, 99., 0.1, 5., 20., 0.01, 99.9}) {
      const double p = percent / 100;
      if (p < least_ || p > most_) continue;
      if (percent == 63.2 && paper_.distribution != StandardDistribution::smallest_extreme_value)
        continue;
      const double at = height(p);
      const bool fits = std::all_of(ticks.begin(), ticks.end(), [&](const auto& each) {
        return std::abs(each.first - at) >= least_apart * span;
      });
      if (fits) ticks.emplace_back(at, fmt::format("{:g}", percent));
    }
    std::sort(ticks.begin(), ticks.end());
    return ticks;
  }

  double height(double p) const { return quantile(paper_.distribution, p); }
  bool positive() const { return measured_.form->positive; }
  void cover(double y) {
    if (!std::isfinite(y) || (positive() && !(y > 0))) return;
    low_ = std::min(low_, y);
    high_ = std::max(high_, y);
  }
  double shown(double y) const { return from_si(measured_.unit, y); }
  plot::Axis axis() const {
    const std::string unit = html::unit(measured_.unit.text);
    const std::string of = equivalent_ ? " at " + groups_.front().conditions.words : "";
    return {html::capital(measured_.column) + of + (unit.empty() ? "" : fmt::format(" [{}]", unit)),
            positive(), shown(low_), shown(high_)};
  }
  std::string label(std::size_t g) const {
    const std::string& words = groups_[g].conditions.words;
    return words.empty() ? "fitted distribution" : words;
  }

  template <class F>
  std::vector<Numbers> over_places(const F& f) const {
    std::vector<Numbers> all(at_.size());
    tbb::parallel_for(std::size_t{0}, at_.size(), [&](std::size_t i) { all[i] = f(at_[i]); });
    return all;
  }

  void add_law(std::size_t g, std::size_t colour, std::vector<plot::Json>& marks) const {
    const std::vector<Numbers> bands = over_places([&](double life) {
      const QuantityDistribution left = groups_[g].life->survival(draws_, life).distribution;
      const auto failed = [&](double q) {
        return height(std::clamp(1 - left.quantile(q), 0.1 * least_, 1 - 0.1 * (1 - most_)));
      };
      return Numbers{failed(0.95), failed(0.5), failed(0.05)};
    });
    Numbers x, low, middle, high;
    for (std::size_t i = 0; i < at_.size(); ++i) {
      if (std::isnan(bands[i][1])) continue;
      x.push_back(shown(at_[i]));
      low.push_back(bands[i][0]);
      middle.push_back(bands[i][1]);
      high.push_back(bands[i][2]);
    }
    if (x.empty()) return;
    marks.push_back(
        plot::area({{"x", x}, {"y", high}, {"y2", low}}, {group_colour(colour), "", 0.22}));
    marks.push_back(plot::line({{"x", x}, {"y", middle}}, {group_colour(colour), label(g), 1, 2}));
  }

  // All, or of very many so many that stand evenly apart on the paper: the outermost are all there.
  std::vector<PlottingPosition> drawn_positions(std::size_t g) const {
    std::vector<PlottingPosition> all = positions_[g];
    if (positive())  // those dead on arrival lie infinitely far left
      std::erase_if(all, [](const PlottingPosition& each) { return !(each.at > 0); });
    if (all.size() <= most_points) return all;
    const double apart = (height(all.back().p) - height(all.front().p)) / most_points;
    std::vector<PlottingPosition> drawn;
    for (const PlottingPosition& each : all) {
      if (drawn.empty() || height(each.p) >= height(drawn.back().p) + apart) drawn.push_back(each);
    }
    return drawn;
  }

  void add_points(std::size_t g, std::size_t colour, std::vector<plot::Json>& marks) const {
    Numbers x, y, percent;
    for (const PlottingPosition& each : drawn_positions(g)) {
      x.push_back(shown(each.at));
      y.push_back(height(each.p));
      percent.push_back(100 * each.p);
    }
    if (x.empty()) return;
    const bool alone = groups_.size() == 1;
    marks.push_back(
        plot::points({{"x", x}, {"y", y}, {measured_.column, x}, {"failed [%]", percent}},
                     {alone ? plot::colour::measured : group_colour(colour),
                      alone ? "observed" : "", 1, 0, false, 60}));
  }

  std::string caption() const {
    bool intervals = false, censored = false, none = false, thinned = false;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      for (const Response& each : groups_[g].responses) {
        intervals |= each.seen == Censoring::left || each.seen == Censoring::interval;
        censored |= each.seen == Censoring::right;
      }
      none |= positions_[g].empty();
      thinned |= positions_[g].size() > most_points;
    }
    std::string words =
        !measured_.life.plain()
            ? std::string(
                  "One distribution of this family alone would be a straight line here; "
                  "subpopulations bend it")
        : paper_.straight
            ? "A distribution of this family is a straight line here"
            : fmt::format("The {} distribution is curved on this paper", measured_.form->title);
    words += ". Lines are posterior medians of the share failed by then, bands hold 90 %. ";
    words +=
        intervals
            ? "Points are Turnbull's estimate, at the upper ends of the intervals where it steps."
        : censored ? "Points are the Kaplan-Meier estimate, halfway up its steps; run-outs have no "
                     "point, but count in the steps of others."
                   : "Points have the plotting positions (i - 1/2)/n.";
    if (measured_.reporting)
      words = words.substr(0, words.find("Points are")) +
              "There are no points: delays vary, so the ages at failure are not known.";
    else if (none)
      words +=
          " Conditions without failures, or with delayed entries and intervals, have no points.";
    if (thinned) words += fmt::format(" At most {} points of a condition are drawn.", most_points);
    if (equivalent_)
      words += fmt::format(
          " The stress changed in the test: lives are equivalent ages at {} by cumulative "
          "exposure, "
          "with all parameters at their posterior medians. At this constant stress the same share "
          "would have failed by then.",
          groups_.front().conditions.words);
    if (left_out_ > 0) {
      words += fmt::format(" Of {} conditions, the {} with the most failures are drawn.",
                           left_out_ + groups_.size(), groups_.size());
    }
    if (modes_)
      words +=
          " By mode: the life that this mode alone would give; failures by others count as "
          "run-outs, "
          "and so do failures of unknown mode, which lowers these points.";
    if (measured_.life.dead)
      words += " Parts dead on arrival have no point, but count in the share failed.";
    if (varies_) words += " Units vary; the line is for all units together.";
    return words;
  }

  const Measured& measured_;
  bool modes_, varies_;
  const std::vector<LifeGroup>& groups_;
  std::size_t left_out_;
  bool equivalent_;  // lives under one constant stress, by cumulative exposure
  Paper paper_;
  WeightedDraws draws_;
  std::vector<std::vector<PlottingPosition>> positions_;
  double low_ = INFINITY, high_ = -INFINITY, least_ = 0.05, most_ = 0.95;
  Numbers at_;
};

}  // namespace

void show_life_paper(const TomlReader& root, std::shared_ptr<const FormulaModel> model,
                     PosteriorStudy& study) {
  const Measured& measured = model->measured.front();
  if (model->along || (model->measured.size() > 1 && !model->modes) || measured.form->counted ||
      measured.program.has_paths() || measured.observed.failures == 0) {
    return;
  }
  std::vector<LifeGroup> all = life_groups(*model, most_conditions);
  if (all.empty()) return;
  const std::size_t conditions = all.size();
  std::vector<LifeGroup> parts = all;  // whatever ended them
  std::erase_if(parts, [](const LifeGroup& each) { return each.modes != ~std::uint32_t{0}; });
  const auto stresses =
      std::make_shared<const std::vector<LifeStress>>(life_stresses(root, model, parts));
  const auto groups =
      std::make_shared<const std::vector<LifeGroup>>(drawn_groups(root, model, std::move(all)));
  study.figures = [model, groups, conditions, stresses, before = study.figures](const Fit& fit) {
    auto figures = before ? before(fit) : std::map<std::string, std::vector<html::Figure>>();
    const Drawing drawing(*model, *groups, conditions - groups->size(), fit);
    std::vector<html::Figure>& shown = figures["verdict"];
    for (const LifeStress& each : *stresses) shown.push_back(life_stress_figure(*model, each, fit));
    for (html::Figure& each : drawing.papers()) shown.push_back(std::move(each));
    if (auto hazard = drawing.hazard()) figures["predictions"].push_back(std::move(*hazard));
    return figures;
  };
}

void show_exposure_paper(const TomlReader& root, std::shared_ptr<const FormulaModel> model,
                         std::shared_ptr<const FormulaRows> rows, PosteriorStudy& study) {
  const auto reference = exposure_reference(*model);
  if (!reference) return;
  const auto life = life_distribution(root, "likelihood", model, reference->conditions);
  study.figures = [=, before = study.figures](const Fit& fit) {
    auto figures = before ? before(fit) : std::map<std::string, std::vector<html::Figure>>();
    std::vector<double> medians;
    for (const QuantityDistribution& each : fit.marginals) medians.push_back(each.quantile(0.5));
    LifeGroup group{reference->conditions, exposure_lives(*rows, *reference, medians.data())};
    if (group.responses.empty()) return figures;
    group.counts = model->measured.front().observed.counts;
    group.life = life;
    const std::vector<LifeGroup> groups = {std::move(group)};
    for (html::Figure& each : Drawing(*model, groups, 0, fit, true).papers())
      figures["verdict"].push_back(std::move(each));
    return figures;
  };
}

}  // namespace wearwell::formula_model
