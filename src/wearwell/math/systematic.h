#pragma once

namespace wearwell {

/// Systematic sampling of items in an order in which neighbours are similar: one item for every
/// `share` of cumulative weight, so that the frequency is proportional to the weight. Each sampled
/// item has weight `share`.
class Systematic {
 public:
  explicit Systematic(double share) : share_(share), passed_(0.5 * share) {}

  bool takes(double weight) {
    passed_ += weight;
    if (passed_ < share_) return false;
    passed_ -= share_;
    return true;
  }

 private:
  double share_, passed_;
};

}  // namespace wearwell
