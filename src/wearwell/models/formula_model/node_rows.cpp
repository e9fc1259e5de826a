#include "wearwell/models/formula_model/node_rows.h"

#include <algorithm>
#include <cmath>

#include "wearwell/formula/vector_math.h"
#include "wearwell/math/constants.h"
#include "wearwell/prob/response_block.h"

namespace wearwell::formula_model {
namespace {

// P(Y <= y) and P(Y >= y), given that it was observed at all; for a censored observation its
// probability.
struct Place {
  double below, above;
};

// Exact, not truncated, and normal, as most readings are.
bool is_plain_normal(const Measured& measured, const Response& y) {
  return !measured.process && measured.form->family == ResponseFamily::normal &&
         y.seen == Censoring::none && !(y.entry > -infinity);
}

Place place_of(const ResponseForm& form, const Response& y, const double* family_parameters) {
  if (form.family == ResponseFamily::normal && y.seen == Censoring::none &&
      !(y.entry > -infinity)) {
    const double tail = 0.5 * std::erfc(std::abs(y.at - family_parameters[0]) /
                                        family_parameters[1] * std::sqrt(0.5));
    return y.at < family_parameters[0] ? Place{tail, 1 - tail} : Place{1 - tail, tail};
  }
  if (y.seen != Censoring::none) {
    const double p = std::exp(log_response_value(form.family, y, family_parameters));
    return {0.5 * p, 0.5 * p};
  }
  double below = std::exp(log_cdf(form.family, y.at, family_parameters, y.trials));
  double above = std::exp(log_survival(form.family, y.at, family_parameters, y.trials));
  if (form.counted)
    above =
        y.at > 0 ? std::exp(log_survival(form.family, y.at - 1, family_parameters, y.trials)) : 1;
  if (y.entry > -infinity) {
    const double seen = std::exp(log_survival(form.family, y.entry, family_parameters));
    above = seen > 0 ? above / seen : 0;
    below = 1 - above;
  }
  return {below, above};
}

// Without branches, so that the loop vectorizes.
void add_normal(std::span<const double> mean, std::span<const double> sd, double y, int count,
                double* to) {
  for (std::size_t i = 0; i < mean.size(); ++i) {
    const double z = (y - mean[i]) / sd[i];
    const double value = count * (-0.5 * z * z - formula::vector_log(sd[i]) - half_log_two_pi);
    to[i] += sd[i] > 0 && std::abs(value) < infinity ? value : -infinity;
  }
}

}  // namespace

double Predicted::p_value() const {
  return std::min(1.0, 2 * std::min(below_, above_));
}

// The nodes of one pass with their distribution parameters.
struct NodeRows::Block {
  std::size_t begin, count;
  ParameterValues family_parameters[most_response_parameters];
  bool noisy, particles;  // particles: each node has its own fixed parameters
};

NodeRows::NodeRows(std::shared_ptr<const FormulaModel> model,
                   const std::vector<formula::Wanted>& limited, bool open)
    : model_(std::move(model)) {
  for (const Measured& each : model_->measured) {
    programs_.emplace_back(*model_, each.wanted, open);
    follows_ |= each.process != nullptr;
  }
  programs_.emplace_back(*model_, limited, open);
  for (const NodeProgram& each : programs_) runs_ |= each.running() > 0;
  follows_ |= runs_;
}

bool NodeRows::fit(const std::vector<NodePath>& paths, std::size_t nodes) const {
  const auto all = [&](const std::vector<double>& values) { return values.size() == nodes; };
  if (paths.size() != programs_.size()) return false;
  for (std::size_t m = 0; m < paths.size(); ++m) {
    const NodePath& path = paths[m];
    const std::size_t running = path.begun ? programs_[m].running() : 0;
    if (path.carried.size() != running || !std::isfinite(path.place)) return false;
    if (!std::all_of(path.carried.begin(), path.carried.end(), all)) return false;
    if (!std::isfinite(path.reading)) return false;
    const Measured* measured = m < model_->measured.size() ? &model_->measured[m] : nullptr;
    const bool process = measured && measured->process && path.measured;
    const bool noisy = process && measured->wanted.size() > 2;
    for (const auto* each : {&path.mean, &path.spread}) {
      if (process ? !all(*each) : !each->empty() && !all(*each)) return false;
    }
    for (const auto* each : {&path.at, &path.variance}) {
      if (noisy ? !all(*each) : !each->empty() && !all(*each)) return false;
    }
  }
  return true;
}

void NodeRows::plain_block(const Block& block, const Measured& measured, const Response& y,
                           int count, const ResponseColumn& column, double* to) const {
  const ParameterValues mean = block.family_parameters[0], sd_of = block.family_parameters[1];
  if (is_plain_normal(measured, y) && block.particles && !mean.uniform && !sd_of.uniform) {
    add_normal({mean.at, block.count}, {sd_of.at, block.count}, y.at, count, to);
    return;
  }
  if (is_plain_normal(measured, y)) {
    // Nodes of a line share the fixed parameters: what depends only on these is computed once.
    for (std::size_t begin = 0; begin < block.count;) {
      const double sd = block.family_parameters[1][begin];
      std::size_t end = begin + 1;
      while (end < block.count && block.family_parameters[1][end] == sd) ++end;
      const double by_sd = 1 / sd, log_sd = std::log(sd) + half_log_two_pi;
      const bool possible = sd > 0 && std::isfinite(by_sd + log_sd);
      for (std::size_t i = begin; i < end; ++i) {
        const double z = (y.at - block.family_parameters[0][i]) * by_sd;
        const double value = count * (-0.5 * z * z - log_sd);
        to[i] += possible && value > -infinity ? value : -infinity;
      }
      begin = end;
    }
    return;
  }
  double value[NodeProgram::most];
  log_responses(measured.form->family, column, 0, block.family_parameters, {value, block.count},
                {});
  for (std::size_t i = 0; i < block.count; ++i) {
    to[i] += std::isnan(value[i]) ? -infinity : count * value[i];
  }
}

// The term of a step of node i, as process_terms has it for whole units.
void NodeRows::process_block(const Block& block, const Measured& measured, double y,
                             const NodePath& before, NodePath* after, double* to) const {
  const ProcessForm& form = *measured.process;
  for (std::size_t i = 0; i < block.count; ++i) {
    const std::size_t node = block.begin + i;
    const double mean = block.family_parameters[0][i], spread = block.family_parameters[1][i];
    const double noise = block.noisy ? block.family_parameters[2][i] : 0;
    const double dm = mean - (before.measured ? before.mean[node] : 0);
    double at = y, variance = 0, value = -infinity;
    if (form.process == Process::wiener) {
      const double earlier = before.measured ? before.spread[node] : 0;
      const double step = form.by_sd ? spread * spread - earlier * earlier : spread * dm;
      const double from = !before.measured ? 0 : block.noisy ? before.at[node] : before.reading;
      const double predicted = step + (before.measured && block.noisy ? before.variance[node] : 0);
      const double all = predicted + noise * noise, off = y - (from + dm);
      if (step >= 0 && all > 0 && std::isfinite(off)) {
        value = -half_log_two_pi - 0.5 * (std::log(all) + off * off / all);
        at = from + dm + predicted / all * off;
        variance = predicted * noise * noise / all;
      }
    } else {
      const double dy = y - (before.measured ? before.reading : 0);
      process_terms(form, {{&dy, 1}, {&dm, 1}, {&spread, 1}, {}}, {&value, 1}, {});
    }
    to[i] += std::isnan(value) ? -infinity : value;
    if (!after) continue;
    after->mean[node] = mean;
    after->spread[node] = spread;
    if (!block.noisy) continue;
    after->at[node] = at;
    after->variance[node] = variance;
  }
}

namespace {

// The same step as a quantile of its predictive distribution.
Place place_of_step(const ProcessForm& form, double y, double mean, double spread, double noise,
                    const NodePath& before, std::size_t node) {
  const double dm = mean - (before.measured ? before.mean[node] : 0);
  const bool noisy = !before.at.empty() || noise > 0;
  if (form.process == Process::wiener) {
    const double earlier = before.measured ? before.spread[node] : 0;
    const double step = form.by_sd ? spread * spread - earlier * earlier : spread * dm;
    const double from = !before.measured ? 0 : noisy ? before.at[node] : before.reading;
    const double all =
        step + noise * noise + (before.measured && noisy ? before.variance[node] : 0);
    const double z = (y - (from + dm)) / std::sqrt(all);
    return std::isnan(z) ? Place{0, 0} : Place{normal_cdf(z), normal_cdf(-z)};
  }
  const double dy = y - (before.measured ? before.reading : 0);
  if (!(dm > 0 && dy > 0)) return {dy > 0 ? 1.0 : 0.0, dy > 0 ? 0.0 : 1.0};
  const bool gamma = form.process == Process::gamma;
  const ResponseFamily family = gamma ? ResponseFamily::gamma : ResponseFamily::inverse_gaussian;
  const double family_parameters[most_response_parameters] = {gamma ? dm / spread : dm,
                                                              gamma ? spread : dm * dm / spread};
  return {std::exp(log_cdf(family, dy, family_parameters)),
          std::exp(log_survival(family, dy, family_parameters))};
}

// Allocates the positions of the nodes.
void prepare(const NodeProgram& program, bool process, std::size_t count, bool noisy,
             const NodePath& before, NodePath& after) {
  after = before;
  after.carried.resize(program.running(), std::vector<double>(count));
  if (!process) return;
  after.mean.resize(count);
  after.spread.resize(count);
  if (!noisy) return;
  after.at.resize(count);
  after.variance.resize(count);
}

void carry_on(const NodeProgram& program, const NodeProgram::Scratch& scratch, std::size_t begin,
              std::size_t count, NodePath& after) {
  static thread_local std::vector<double> carried;
  carried.resize(program.running());
  for (std::size_t i = 0; i < count; ++i) {
    program.carry(scratch, i, carried);
    for (std::size_t r = 0; r < carried.size(); ++r) after.carried[r][begin + i] = carried[r];
  }
}

NodeProgram::GoesOn from(const NodePath& path) {
  if (!path.begun) return {};
  return {path.place, &path.carried, nullptr, 0};
}

// The quantity with the threshold has no readings of its own.
void walk(const NodeProgram& program, NodeProgram::Scratch& scratch, const Nodes& nodes,
          const UnitReading& reading, const NodePath& before, NodePath& after) {
  prepare(program, false, nodes.count(), false, before, after);
  for (std::size_t begin = 0; begin < nodes.count(); begin += NodeProgram::most) {
    const std::size_t count = std::min(NodeProgram::most, nodes.count() - begin);
    program.evaluate(nodes, begin, count, reading.row, nullptr, from(before), scratch);
    carry_on(program, scratch, begin, count, after);
  }
  after.begun = true;
  after.place = reading.place;
}

}  // namespace

void NodeRows::look(const Nodes& nodes, const UnitReading& reading,
                    const std::vector<NodePath>& before, std::vector<NodePath>* after,
                    std::span<double> log_likelihood, const Sample* sample,
                    ReadingPrediction* prediction, const double* places) const {
  std::unique_ptr<Scratch>& scratch = scratch_.local();
  if (!scratch) {
    scratch = std::make_unique<Scratch>();
    for (const NodeProgram& each : programs_) scratch->programs.emplace_back(each);
  }
  static constexpr double zero = 0;
  std::fill(log_likelihood.begin(), log_likelihood.end(), 0.0);
  double least = 1, columns = 0;
  if (prediction) prediction->tails.clear();
  for (std::size_t m = 0; m < programs_.size(); ++m) {
    const NodeProgram& program = programs_[m];
    const bool runs = program.running() > 0;
    if (m == model_->measured.size()) {
      if (runs && after)
        walk(program, scratch->programs[m], nodes, reading, before[m], (*after)[m]);
      break;
    }
    const Measured& measured = model_->measured[m];
    const std::optional<Response>& y = reading.responses[m];
    if (!y && !runs) continue;
    const bool noisy = measured.process && measured.wanted.size() > 2;
    NodePath* const moved = after && (runs || measured.process) ? &(*after)[m] : nullptr;
    if (moved) prepare(program, measured.process, nodes.count(), noisy, before[m], *moved);
    const ResponseColumn column(y && !measured.process && !is_plain_normal(measured, *y)
                                    ? std::vector<Response>(NodeProgram::most, *y)
                                    : std::vector<Response>());
    const NodeProgram::GoesOn on = runs ? from(before[m]) : NodeProgram::GoesOn();
    Predicted predicted;
    std::size_t next = 0;  // of the sample
    for (std::size_t begin = 0; begin < nodes.count(); begin += NodeProgram::most) {
      Block block{begin,
                  std::min(NodeProgram::most, nodes.count() - begin),
                  {},
                  noisy,
                  nodes.per_line == 1};
      program.evaluate(nodes, begin, block.count, reading.row, places ? places + begin : nullptr,
                       on, scratch->programs[m]);
      for (ParameterValues& each : block.family_parameters) each = {&zero, true};
      for (std::size_t o = 0; o < program.outputs().size(); ++o) {
        block.family_parameters[measured.family_parameter[o]] = {
            program.values(o, scratch->programs[m]).data(), program.outputs()[o].uniform};
      }
      if (moved && runs) carry_on(program, scratch->programs[m], begin, block.count, *moved);
      if (!y) continue;
      for (; sample && next < sample->node.size() && sample->node[next] < begin + block.count;
           ++next) {
        const std::size_t i = sample->node[next] - begin;
        const double family_parameters[] = {block.family_parameters[0][i],
                                            block.family_parameters[1][i],
                                            block.family_parameters[2][i]};
        const Place place =
            measured.process
                ? place_of_step(*measured.process, y->at, family_parameters[0],
                                family_parameters[1], family_parameters[2], before[m], begin + i)
                : place_of(*measured.form, *y, family_parameters);
        if (!std::isnan(place.below + place.above))
          predicted.add(sample->weight[next], place.below, place.above);
      }
      if (log_likelihood.empty()) continue;
      double* const to = &log_likelihood[begin];
      measured.process ? process_block(block, measured, y->at, before[m], moved, to)
                       : plain_block(block, measured, *y, reading.count, column, to);
    }
    if (moved) {
      moved->begun = true;
      moved->place = reading.place;
      if (y) {
        moved->measured = true;
        moved->reading = y->at;
      }
    }
    if (!y) continue;
    least = std::min(least, predicted.p_value());
    ++columns;
    if (prediction && y->seen == Censoring::none && predicted.any())
      prediction->tails.push_back(predicted.tails());
  }
  if (prediction) prediction->p_value = std::min(1.0, least * std::max(columns, 1.0));
}

}  // namespace wearwell::formula_model
