#include "wearwell/prognosis/node_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/math/constants.h"
#include "wearwell/prognosis/unit_state.h"
#include "wearwell/prognosis/weighted_quantiles.h"

namespace wearwell::prognosis {
namespace {

constexpr double least_effective = 0.5;   // of the effective sample size when nodes were built
constexpr double hardly_possible = 1e-4;  // a smaller p-value contradicts
constexpr std::size_t most_sampled = 128;
constexpr double doubtful = 0.05;  // a smaller p-value is summed over all nodes
constexpr double negligible = 1e-12;
constexpr std::string_view mark = "wearwell nodes 1";

using Model = std::shared_ptr<const NodeModel>;

bool carries(double log_weight) {
  return log_weight > -infinity && log_weight < infinity;
}

class NodeUnit final : public TrackedUnit {
 public:
  // Without nodes: they are built, loaded, or copied.
  NodeUnit(Model model, const std::string& unit) : model_(std::move(model)) { rename(unit); }

  void rename(const std::string& unit) {
    unit_ = unit;
    refusal_ = model_->refusal(unit_);
  }
  bool rebuild(std::vector<Reading> all);
  bool is_refused() const { return !refusal_.empty(); }
  Eigen::Index columns() const { return nodes_.values.cols(); }

  UpdateResult update(const Reading& reading, const History& history) override;
  Forecast forecast() const override;
  std::vector<PredictiveTails> predictive(const Reading& reading) const override;
  std::vector<ForecastBand> ahead(std::span<const double> places) const override;
  std::size_t readings() const override { return readings_; }
  std::string save() const override;
  void load(ByteReader& from, Eigen::Index columns);

 private:
  const double* node(std::size_t i) const {
    return nodes_.values.row(static_cast<Eigen::Index>(i)).data();
  }
  double place(const Reading& reading) const { return reading.numbers[model_->axis]; }
  std::optional<DegradationPath> degradation_path() const {
    return model_->degradation_path(unit_, last_.numbers.empty() ? nullptr : &last_);
  }
  bool rebuild_with(const Reading& reading, const History& history);
  void weigh();
  PredictiveTails tails(const NodeReading& reading_at) const;

  Model model_;
  std::string unit_, refusal_;
  NodeCloud nodes_;
  std::vector<double> weight_;  // of nodes_; sum to 1
  Reading last_;                // the farthest; NaN where there is none
  double effective_ = 0, laid_effective_ = 0;
  std::size_t readings_ = 0;
};

void NodeUnit::weigh() {
  double top = -infinity, sum = 0, square = 0;
  for (const double each : nodes_.log_weight) top = std::max(top, each);
  weight_.assign(nodes_.log_weight.size(), 0);
  effective_ = 0;
  if (!(top > -infinity && top < infinity)) return;
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    // In single precision, as states are saved: weights to a relative 1e-6.
    double& log_weight = nodes_.log_weight[i];
    log_weight = static_cast<float>(log_weight - top);
    weight_[i] = std::exp(log_weight);
    sum += weight_[i];
    square += weight_[i] * weight_[i];
  }
  for (double& each : weight_) each /= sum;
  effective_ = sum * sum / square;
}

// False, with nothing changed, if no node passes through all of them.
bool NodeUnit::rebuild(std::vector<Reading> all) {
  const auto before = [&](const Reading& a, const Reading& b) {
    return std::pair(place(a), std::tie(a.numbers, a.labels)) <
           std::pair(place(b), std::tie(b.numbers, b.labels));
  };
  std::sort(all.begin(), all.end(), before);
  NodeCloud laid = model_->rebuild(unit_, all);
  if (!std::any_of(laid.log_weight.begin(), laid.log_weight.end(), carries)) return false;
  // Single precision, as states are saved.
  nodes_.values = laid.values.cast<float>().cast<double>();
  nodes_.log_weight = std::move(laid.log_weight);
  for (double& each : nodes_.log_weight) each = carries(each) ? each : -infinity;
  weigh();
  laid_effective_ = effective_;
  if (!all.empty()) last_ = all.back();
  return true;
}

bool NodeUnit::rebuild_with(const Reading& reading, const History& history) {
  std::vector<Reading> all;
  history([&](const Reading& each) {
    if (model_->problem(each).empty()) all.push_back(each);
  });
  all.push_back(reading);
  return rebuild(std::move(all));
}

double p_value_of(const PredictiveTails& tails) {
  return std::clamp(2 * std::min(tails.below, tails.above), 0.0, 1.0);
}

// From a subset of representative nodes where that is accurate enough.
PredictiveTails NodeUnit::tails(const NodeReading& reading_at) const {
  double before = 0, below = 0;
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < weight_.size() && drawn < most_sampled; ++i) {
    before += weight_[i];
    double own = 0;
    for (; drawn < most_sampled &&
           before > (static_cast<double>(drawn) + 0.5) / static_cast<double>(most_sampled);
         ++drawn)
      own += 1.0 / most_sampled;
    if (own > 0) below += own * reading_at.cdf(node(i));
  }
  const PredictiveTails sampled{below, 1 - below};
  if (p_value_of(sampled) > doubtful) return sampled;
  PredictiveTails all;
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    if (!(weight_[i] > negligible)) continue;
    check_stop();
    const double share = reading_at.cdf(node(i));
    all.below += weight_[i] * share;
    all.above += weight_[i] * (1 - share);
  }
  return all;
}

