#include "wearwell/regress/relaxation.h"

#include <algorithm>
#include <cmath>

#include "wearwell/regress/row_kernels.h"

namespace wearwell {
namespace {

using namespace row_kernels;

/// Columns shorter than this fraction of their length after orthogonalization have no independent
/// direction.
constexpr double dependence_tolerance = 1e-8;

int filled(int count) {
  return (count + row_block - 1) / row_block * row_block;
}

}  // namespace

void Relaxation::factor(std::span<double* const> columns, double* response, int rows) {
  const int count = static_cast<int>(columns.size());
  size_ = count;
  stride_ = filled(count);
  upper_.resize(static_cast<std::size_t>(count) * static_cast<std::size_t>(stride_));
  length2_.resize(count);
  original2_.resize(count);
  coordinate_.assign(count, -1);
  z_.assign(stride_, 0.0);
  rank_ = 0;
  for (int j = 0; j < count; ++j) original2_[j] = dot(columns[j], columns[j], rows);
  for (int j = 0; j < count; ++j) {
    length2_[j] = dot(columns[j], columns[j], rows);
    if (!(length2_[j] > dependence_tolerance * dependence_tolerance * original2_[j])) continue;
    const double inverse = 1 / length2_[j];
    for (int k = j + 1; k < count; ++k) {
      const double along = dot(columns[j], columns[k], rows) * inverse;
      upper_[j * stride_ + k] = along;
      subtract(columns[k], along, columns[j], columns[k], rows);
    }
    const double along = dot(columns[j], response, rows) * inverse;
    subtract(response, along, columns[j], response, rows);
    z_[rank_] = along * std::sqrt(length2_[j]);
    coordinate_[j] = rank_++;
  }
  rss_ = dot(response, response, rows);
  dependent_ = rank_ < count;
  coefficient_.resize(count);
  cost_.resize(count);
  invert(count);
}

void Relaxation::invert(int count) {
  // The inverse of the unit triangle, its rows from the bottom.
  x_.assign(static_cast<std::size_t>(count) * static_cast<std::size_t>(stride_), 0.0);
  for (int j = count - 1; j >= 0; --j) {
    if (coordinate_[j] < 0) continue;
    row(j)[coordinate_[j]] = 1;
    for (int k = j + 1; k < count; ++k) {
      if (coordinate_[k] >= 0) subtract(row(j), upper_[j * stride_ + k], row(k), row(j), stride_);
    }
  }
  costless_.assign(count, 0);
  if (dependent_) find_replaceable(count);
  for (int k = 0; k < count; ++k) {
    if (coordinate_[k] < 0) continue;
    const double scale = 1 / std::sqrt(length2_[k]);
    for (int j = 0; j <= k; ++j) row(j)[coordinate_[k]] *= scale;
  }
}

void Relaxation::find_replaceable(int count) {
  for (int u = 0; u < count; ++u) {
    if (coordinate_[u] >= 0) continue;
    costless_[u] = 1;
    // Column u is this combination of the independent ones; it can replace those that it uses.
    for (int t = 0; t < u; ++t) {
      double share = 0;
      for (int j = 0; j < u; ++j) {
        if (coordinate_[j] >= 0) share += row(t)[coordinate_[j]] * upper_[j * stride_ + u];
      }
      if (std::abs(share) * std::sqrt(original2_[t]) > 1e-10 * std::sqrt(original2_[u]))
        costless_[t] = 1;
    }
  }
}

void Relaxation::fix(int count) {
  size_ -= count;
  x_.erase(x_.begin(), x_.begin() + count * stride_);
  costless_.erase(costless_.begin(), costless_.begin() + count);
}

double Relaxation::aim(const double* removed, int rank) {
  mirror_.assign(removed, removed + filled(rank));
  const double length = std::sqrt(dot(removed, removed, filled(rank)));
  double& last = mirror_[rank - 1];
  last += std::copysign(length, last);
  return 2 / dot(mirror_.data(), mirror_.data(), filled(rank));
}

void Relaxation::reflect(const double* from, double factor, double* to) const {
  const int length = static_cast<int>(mirror_.size());
  subtract(from, factor * dot(from, mirror_.data(), length), mirror_.data(), to, length);
}

void Relaxation::drop(int t) {
  const double factor = aim(row(t), rank_);
  for (int u = 0; u < size_; ++u) {
    if (u == t) continue;
    double* const to = row(u < t ? u : u - 1);
    reflect(row(u), factor, to);
    to[rank_ - 1] = 0;
  }
  reflect(z_.data(), factor, z_.data());
  --size_;
  --rank_;
  rss_ += z_[rank_] * z_[rank_];
  z_[rank_] = 0;
}

void Relaxation::drop_first(const Relaxation& from, std::span<const int> order) {
  size_ = static_cast<int>(order.size()) - 1;
  rank_ = from.rank_ - 1;
  stride_ = filled(from.rank_);
  dependent_ = false;
  x_.resize(static_cast<std::size_t>(size_) * static_cast<std::size_t>(stride_));
  z_.resize(stride_);
  costless_.assign(size_, 0);
  coefficient_.resize(size_);
  cost_.resize(size_);
  const double factor = aim(from.row(order[0]), from.rank_);
  for (int u = 0; u < size_; ++u) {
    reflect(from.row(order[u + 1]), factor, row(u));
    row(u)[rank_] = 0;
  }
  reflect(from.z_.data(), factor, z_.data());
  rss_ = from.rss_ + z_[rank_] * z_[rank_];
  z_[rank_] = 0;
}

void Relaxation::analyse() {
  const int length = filled(rank_);
  for (int t = 0; t < size_; ++t) {
    coefficient_[t] = dot(row(t), z_.data(), length);
    cost_[t] = costless_[t] ? 0 : coefficient_[t] * coefficient_[t] / dot(row(t), row(t), length);
  }
}

}  // namespace wearwell
