#include "wearwell/regress/criterion.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

constexpr std::array<std::pair<std::string_view, Criterion>, 6> names = {
    {{"loo", Criterion::loo},
     {"aic", Criterion::aic},
     {"aicc", Criterion::aicc},
     {"bic", Criterion::bic},
     {"cp", Criterion::cp},
     {"adjr2", Criterion::adjr2}}};

}  // namespace

Criterion read_criterion(std::string_view name) {
  for (const auto& [known, criterion] : names) {
    if (known == name) return criterion;
  }
  throw InputError(
      fmt::format("criterion '{}' is unknown; use loo, aic, aicc, bic, cp or adjr2", name));
}

std::string_view name_of(Criterion criterion) {
  for (const auto& [known, value] : names) {
    if (value == criterion) return known;
  }
  return "";
}

Score::Score(Criterion criterion, int rows, int terms, double tss, double s2, double log_weights)
    : criterion_(criterion),
      rows_(rows),
      tss_(tss),
      s2_(s2),
      log_weights_(log_weights),
      factor_(terms + 1, infinity),
      offset_(terms + 1, 0) {
  const double n = rows;
  for (int size = 1; size <= terms && size < rows; ++size) {
    const double k = size;
    switch (criterion) {
      case Criterion::loo:
        factor_[size] = 1;
        break;
      case Criterion::aic:
        factor_[size] = std::exp(2 * k / n);
        break;
      case Criterion::aicc:
        if (n - k - 2 > 0)
          factor_[size] = std::exp((2 * k + 2 * (k + 1) * (k + 2) / (n - k - 2)) / n);
        break;
      case Criterion::bic:
        factor_[size] = std::exp(k * std::log(n) / n);
        break;
      case Criterion::cp:
        factor_[size] = 1;
        offset_[size] = 2 * s2 * k;
        break;
      case Criterion::adjr2:
        factor_[size] = 1 / (n - k);
        break;
    }
  }
}

double Score::error_at(double score, int size) const {
  return factor_[size] == infinity ? -infinity : (score - offset_[size]) / factor_[size];
}

double Score::value(double score) const {
  switch (criterion_) {
    case Criterion::loo:
      return score;
    case Criterion::cp:
      return score / s2_ - rows_;
    case Criterion::adjr2:
      return 1 - score * (rows_ - 1) / tss_;
    case Criterion::aic:
    case Criterion::aicc:
      break;
    case Criterion::bic:
      // Sigma counts as a parameter: 2 in aic and aicc, log n in bic.
      return rows_ * (std::log(2 * std::numbers::pi * score / rows_) + 1) + std::log(rows_) -
             log_weights_;
  }
  return rows_ * (std::log(2 * std::numbers::pi * score / rows_) + 1) + 2 - log_weights_;
}

double Score::worse_by(double best, double distance) const {
  switch (criterion_) {
    case Criterion::loo:
      return best * (1 + distance);
    case Criterion::cp:
      return best + distance * s2_;
    case Criterion::adjr2:
      return best + distance * tss_ / (rows_ - 1);
    default:
      return best * std::exp(distance / rows_);
  }
}

}  // namespace wearwell
