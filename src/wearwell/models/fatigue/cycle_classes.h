#pragma once

#include <cstdint>
#include <vector>

namespace wearwell::fatigue {

/// Cycles alike: of one class of range and mean.
struct CycleClass {
  double count = 0;
  double range = 0, mean = 0;  ///< of those in it, in the mean
};

/// Counted cycles in classes of range and mean of one width, which doubles when there are too many
/// classes: few cycles keep their own values, any number takes the same memory. A width is the one
/// before twice, so that classes are whole parts of wider ones; each keeps the means of what is in
/// it. In the unit of the signal.
class CycleClasses {
 public:
  static constexpr std::size_t most_classes = 1 << 16;

  /// What is in a class, relative to the first cycle there: that of equal cycles is exact.
  struct Cell {
    std::int32_t range = 0, mean = 0;  ///< from so many widths, to one more
    double count = 0, first_range = 0, first_mean = 0, more_range = 0, more_mean = 0;
  };

  /// `width`: classes are wholes of it, or parts by powers of two; 0 for a power of two.
  explicit CycleClasses(double width = 0) : wanted_(width) {}
  CycleClasses(double wanted, double width, std::vector<Cell> cells);

  void add(double range, double mean, double count);

  double wanted() const { return wanted_; }
  double width() const { return width_; }                    ///< 0 before the first cycle
  const std::vector<Cell>& cells() const { return cells_; }  ///< in the order of their first cycle
  std::vector<CycleClass> classes() const;                   ///< by range, then mean

  /// The least width of classes that is a whole of this one and makes at most so many of range; of
  /// the width that is wanted that one.
  double shown_width(std::size_t most) const;

 private:
  bool within(double range, double mean) const;
  std::size_t& slot(std::int32_t range, std::int32_t mean);
  void begin(double range);
  void widen();
  void lay_out(std::size_t slots);

  double wanted_ = 0, width_ = 0, inverse_ = 0;
  std::vector<Cell> cells_;
  std::vector<std::size_t> slots_;  // of a hash: 1 + place among cells
};

}  // namespace wearwell::fatigue