std::vector<PredictiveTails> NodeUnit::predictive(const Reading& reading) const {
  if (is_refused() || !model_->problem(reading).empty()) return {};
  return {tails(model_->reading(reading))};
}

UpdateResult NodeUnit::update(const Reading& reading, const History& history) {
  UpdateResult taken;
  if (reading.numbers.size() != model_->columns.size() ||
      reading.labels.size() != model_->labels.size())
    throw InputError(fmt::format("a reading has {} numbers and {} labels; expected are {} and {}",
                                 reading.numbers.size(), reading.labels.size(),
                                 model_->columns.size(), model_->labels.size()));
  taken.problem = refusal_.empty() ? model_->problem(reading) : refusal_;
  if (!taken.problem.empty()) return taken;
  const NodeReading reading_at = model_->reading(reading);
  taken.tails = {tails(reading_at)};
  taken.p_value = p_value_of(taken.tails.front());
  std::vector<double> after = nodes_.log_weight;
  bool any = false;
  for (std::size_t i = 0; i < after.size(); ++i) {
    check_stop();
    if (!(after[i] > -infinity)) continue;
    const double own = reading_at.log_density(node(i));
    after[i] = own < infinity ? after[i] + own : -infinity;
    any |= after[i] > -infinity;
  }
  if (any) {
    std::swap(nodes_.log_weight, after);
    weigh();
    if (last_.numbers.empty() || place(reading) >= place(last_)) last_ = reading;
    if (effective_ < least_effective * laid_effective_) rebuild_with(reading, history);
  } else if (!rebuild_with(reading, history)) {
    taken.problem = "no unit of the population can show this after its earlier readings";
    taken.impossible = true;
    return taken;
  }
  ++readings_;
  taken.counted = true;
  taken.contradicts = taken.p_value < hardly_possible;
  return taken;
}

Forecast NodeUnit::forecast() const {
  Forecast forecast;
  forecast.effective = effective_;
  const std::optional<DegradationPath> degradation_path =
      is_refused() ? std::optional<DegradationPath>() : this->degradation_path();
  if (!degradation_path) {  // nothing determines its further path
    forecast.level05 = forecast.level50 = forecast.level95 = forecast.passed =
        std::numeric_limits<double>::quiet_NaN();
    return forecast;
  }
  forecast.now = degradation_path->now;
  std::vector<double> level, level_weight, life, life_weight;
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    if (!(weight_[i] > negligible)) continue;
    check_stop();
    level.push_back(degradation_path->level(node(i), forecast.now));
    level_weight.push_back(weight_[i]);
    const double end = degradation_path->end(node(i));
    if (!(end > forecast.now)) {
      forecast.passed += weight_[i];
      continue;
    }
    life.push_back(end - forecast.now);
    life_weight.push_back(weight_[i]);
  }
  forecast.passed = std::min(forecast.passed, 1.0);
  const std::vector<double> levels =
      weighted_quantiles(level, level_weight, std::array{0.05, 0.5, 0.95});
  forecast.level05 = levels[0];
  forecast.level50 = levels[1];
  forecast.level95 = levels[2];
  forecast.remaining = WeightedLives(life, life_weight);
  return forecast;
}

std::vector<ForecastBand> NodeUnit::ahead(std::span<const double> places) const {
  const std::optional<DegradationPath> degradation_path =
      is_refused() ? std::optional<DegradationPath>() : this->degradation_path();
  if (!degradation_path) return {};
  if (!places.empty() && places.front() < degradation_path->now)
    throw std::invalid_argument("a forecast must start at the unit's present position");
  std::vector<ForecastBand> path;
  std::vector<double> level(weight_.size());
  for (const double at : places) {
    check_stop();
    for (std::size_t i = 0; i < level.size(); ++i)
      level[i] = weight_[i] > negligible ? degradation_path->level(node(i), at) : 0;
    const std::vector<double> q = weighted_quantiles(level, weight_, std::array{0.05, 0.5, 0.95});
    path.push_back({at, q[0], q[1], q[2]});
  }
  return path;
}

