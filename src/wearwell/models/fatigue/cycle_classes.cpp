#include "wearwell/models/fatigue/cycle_classes.h"

#include <algorithm>
#include <cmath>

namespace wearwell::fatigue {
namespace {

constexpr std::size_t first_slots = 1 << 10;
// Factor by which the first classes are finer than the first range.
constexpr int first_exponent = -24;
constexpr double most_index = 1 << 30;

std::int32_t index(double value, double inverse_width) {
  return static_cast<std::int32_t>(std::floor(value * inverse_width));
}

std::int32_t half(std::int32_t index) {
  return index >> 1;  // toward minus infinity
}

}  // namespace

CycleClasses::CycleClasses(double wanted, double width, std::vector<Cell> cells)
    : wanted_(wanted), width_(width), inverse_(1 / width), cells_(std::move(cells)) {
  if (width_ > 0) lay_out(std::max(first_slots, 4 * cells_.size()));
}

bool CycleClasses::within(double range, double mean) const {
  return range * inverse_ < most_index && std::abs(mean) * inverse_ < most_index;
}

void CycleClasses::begin(double range) {
  width_ = wanted_ > 0 ? wanted_ : 1;
  width_ = std::ldexp(width_, std::ilogb(range / width_) + first_exponent);
  // The requested width must be a multiple of the class width.
  if (wanted_ > 0) width_ = std::min(width_, wanted_);
  inverse_ = 1 / width_;
  lay_out(first_slots);
}

void CycleClasses::add(double range, double mean, double count) {
  if (width_ == 0) begin(range);
  while (!within(range, mean)) widen();
  std::int32_t i = index(range, inverse_), j = index(mean, inverse_);
  std::size_t* at = &slot(i, j);
  if (*at == 0) {
    while (cells_.size() >= most_classes && (wanted_ == 0 || width_ < wanted_)) {
      widen();
      i = index(range, inverse_);
      j = index(mean, inverse_);
      at = &slot(i, j);
    }
    if (*at == 0) {
      if (2 * cells_.size() >= slots_.size()) {
        lay_out(4 * slots_.size());
        at = &slot(i, j);
      }
      cells_.push_back({i, j, count, range, mean, 0, 0});
      *at = cells_.size();
      return;
    }
  }
  Cell& cell = cells_[*at - 1];
  cell.count += count;
  cell.more_range += count * (range - cell.first_range);
  cell.more_mean += count * (mean - cell.first_mean);
}

std::size_t& CycleClasses::slot(std::int32_t range, std::int32_t mean) {
  const std::size_t mask = slots_.size() - 1;
  const auto key = static_cast<std::uint64_t>(static_cast<std::uint32_t>(range)) << 32 |
                   static_cast<std::uint32_t>(mean);
  std::size_t at = (key * 0x9e3779b97f4a7c15ULL) >> 20 & mask;
  while (slots_[at] != 0) {
    const Cell& cell = cells_[slots_[at] - 1];
    if (cell.range == range && cell.mean == mean) break;
    at = (at + 1) & mask;
  }
  return slots_[at];
}

// `slots` at least, rounded up to a power of two.
void CycleClasses::lay_out(std::size_t slots) {
  std::size_t size = first_slots;
  while (size < slots) size *= 2;
  slots_.assign(size, 0);
  for (std::size_t i = 0; i < cells_.size(); ++i) slot(cells_[i].range, cells_[i].mean) = i + 1;
}

void CycleClasses::widen() {
  std::vector<Cell> before;
  before.swap(cells_);
  slots_.assign(slots_.size(), 0);
  width_ *= 2;
  inverse_ = 1 / width_;
  for (Cell& each : before) {
    each.range = half(each.range);
    each.mean = half(each.mean);
    std::size_t& at = slot(each.range, each.mean);
    if (at == 0) {
      cells_.push_back(each);
      at = cells_.size();
      continue;
    }
    Cell& cell = cells_[at - 1];
    cell.more_range += each.more_range + each.count * (each.first_range - cell.first_range);
    cell.more_mean += each.more_mean + each.count * (each.first_mean - cell.first_mean);
    cell.count += each.count;
  }
}

std::vector<CycleClass> CycleClasses::classes() const {
  std::vector<CycleClass> classes;
  for (const Cell& cell : cells_) {
    classes.push_back({cell.count, cell.first_range + cell.more_range / cell.count,
                       cell.first_mean + cell.more_mean / cell.count});
  }
  std::sort(classes.begin(), classes.end(), [](const CycleClass& a, const CycleClass& b) {
    return a.range != b.range ? a.range < b.range : a.mean < b.mean;
  });
  return classes;
}

double CycleClasses::shown_width(std::size_t most) const {
  if (wanted_ > 0) return wanted_;
  std::int32_t last = 0;
  for (const Cell& cell : cells_) last = std::max(last, cell.range);
  double width = width_;
  while (static_cast<std::size_t>(last) >= most) {
    last = half(last);
    width *= 2;
  }
  return width;
}

}  // namespace wearwell::fatigue
