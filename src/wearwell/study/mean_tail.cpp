#include "wearwell/study/mean_tail.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

constexpr double highest_part = 0.01;

// "83 %", "99.2 %"; never rounded to all of it.
std::string share_text(double share) {
  if (share >= 0.9995) return share < 1 ? "over 99.9 %" : "all";
  return share < 0.1 || share > 0.99 ? fmt::format("{:.3g} %", 100 * share)
                                     : fmt::format("{:.0f} %", 100 * share);
}

std::string mean_name(const QuantitySummary& mean) {
  // Of a function of the parameters its name, as the study has it.
  if (!mean.best().predictive && mean.of == "population") return mean.name;
  return fmt::format("the {} of {}{}{}", mean.name, mean.of, mean.at.empty() ? "" : " ", mean.at);
}

bool is_carried(const QuantityQuantiles& q) {
  return q.mean_tail->highest > most_of_highest && !is_endless_mean(q);
}

bool rests_beyond(const MeanTail& tail) {
  return tail.beyond.value_or(0) > most_beyond;
}

std::string beyond_text(const QuantitySummary& mean, const MeanTail& tail) {
  return fmt::format("{} of {} comes from lives beyond {:.4g} {}, as far as the data reach",
                     share_text(*tail.beyond), mean_name(mean), *tail.longest, mean.unit);
}

std::string highest_text(const QuantitySummary& mean, const MeanTail& tail) {
  return fmt::format("the highest 1 % of the posterior carries {} of the posterior mean of {}",
                     share_text(tail.highest), mean_name(mean));
}

std::string endless_text(const QuantitySummary& mean) {
  return fmt::format("the posterior mean of {} is {}: {}", mean_name(mean), not_finite_text,
                     reason_of_endless_mean(mean.best()));
}

constexpr const char* advice_beyond =
    "This mean rests on the upper tail of the distribution, not on data. Read the median (B50), or "
    "test until more items fail.";
constexpr const char* advice_highest =
    "This average changes with the tails of the priors and need not be finite. Read the quantiles.";
constexpr const char* advice_never = "Read the quantiles.";
constexpr const char* advice_endless =
    "The tails of the priors decide on this average, not the data. Read the quantiles, or state "
    "what is known of the shape of the distribution in its prior.";

std::string capitalized(std::string text) {
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

}  // namespace

std::optional<double> share_of_highest(const QuantityDistribution& value) {
  std::vector<std::pair<double, double>> sizes;  // with their weights
  double sum = 0, weight = 0;
  value.visit([&](double w, double center, double) {
    sizes.emplace_back(std::abs(center), w);
    sum += w * std::abs(center);
    weight += w;
  });
  if (!(sum > 0)) return {};
  if (!std::isfinite(sum)) return 1;
  std::sort(sizes.rbegin(), sizes.rend());
  double left = highest_part * weight, highest = 0;
  for (const auto& [size, w] : sizes) {
    highest += std::min(left, w) * size;
    left -= w;
    if (!(left > 0)) break;
  }
  return highest / sum;
}

double share_of_highest(const CellMixture& value) {
  const double mean = value.mean(), from = value.quantile(1 - highest_part);
  if (!std::isfinite(mean) || !std::isfinite(from)) return 1;
  const CellMixture above = value.beyond(from);
  const double share = above.mass() / value.mass();
  const double highest =
      (share > 0 ? share * (from + above.mean()) : 0) + std::max(0.0, highest_part - share) * from;
  return mean > 0 ? highest / mean : highest_part;
}

bool is_endless_mean(const QuantityQuantiles& q) {
  return q.mean_tail && std::isinf(q.predictive ? *q.predictive : q.mean.value_or(0));
}

void refuse_endless_mean(QuantityQuantiles& q) {
  if (!q.mean_tail || !(q.mean_tail->highest > most_of_finite)) return;
  for (std::optional<double>* each : {&q.predictive, &q.mean})
    if (*each && std::isfinite(**each)) *each = std::copysign(infinity, **each);
}

std::string reason_of_endless_mean(const QuantityQuantiles& q) {
  if (!is_endless_mean(q)) return "";
  return q.mean_tail->highest >= 1
             ? "at a part of the posterior it is infinite, as where some items never "
               "fail or never reach the threshold"
             : fmt::format("the highest 1 % of the posterior carries {} of its sum",
                           share_text(q.mean_tail->highest));
}

std::vector<std::string> mean_tail_remarks(const std::vector<QuantitySummary>& quantities,
                                           bool bounds) {
  std::vector<std::string> beyond, carried, endless, never;
  for (const QuantitySummary& each : quantities) {
    const QuantityQuantiles& q = each.best();
    if (!q.mean_tail || q.predictive.has_value() != bounds) continue;
    if (rests_beyond(*q.mean_tail)) beyond.push_back(beyond_text(each, *q.mean_tail));
    if (is_carried(q))
      carried.push_back(highest_text(each, *q.mean_tail) + (bounds ? " (next one)" : ""));
    if (is_endless_mean(q))
      (q.mean_tail->highest < 1 ? endless : never)
          .push_back(endless_text(each) + (bounds ? " (next one)" : ""));
  }
  std::vector<std::string> remarks;
  const auto add = [&](const std::vector<std::string>& means, const char* advice) {
    if (!means.empty())
      remarks.push_back(capitalized(fmt::format("{}. {}", fmt::join(means, "; "), advice)));
  };
  add(beyond, advice_beyond);
  add(carried, advice_highest);
  add(endless, advice_endless);
  add(never, advice_never);
  return remarks;
}

std::optional<Check> mean_life_check(const std::vector<QuantitySummary>& quantities) {
  Findings findings("mean-life");
  double most = 0, highest = 0;
  bool any = false, observed = false;
  for (const QuantitySummary& each : quantities) {
    const std::optional<MeanTail>& tail = each.best().mean_tail;
    // A mean of a derived quantity is an aside: it counts only where it is doubtful.
    if (!tail) continue;
    // An infinite value of a derived quantity states itself.
    const bool endless =
        is_endless_mean(each.best()) && (each.best().predictive || tail->highest < 1);
    if (!each.best().predictive && !endless && !is_carried(each.best())) continue;
    any = true;
    observed |= tail->beyond.has_value();
    most = std::max(most, tail->beyond.value_or(0));
    if (std::isfinite(each.best().predictive.value_or(0)))
      highest = std::max(highest, tail->highest);
    if (rests_beyond(*tail)) findings.add(Verdict::warn, beyond_text(each, *tail), advice_beyond);
    if (is_carried(each.best()))
      findings.add(Verdict::warn, highest_text(each, *tail), advice_highest);
    if (endless)
      findings.add(Verdict::warn, endless_text(each),
                   tail->highest < 1 ? advice_endless : advice_never);
  }
  if (!any) return {};
  const std::string carried =
      fmt::format("the highest 1 % of the posterior carries at most {} of a posterior mean",
                  share_text(highest));
  return findings.result(
      observed ? fmt::format("at most {} of a mean life comes from lives beyond the data; {}",
                             share_text(most), carried)
               : carried);
}

}  // namespace wearwell
