#pragma once

namespace wearwell {

/// Systematic sampling of things that come in an order in which neighbours are alike: one for every `share` of their
/// weight, so that each is taken as often as it has weight. Whoever is taken stands for `share`.
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
