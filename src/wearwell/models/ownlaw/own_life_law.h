#pragma once

#include <memory>
#include <string>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/models/ownlaw/own_path.h"

namespace wearwell::ownlaw {

/// "1/h" of "h", "1/(1e6 cycles)" of "1e6 cycles".
std::string per_unit(const Unit& unit);

/// A life as a family of a likelihood gives it, under conditions: what follows from it over a posterior.
class LifeLaw {
 public:
  /// `slots` has the outputs of the measured column.
  LifeLaw(std::shared_ptr<const Path> slots, const Measured& measured);

  /// The next one: all that is unknown averaged in.
  class Next {
   public:
    double cdf(double life) const;
    double quantile(double p) const;
    /// What remains to one that has come to `from`: the share p of such.
    double quantile(double p, double from) const;

   private:
    friend class LifeLaw;
    struct Component {
      double weight, slot[most_response_slots];
    };
    ResponseFamily family_;
    bool positive_ = true;
    std::vector<Component> components_;
    double middle_ = 1;
  };
  Next next(const WeightedDraws& draws) const;

  /// The life by which a share p of all has failed, over a posterior.
  Distribution quantile(const WeightedDraws& draws, double p) const;
  /// The same of those that have come to `from`, from there on, given that one has.
  Distribution quantile(const WeightedDraws& draws, double p, double from) const;
  /// The share of all that outlasts a life.
  Distribution survival(const WeightedDraws& draws, double life) const;
  /// The rate at which those fail that have come so far, per SI unit of life.
  Distribution hazard(const WeightedDraws& draws, double life) const;
  /// The median life over that of `other`.
  Distribution ratio(const WeightedDraws& draws, const LifeLaw& other) const;

 private:
  class AtPoint;
  WeightedDraws points(const WeightedDraws& draws) const;
  template <class Value>
  Distribution over(const WeightedDraws& draws, const Value& value) const;

  std::shared_ptr<const Path> slots_;
  ResponseFamily family_;
  bool positive_;
  std::vector<std::size_t> slot_;
};

}  // namespace wearwell::ownlaw
