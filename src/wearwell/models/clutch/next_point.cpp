#include "wearwell/models/clutch/next_point.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <optional>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/heading.h"
#include "wearwell/input/json_reader.h"
#include "wearwell/models/clutch/clutch_model_file.h"
#include "wearwell/models/clutch/clutch_tables.h"
#include "wearwell/models/clutch/life.h"
#include "wearwell/models/clutch/point_goal.h"
#include "wearwell/plan/goal_target.h"
#include "wearwell/plan/linear_gain.h"
#include "wearwell/plan/next_plan.h"
#include "wearwell/plan/planning_value.h"

namespace wearwell::clutch {
namespace {

constexpr const char* of_closings = "cycles";
constexpr const char* of_volume_sd = "volume_sd";
// The unit in which candidates give an input; the default where they do not have it.
struct CandidateColumn {
  std::string heading;
  Unit unit;
  bool given = false;
};

CandidateColumn candidate_column(const Table& table, const std::string& name, const char* si,
                                 const char* like) {
  CandidateColumn found{fmt::format("{} [{}]", name, like), read_unit(like, si)};
  for (const Column& each : table.columns) {
    const Heading heading = read_heading(each.name, si);
    if (heading.name != name && each.name != name) continue;
    if (found.given)
      throw InputError(fmt::format("{}: column '{}' may be '{}' or '{}'; keep one", table.source,
                                   name, found.heading, printable(each.name)));
    const std::string unit = each.unit.empty() ? heading.unit : bare_unit(each.unit);
    if (unit.empty())
      throw InputError(fmt::format("{}, column '{}': needs its unit, like '{} [{}]'", table.source,
                                   printable(each.name), name, like));
    try {
      found = {each.name, read_unit(unit, si), true};
    } catch (const InputError& error) {
      throw InputError(
          fmt::format("{}, column '{}': {}", table.source, printable(each.name), error.what()));
    }
  }
  return found;
}

void add_condition(const std::string& name, const std::string& heading, const Unit& unit,
                   double low, double high, plan::TestStudy& study) {
  study.conditions.push_back({name, heading, unit, false, low, high, {}});
  study.roles.used.push_back({name, heading, unit.text});
  study.source.tables["points"].columns.push_back({heading, true, {NAN}, {}});
}

// The points of the campaign as tests that candidates are added to, in the candidates' own units.
plan::TestStudy points_study(const WearModel& model, const Table& candidates) {
  static constexpr const char* like[] = {"rpm", "N m", "degC", "s"};
  plan::TestStudy study;
  study.key = "points";
  study.source.tables["points"].rows = 1;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const Input& input = inputs[i];
    const double zero = input.value == &OperatingPoint::temperature ? celsius_zero : 0;
    const CandidateColumn column = candidate_column(candidates, input.name, input.si, like[i]);
    const auto shown = [&](double value) { return from_si(column.unit, value + zero); };
    add_condition(input.name, column.heading, column.unit, shown(model.lowest.*input.value),
                  shown(model.highest.*input.value), study);
  }
  add_condition(of_closings, of_closings, {"1", 1, 0}, -INFINITY, INFINITY, study);
  if (const CandidateColumn sd = candidate_column(candidates, of_volume_sd, "m^3", "mm^3");
      sd.given)
    add_condition(of_volume_sd, sd.heading, sd.unit, -INFINITY, INFINITY, study);
  study.measured = "wear_rate [mm^3/MJ]";
  study.measured_name = "wear_rate";
  return study;
}

Eigen::VectorXd scaled_terms(const WearModel& model, const OperatingPoint& at) {
  const double distance = std::pow(at.slip_speed, model.r) * std::pow(at.closing_time, model.q);
  Eigen::VectorXd row(std::ssize(model.terms));
  for (Eigen::Index j = 0; j < row.size(); ++j) {
    const ModelTerm& term = model.terms[static_cast<std::size_t>(j)];
    const double x = power(distance, term.ds) * power(at.temperature, term.temperature) *
                     power(at.torque, term.torque);
    const bool constant = term.ds + term.temperature + term.torque == 0;
    row[j] = constant ? 1 / term.range : (x - term.minimum) / term.range;
  }
  return row;
}

// A candidate's row of the regression, and the variance of its wear rate.
struct PlannedPoint {
  plan::LinearTest test;
  double closings = 0;
};

PlannedPoint planned_point(const WearModel& model, const plan::TestStudy& study,
                           const Table& conditions, std::size_t row) {
  OperatingPoint at;
  double closings = 0, volume_sd = 0;
  for (std::size_t c = 0; c < study.conditions.size(); ++c) {
    const plan::ConditionColumn& condition = study.conditions[c];
    const double given =
        cell_number(conditions, plan::condition_column(conditions, condition.heading), row);
    const double value = to_si(condition.unit, given);
    const bool is_sd = condition.name == of_volume_sd;
    const bool is_temperature = condition.name == inputs[2].name;
    if (!(value > 0 || (is_sd && value == 0)) || !std::isfinite(value))
      throw InputError(fmt::format("{}: {:.6g} must {}", place(conditions, condition.heading, row),
                                   given,
                                   is_sd            ? "not be negative"
                                   : is_temperature ? "be above absolute zero"
                                                    : "be positive"));
    if (c < inputs.size())
      at.*inputs[c].value = is_temperature ? value - celsius_zero : value;
    else
      (is_sd ? volume_sd : closings) = value;
  }
  PlannedPoint point;
  point.closings = closings;
  point.test.row = scaled_terms(model, at);
  const double w = std::max(0.0, model.polynomial()(at)), sigma = model.sigma(w, at);
  const double plate = model.plate_sd * w, balance = volume_sd / (closing_energy(at) * closings);
  point.test.error_variance = sigma * sigma / closings + plate * plate + balance * balance;
  if (!(point.test.error_variance > 0) || !std::isfinite(point.test.error_variance))
    throw InputError(fmt::format(
        "{}, row {}: the map gives no scatter of the wear rate there; it is too far outside the "
        "calibrated range",
        conditions.source, row + 1));
  return point;
}

// The goal's posterior: the wear rate is normal, and a life is a function of it.
void find_goal(const WearModel& model, const PointGoal& goal, double w, double sd,
               plan::NextPlan& plan) {
  constexpr int count = 201;
  std::vector<double> z, rates;
  for (int i = 0; i < count; ++i) {
    z.push_back(boost::math::quantile(boost::math::normal(), (i + 0.5) / count));
    // A higher wear rate is a shorter life: ascending in the goal.
    rates.push_back(w + (goal.is_life ? -1 : 1) * sd * z.back());
  }
  for (const double score : {plan::z05, 0.0, plan::z95})
    rates.push_back(w + (goal.is_life ? -1 : 1) * sd * score);
  std::vector<double> values;
  if (goal.is_life) {
    if (!(rates[count - 1] > 0))
      throw InputError(fmt::format(
          "--goal: the wear rate there is {:.3g} mm^3/MJ with a standard deviation of {:.3g}, so "
          "that it may be zero and its life has no interval; plan for 'wear rate at ...' first",
          w / mm3_per_MJ, sd / mm3_per_MJ));
    const Cycle cycle{1, 1, goal.at, closing_energy(goal.at)};
    std::vector<double> levels;
    for (const double rate : rates) levels.push_back(w / rate);
    for (const LifeAtLevel& each : predict_life(model, {cycle}, levels).levels)
      values.push_back(std::log(each.repetitions));
  } else {
    for (const double rate : rates) values.push_back(rate / mm3_per_MJ);
  }
  plan.points.goal.assign(values.begin(), values.begin() + count);
  plan.points.weight.assign(count, 1.0 / count);
  plan.now = plan::goal_spread(plan.points.goal, plan.points.weight);
  plan.now.low = values[count], plan.now.median = values[count + 1],
  plan.now.high = values[count + 2];
  plan.now.sd = plan.now.width() / (plan::z95 - plan::z05);
  plan.nodes = plan.now;
}

// Weights of the nodes after the best candidate, for an outcome that leaves the mean.
std::vector<double> narrowed_weights(std::size_t count, double share) {
  std::vector<double> weight;
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = boost::math::quantile(
        boost::math::normal(), (static_cast<double>(i) + 0.5) / static_cast<double>(count));
    weight.push_back(std::exp(-0.5 * z * z * (1 / share - 1)));
    sum += weight.back();
  }
  for (double& each : weight) each /= sum;
  return weight;
}

