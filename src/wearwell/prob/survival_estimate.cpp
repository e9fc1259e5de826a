#include "wearwell/prob/survival_estimate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "wearwell/base/stop_scope.h"
#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

// Cells with less are empty: the iteration only approaches 0.
constexpr double least_share = 1e-6;

std::vector<SurvivalStep> by_kaplan_meier(std::span<const Response> responses,
                                          std::span<const int> counts) {
  // Who is at risk at a time: of those that last until then or longer, all that were watched from before it on.
  const auto later_first = [&](auto time, auto wanted) {
    std::vector<std::pair<double, double>> order;  // time and count
    for (std::size_t i = 0; i < responses.size(); ++i) {
      check_stop();
      if (wanted(responses[i])) order.emplace_back(time(responses[i]), counts[i]);
    }
    std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) {
      check_stop();
      return a > b;
    });
    return order;
  };
  const auto end_of = [](const Response& y) { return y.at; };
  const auto was_watched = [](const Response& y) { return y.entry < y.at; };
  const auto failures =
      later_first(end_of, [](const Response& y) { return y.seen == Censoring::none; });
  const auto ends = later_first(end_of, was_watched);
  const auto entries =
      later_first([](const Response& y) { return y.entry; },
                  [&](const Response& y) { return was_watched(y) && y.entry > -infinity; });
  struct Step {
    double at, failed, at_risk;
  };
  std::vector<Step> steps;  // the latest first
  double lasting = 0, unwatched = 0;
  std::size_t ended = 0, entered = 0;
  for (const auto& [at, count] : failures) {
    check_stop();
    if (!steps.empty() && steps.back().at == at) {
      steps.back().failed += count;
      continue;
    }
    while (ended < ends.size() && ends[ended].first >= at) lasting += ends[ended++].second;
    while (entered < entries.size() && entries[entered].first >= at)
      unwatched += entries[entered++].second;
    steps.push_back({at, count, lasting - unwatched});
  }
  std::vector<SurvivalStep> all;
  double survival = 1, sum = 0;
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    check_stop();
    survival *= 1 - step->failed / step->at_risk;
    sum += step->failed / (step->at_risk * (step->at_risk - step->failed));
    all.push_back({step->at, step->at, step->failed, step->at_risk, survival,
                   survival > 0 ? survival * std::sqrt(sum) : std::nan("")});
  }
  return all;
}

// An observation in (from, to], or at one value.
struct Known {
  double from, to, count;
};

// The intervals that can have mass: from a left end to a right end with no other end between.
std::vector<Known> innermost(const std::vector<Known>& all) {
  struct End {
    double at;
    int order;  // order at one value: an inclusive left end, a right end, an exclusive left end
  };
  std::vector<End> ends;
  for (const Known& each : all) {
    check_stop();
    ends.push_back({each.from, each.from == each.to ? 0 : 2});
    ends.push_back({each.to, 1});
  }
  std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) {
    check_stop();
    return a.at < b.at || (a.at == b.at && a.order < b.order);
  });
  std::vector<Known> result;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    if (ends[i].order != 1 && ends[i + 1].order == 1)
      result.push_back({ends[i].at, ends[i + 1].at, 0});
  }
  return result;
}

bool within(const Known& inner, const Known& outer) {
  if (outer.from == outer.to) return inner.from == outer.from && inner.to == outer.to;
  return inner.from >= outer.from && inner.to <= outer.to &&
         !(inner.from == inner.to && inner.from == outer.from);
}

// The adjacent cells within a known interval.
struct Range {
  std::size_t begin, end;
};

Range cells_within(const std::vector<Known>& cells, const Known& outer) {
  const auto before = [&](const Known& cell) { return cell.to < outer.from; };
  const auto first = std::partition_point(cells.begin(), cells.end(), before);
  auto begin = static_cast<std::size_t>(first - cells.begin());
  while (begin < cells.size() && !within(cells[begin], outer)) ++begin;
  std::size_t end = begin;
  const auto not_beyond = [&](const Known& cell) { return cell.to <= outer.to; };
  const auto last = std::partition_point(cells.begin(), cells.end(), not_beyond);
  end = std::max(begin, static_cast<std::size_t>(last - cells.begin()));
  while (end > begin && !within(cells[end - 1], outer)) --end;
  return {begin, end};
}

