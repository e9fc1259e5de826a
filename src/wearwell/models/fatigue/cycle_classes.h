#pragma once

#include <cstdint>
#include <vector>

namespace wearwell::fatigue {

/// Cycles of one class of range and mean.
struct CycleClass {
  double count = 0;
  double range = 0, mean = 0;  ///< mean over the class
};

/// Counted cycles in classes of range and mean of one width, which doubles if there are too many
/// classes: few cycles keep their own values, and any number takes the same memory. Since the width
/// doubles, classes divide wider ones exactly; each keeps the means of its content. In the unit of
/// the signal.
class CycleClasses {
 public:
  static constexpr std::size_t most_classes = 1 << 16;

  /// The content of a class, relative to its first cycle: exact for equal cycles.
  struct Cell {
    std::int32_t range = 0, mean = 0;  ///< from this multiple of the width to the next
    double count = 0, first_range = 0, first_mean = 0, more_range = 0, more_mean = 0;
  };

  /// `width`: classes are multiples of it, or fractions by powers of two; 0 for a power of two.
  explicit CycleClasses(double width = 0) : wanted_(width) {}
  CycleClasses(double wanted, double width, std::vector<Cell> cells);

  void add(double range, double mean, double count);

  double wanted() const { return wanted_; }
  double width() const { return width_; }                    ///< 0 before the first cycle
  const std::vector<Cell>& cells() const { return cells_; }  ///< in the order of their first cycle
  std::vector<CycleClass> classes() const;                   ///< by range, then mean

  /// The smallest width of classes that is a multiple of this one and gives at most this many
  /// classes of range; a requested width is used itself.
  double shown_width(std::size_t most) const;

 private:
  bool within(double range, double mean) const;
  std::size_t& slot(std::int32_t range, std::int32_t mean);
  void begin(double range);
  void widen();
  void lay_out(std::size_t slots);

  double wanted_ = 0, width_ = 0, inverse_ = 0;
  std::vector<Cell> cells_;
  std::vector<std::size_t> slots_;  // of a hash: 1 + index among cells
};

}  // namespace wearwell::fatigue