// Warns where the terms and exponents matter more than the coefficients, which alone are planned
// with.
void compare_with_replicates(const WearModel& model, const PointGoal& goal, double w, double sd,
                             plan::NextPlan& plan) {
  constexpr std::size_t fewest = 10;
  constexpr double much = 1.5;
  if (model.replicates.size() < fewest) return;
  double squares = 0;
  for (const Replicate& each : model.replicates) {
    const double off = each.w(goal.at) - w;
    squares += off * off / static_cast<double>(model.replicates.size());
  }
  const double spread = std::sqrt(squares);
  if (spread < much * sd) return;
  plan.checks.push_back(
      {"terms", Verdict::warn,
       fmt::format(
           "the wear rate of the goal is uncertain by {:.3g} mm^3/MJ over {} repetitions of "
           "the fit, with other exponents and terms, and by {:.3g} for the coefficients of "
           "the chosen terms",
           spread / mm3_per_MJ, model.replicates.size(), sd / mm3_per_MJ),
       "Gains are of the coefficients alone; points of a new fit may show other terms."});
}

void refuse_options_of_posteriors(const plan::NextQuestion& question) {
  if (!question.tests.empty())
    throw InputError(
        "--tests: a clutch map has no posterior to carry on; add the rows to the campaign and fit "
        "it again (wearwell update)");
  if (question.by == "loss")
    throw InputError(
        "--by: 'loss' is of the lives of a study with a posterior; a clutch map ranks by variance "
        "or information");
  if (!question.measure.empty())
    throw InputError("--measure: a point of a clutch campaign measures its wear rate only");
}