std::string NodeUnit::save() const {
  ByteWriter to = unit_state(mark, model_->fingerprint);
  to.text(unit_);
  to.u64(readings_);
  to.number(laid_effective_);
  to.u64(nodes_.log_weight.size());
  to.u64(static_cast<std::uint64_t>(nodes_.values.cols()));
  for (const double each : nodes_.values.reshaped<Eigen::RowMajor>()) to.single(each);
  for (const double each : nodes_.log_weight) to.single(each);
  to.u64(last_.numbers.size());
  for (const double each : last_.numbers) to.number(each);
  for (std::size_t i = 0; !last_.numbers.empty() && i < last_.labels.size(); ++i)
    to.text(last_.labels[i]);
  return signed_unit_state(std::move(to));
}

// `columns`: of the nodes of every tracked unit.
void NodeUnit::load(ByteReader& from, Eigen::Index columns) {
  readings_ = from.u64();
  laid_effective_ = from.number();
  const std::size_t count = from.count(sizeof(float));
  if (is_refused()) columns = 0;
  if (from.u64() != static_cast<std::size_t>(columns))
    from.fail("its nodes have another number of values");
  from.require(count, sizeof(float) * (static_cast<std::size_t>(columns) + 1));
  nodes_.values.resize(static_cast<Eigen::Index>(count), columns);
  nodes_.log_weight.resize(count);
  for (Eigen::Index i = 0; i < nodes_.values.rows(); ++i) {
    for (Eigen::Index j = 0; j < nodes_.values.cols(); ++j) {
      nodes_.values(i, j) = from.single();
      if (!std::isfinite(nodes_.values(i, j))) from.fail("a node is not a number");
    }
  }
  for (double& each : nodes_.log_weight) {
    each = from.single();
    if (!(each < infinity)) from.fail("a weight is not a number");
  }
  const std::size_t numbers = from.count(sizeof(double));
  if (numbers != 0 && numbers != model_->columns.size())
    from.fail("its last reading is not a number");
  last_ = {};
  for (std::size_t i = 0; i < numbers; ++i) last_.numbers.push_back(from.number());
  for (std::size_t i = 0; numbers > 0 && i < model_->labels.size(); ++i)
    last_.labels.push_back(from.text());
  from.end();
  if (numbers > 0 && !model_->problem(last_).empty()) from.fail("its last reading is not a number");
  weigh();
  if (!is_refused() && !(effective_ > 0)) from.fail("all nodes have weight zero");
}

class NodeTracker final : public Tracker {
 public:
  explicit NodeTracker(NodeModel model)
      : model_(std::make_shared<const NodeModel>(std::move(model))), fresh_(model_, "") {
    NodeUnit first(model_, model_->seen.empty() ? "" : model_->seen.front());
    if (!first.rebuild({}) || (!fresh_.is_refused() && !fresh_.rebuild({})))
      throw InputError(
          "the saved posterior gives the units of its study weight zero: it is damaged");
    columns_ = first.columns();
  }

  std::span<const ReadingColumn> columns() const override { return model_->columns; }
  std::span<const std::string> labels() const override { return model_->labels; }
  const ReadingColumn& axis() const override { return model_->columns[model_->axis]; }
  const std::string& limited() const override { return model_->limited; }
  const Quantity& limit() const override { return model_->limit; }
  bool rising() const override { return true; }
  const std::string& noun() const override { return model_->noun; }
  std::span<const std::string> seen() const override { return model_->seen; }
  double probability_error() const override { return 0.012; }

  std::string refusal(const std::string& unit) const override { return model_->refusal(unit); }
  std::string problem(const Reading& reading) const override { return model_->problem(reading); }

  std::unique_ptr<TrackedUnit> begin(const std::string& unit) const override {
    const bool own = fresh_.is_refused() || std::ranges::find(seen(), unit) != seen().end();
    auto begun = std::make_unique<NodeUnit>(own ? NodeUnit(model_, unit) : fresh_);
    begun->rename(unit);
    if (own && !begun->is_refused()) begun->rebuild({});
    return begun;
  }

  std::unique_ptr<TrackedUnit> restore(const std::string& bytes) const override {
    ByteReader from = read_unit_state(bytes, mark, model_->fingerprint);
    auto unit = std::make_unique<NodeUnit>(model_, from.text());
    unit->load(from, columns_);
    return unit;
  }

 private:
  std::shared_ptr<const NodeModel> model_;
  NodeUnit fresh_;  // without a name: any unit that is not in the study
  Eigen::Index columns_ = 0;
};

}  // namespace

std::unique_ptr<const Tracker> node_tracker(NodeModel model) {
  return std::make_unique<const NodeTracker>(std::move(model));
}

}  // namespace wearwell::prognosis