// Standard errors of the cumulative shares of cells with mass: the inverse of the information that
// the observations have of these shares, which sum to 1. NaN if it is singular.
std::vector<double> errors_of_sums(const std::vector<Known>& all, const std::vector<Range>& held,
                                   const std::vector<double>& share) {
  constexpr std::size_t most = 300;
  std::vector<std::size_t> place(share.size() + 1, 0);  // number of cells with mass before
  for (std::size_t c = 0; c < share.size(); ++c)
    place[c + 1] = place[c] + (share[c] > least_share ? 1 : 0);
  const std::size_t count = place.back();
  std::vector<double> errors(share.size(), std::nan(""));
  if (count < 2 || count > most) return errors;
  const auto n = static_cast<Eigen::Index>(count);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < all.size(); ++i) {
    check_stop();
    const std::size_t begin = place[held[i].begin], end = place[held[i].end];
    double sum = 0;
    for (std::size_t c = held[i].begin; c < held[i].end; ++c) sum += share[c];
    if (!(sum > 0) || end == begin) continue;
    information
        .block(static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(begin),
               static_cast<Eigen::Index>(end - begin), static_cast<Eigen::Index>(end - begin))
        .array() += all[i].count / (sum * sum);
  }
  // The last share is 1 less all others; sums over the first ones are the new coordinates.
  Eigen::MatrixXd to_shares = Eigen::MatrixXd::Zero(n, n - 1);
  for (Eigen::Index k = 0; k < n - 1; ++k) {
    to_shares(k, k) = 1;
    to_shares(k + 1, k) = -1;
  }
  const Eigen::LDLT<Eigen::MatrixXd> solver(to_shares.transpose() * information * to_shares);
  const double largest = solver.vectorD().maxCoeff();
  if (solver.info() != Eigen::Success || !(solver.vectorD().minCoeff() > 1e-10 * largest))
    return errors;
  const Eigen::MatrixXd covariance = solver.solve(Eigen::MatrixXd::Identity(n - 1, n - 1));
  for (std::size_t c = 0; c < share.size(); ++c) {
    const auto k = static_cast<Eigen::Index>(place[c + 1]) - 1;
    if (k >= 0 && k < n - 1) errors[c] = std::sqrt(covariance(k, k));
  }
  return errors;
}

// Turnbull's self-consistency: distributes each observation by the current estimate until it converges. Very many
// observations take fewer rounds: the remaining changes are smaller than a plot shows.
std::vector<SurvivalStep> by_turnbull(const std::vector<Known>& all) {
  constexpr double most_rounds = 5000, fewest_rounds = 200, most_steps = 2e8;
  constexpr double still = 1e-10;
  const std::vector<Known> cells = innermost(all);
  std::vector<double> share(cells.size(), 1 / static_cast<double>(cells.size()));
  double number = 0;
  std::vector<Range> held;
  for (const Known& each : all) {
    number += each.count;
    check_stop();
    held.push_back(cells_within(cells, each));
  }
  const double rounds =
      std::clamp(most_steps / static_cast<double>(all.size()), fewest_rounds, most_rounds);
  // Sums over neighbouring cells are differences of `up_to`; what observations bring to such is added where they begin and
  // taken away where they end.
  std::vector<double> up_to(cells.size() + 1, 0), brought(cells.size() + 1);
  for (int round = 0; round < rounds; ++round) {
    check_stop();
    for (std::size_t c = 0; c < cells.size(); ++c) up_to[c + 1] = up_to[c] + share[c];
    std::fill(brought.begin(), brought.end(), 0.0);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double sum = up_to[held[i].end] - up_to[held[i].begin];
      if (!(sum > 0)) continue;
      brought[held[i].begin] += all[i].count / sum / number;
      brought[held[i].end] -= all[i].count / sum / number;
    }
    double moved = 0, here = 0;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      here += brought[c];
      const double next = share[c] * std::max(here, 0.0);
      moved = std::max(moved, std::abs(next - share[c]));
      share[c] = next;
    }
    if (moved < still) break;
  }
  const std::vector<double> errors = errors_of_sums(all, held, share);
  std::vector<SurvivalStep> result;
  double below = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    below += share[c];
    if (!(share[c] > least_share) || !(cells[c].to < infinity)) continue;
    const double left = below < 1 - 1e-9 ? 1 - below : 0;
    result.push_back({cells[c].from, cells[c].to, 0, 0, left, left > 0 ? errors[c] : std::nan("")});
  }
  return result;
}

}  // namespace

SurvivalEstimate survival_estimate(std::span<const Response> responses,
                                   std::span<const int> counts) {
  bool entries = false, intervals = false;
  for (const Response& y : responses) {
    entries |= y.entry > -infinity;
    intervals |= y.seen == Censoring::left || y.seen == Censoring::interval;
  }
  if (!intervals) return {SurvivalMethod::kaplan_meier, by_kaplan_meier(responses, counts)};
  if (entries) return {};
  std::map<std::pair<double, double>, double> alike;
  for (std::size_t i = 0; i < responses.size(); ++i) {
    check_stop();
    const Response& y = responses[i];
    const double from = y.seen == Censoring::left ? -infinity : y.at;
    const double to = y.seen == Censoring::right      ? infinity
                      : y.seen == Censoring::interval ? y.until
                                                      : y.at;
    alike[{from, to}] += counts[i];
  }
  std::vector<Known> all;
  for (const auto& [ends, count] : alike) all.push_back({ends.first, ends.second, count});
  return {SurvivalMethod::turnbull, by_turnbull(all)};
}

SurvivalBand log_log_band(const SurvivalStep& step, double z) {
  const double s = step.survival;
  if (!(s > 0 && s < 1) || std::isnan(step.error)) return {std::nan(""), std::nan("")};
  const double off = z * step.error / (s * -std::log(s));
  return {std::pow(s, std::exp(off)), std::pow(s, std::exp(-off))};
}

}  // namespace wearwell