// Gains of points in closed form, on the scale of a plan's goal.
struct PointGains {
  std::vector<PlannedPoint> points;  // by row of the candidates
  Eigen::MatrixXd covariance;
  Eigen::VectorXd goal;
  double variance = 0;  // of the wear rate of the goal, today

  plan::Gain operator()(const plan::NextPlan& of, std::span<const plan::Tested> tests) const {
    std::vector<plan::LinearTest> all;
    double closings = 0, count = 0;
    for (const plan::Tested& each : tests) {
      const PlannedPoint& point = points[of.judged[each.candidate].candidate.row];
      all.push_back(point.test);
      all.back().tests = each.specimens;
      closings += each.specimens * point.closings;
      count += each.specimens;
    }
    const plan::LinearGain found = plan::linear_gain(covariance, goal, all);
    const double share = found.variance / variance;
    plan::Gain gain;
    gain.variance = share * of.nodes.sd * of.nodes.sd;
    gain.width = std::sqrt(share) * of.now.width();
    gain.information = found.information;
    gain.use = closings / count;
    gain.effective = INFINITY;
    return gain;
  }
};

constexpr const char* how_points =
    "Narrowing is 1 minus the ratio of standard deviations of the wear rate at the goal, before "
    "and after the point, in closed form: the coefficients of the map are normal about the fit "
    "with its covariance, and the wear rate of a point scatters by sigma_w/sqrt(cycles), by the "
    "factor of its plate, which is a new one for each specimen, and by volume_sd. Exponents, "
    "choice of terms and run-in are those of the fit.";

