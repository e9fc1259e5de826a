#include "wearwell/prob/reporting_delay.h"

#include <array>
#include <map>
#include <tuple>

#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

// What a response says of the life where the delay is known.
struct DelayedResponse {
  enum { impossible, certain, possible } kind = impossible;
  Response of_life = {};
};

DelayedResponse without_delay(const Response& y, double delay, double warranty) {
  const double lower = std::min(y.at - delay, warranty);
  switch (y.seen) {
    case Censoring::right:
      if (!(lower > 0)) return {DelayedResponse::certain};
      return {DelayedResponse::possible, {.seen = Censoring::right, .at = lower}};
    case Censoring::left:
      if (!(lower > 0)) return {};
      return {DelayedResponse::possible, {.seen = Censoring::left, .at = lower}};
    case Censoring::interval:
      break;
    case Censoring::none:
      return {};
  }
  const double upper = std::min(y.until - delay, warranty);
  if (!(upper > 0) || !(upper > lower)) return {};
  if (!(lower > 0)) return {DelayedResponse::possible, {.seen = Censoring::left, .at = upper}};
  return {DelayedResponse::possible, {.seen = Censoring::interval, .at = lower, .until = upper}};
}

// The logarithm of a weighted sum of exponentials, and the weighted mean of their slopes.
class SumOfTerms {
 public:
  explicit SumOfTerms(std::size_t slopes) : slopes_(slopes) {}

  void add(double weight, double log_term, const double* slope) {
    if (!(log_term > -infinity)) return;
    if (log_term > most_) {
      const double scale = std::exp(most_ - log_term);
      sum_ *= scale;
      for (std::size_t s = 0; s < slopes_; ++s) slope_[s] *= scale;
      most_ = log_term;
    }
    const double part = weight * std::exp(log_term - most_);
    sum_ += part;
    for (std::size_t s = 0; s < slopes_ && slope; ++s) slope_[s] += part * slope[s];
  }

  double value() const { return sum_ > 0 ? most_ + std::log(sum_) : -infinity; }
  void slopes(std::span<double> to) const {
    for (std::size_t s = 0; s < to.size(); ++s) to[s] = sum_ > 0 ? slope_[s] / sum_ : 0;
  }

 private:
  std::size_t slopes_;
  double most_ = -infinity, sum_ = 0;
  std::array<double, LifeMixture::most_parameters> slope_ = {};
};

// The same as of the mixture, faster for one family.
double log_of_life(const LifeMixture& life, const Response& y, const double* parameters,
                   std::span<double> slope) {
  if (!life.plain()) return life.log_response(y, parameters, slope);
  if (slope.empty()) return log_response_value(life.families.front(), y, parameters);
  const ResponseTerm term = log_response(life.families.front(), y, parameters);
  std::copy_n(term.slope, slope.size(), slope.begin());
  return term.value;
}

}  // namespace

double log_response(const LifeMixture& life, const ReportingDelay& delay, const Response& y,
                    const double* parameters, std::span<double> slope) {
  std::array<double, LifeMixture::most_parameters> own{};
  const std::span<double> wanted = std::span(own).first(slope.size());
  SumOfTerms sum(slope.size());
  for (std::size_t j = 0; j < delay.time.size(); ++j) {
    const DelayedResponse at = without_delay(y, delay.time[j], delay.warranty);
    if (at.kind == DelayedResponse::impossible) continue;
    if (at.kind == DelayedResponse::certain) {
      sum.add(delay.share[j], 0, nullptr);
    } else {
      sum.add(delay.share[j], log_of_life(life, at.of_life, parameters, wanted), own.data());
    }
  }
  sum.slopes(slope);
  return sum.value();
}

double log_reported(const LifeMixture& life, const ReportingDelay& delay, double age,
                    const double* parameters) {
  return log_response(life, delay, {.seen = Censoring::left, .at = age}, parameters);
}

double log_unreported(const LifeMixture& life, const ReportingDelay& delay, double age,
                      const double* parameters) {
  return log_response(life, delay, {.seen = Censoring::right, .at = age}, parameters);
}

void log_responses(const LifeMixture& life, const ReportingDelay& delay,
                   const ResponseColumn& column, std::size_t begin,
                   std::span<const ParameterValues> family_parameters, std::span<double> value,
                   std::span<double> slope) {
  const std::size_t n = value.size(), count = life.parameters();
  std::array<double, LifeMixture::most_parameters> x{}, own{};
  const std::span<double> wanted =
      slope.empty() ? std::span<double>() : std::span(own).first(count);
  const bool alike = std::all_of(family_parameters.begin(), family_parameters.begin() + count,
                                 [](const ParameterValues& each) { return each.uniform; });
  std::map<std::tuple<Censoring, double, double>, std::size_t> known;
  for (std::size_t i = 0; i < n; ++i) {
    const Response& y = column.rows[begin + i];
    // Rows of one age, of which a triangle has many, are equal.
    const auto [at, is_new] = known.try_emplace(std::tuple(y.seen, y.at, y.until), i);
    if (alike && !is_new) {
      value[i] = value[at->second];
      for (std::size_t s = 0; s < wanted.size(); ++s) slope[s * n + i] = slope[s * n + at->second];
      continue;
    }
    for (std::size_t s = 0; s < count; ++s) x[s] = family_parameters[s][i];
    value[i] = log_response(life, delay, y, x.data(), wanted);
    for (std::size_t s = 0; s < wanted.size(); ++s) slope[s * n + i] = own[s];
  }
}

}  // namespace wearwell