plan::NextPlan plan_of_goal(const WearModel& model, const PointGoal& goal,
                            const plan::NextQuestion& question, PointGains& gains) {
  plan::NextPlan plan;
  plan.title = model.title;
  plan.goal.name = fmt::format("{} at {}", goal.is_life ? "life" : "wear rate", goal.text);
  plan.goal.unit = goal.is_life ? Unit{"cycles", 1, 0} : Unit{"mm^3/MJ", mm3_per_MJ, 0};
  plan.logarithmic = goal.is_life;
  plan.use_unit = of_closings;
  plan.how = how_points;
  gains.covariance = model.covariance;
  gains.goal = scaled_terms(model, goal.at);
  gains.variance = gains.goal.dot(model.covariance * gains.goal);
  if (!(gains.variance > 0))
    throw InputError("--goal: the map knows the wear rate there exactly; no point adds to it");
  const double w = model.polynomial()(goal.at), sd = std::sqrt(gains.variance);
  find_goal(model, goal, w, sd, plan);
  if (!question.until.empty())
    plan.target = plan::Target{
        question.until, plan::target_width(question.until, plan.goal.unit, plan.logarithmic)};
  if (const unsigned bits = outside(model, goal.at))
    plan.checks.push_back(
        {"goal", Verdict::warn,
         fmt::format("the goal is outside the calibrated range: {}", names_of_inputs(bits)),
         "Its wear rate rests on the form of the map."});
  compare_with_replicates(model, goal, w, sd, plan);
  return plan;
}

}  // namespace

plan::Answer next_point(const WearModel& model, bool trusted, const plan::NextQuestion& question) {
  plan::check_question(question);
  refuse_options_of_posteriors(question);
  const PointGoal goal = read_point_goal(question.goal);
  const Table table = question.candidates ? *question.candidates : plan::grid_table(question.grid);
  const plan::TestStudy study = points_study(model, table);
  const std::vector<int> specimens =
      question.specimens.empty() ? std::vector<int>{1} : plan::specimen_counts(question.specimens);
  plan::Candidates candidates = plan::read_candidates(
      study, table, question.cost.empty() ? std::nullopt : std::optional(question.cost), specimens);
  PointGains gains;
  for (std::size_t row = 0; row < candidates.conditions.rows; ++row)
    gains.points.push_back(planned_point(model, study, candidates.conditions, row));
  plan::NextPlan plan = plan_of_goal(model, goal, question, gains);
  plan.trusted = trusted;
  plan.currency = candidates.currency;
  plan.notes = candidates.notes;
  plan.conditions = study.conditions;
  plan.gain_together = gains;
  for (const plan::Candidate& each : candidates.all) {
    plan.judged.push_back({each, nullptr, {}});
    const plan::Tested test[] = {{plan.judged.size() - 1, each.specimens}};
    plan.judged.back().gain = plan.gain_together(plan, test);
  }
  plan.condition_values = std::move(candidates.conditions);
  plan::rank_candidates(question, plan);
  plan.typical = narrowed_weights(plan.points.goal.size(), plan.judged.front().variance_share);
  return plan::answer_of_ranked(std::move(plan), question);
}

plan::Answer next_point(const std::filesystem::path& result, const plan::NextQuestion& question) {
  const auto summary = read_json(result / "summary.json");
  const bool trusted = JsonReader(summary, result / "summary.json").at("trusted").flag();
  return next_point(read_model(result), trusted, question);
}

bool is_clutch_result(const std::filesystem::path& result) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(result / "model.json", ignored) ||
      !std::filesystem::is_regular_file(result / "summary.json", ignored))
    return false;
  const auto summary = read_json(result / "summary.json");
  return summary.is_object() && summary.value("model", "") == "clutch-wear";
}

}  // namespace wearwell::clutch
