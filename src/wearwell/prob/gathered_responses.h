#pragma once

#include <span>
#include <vector>

#include "wearwell/prob/response.h"

namespace wearwell {

/// A response with the weight of its log density in a sum; the weight need not be an integer and may be negative.
struct WeightedResponse {
  Response response;
  double weight = 1;
};

/// A few weighted responses in place of many under one distribution: the weighted sum of their log densities equals that of
/// all to rounding, unless the distribution is narrower than a tenth of the spread of the responses.
///
/// Values of one kind (exact, above, below), as logarithms where they are positive, are cut into cells of an eighth of the
/// spread, and six nodes stand for a cell (`gauss_of_points`): a log density is nearly a polynomial of degree 11 there.
/// An entry is taken apart, log p(y | y > entry) = log p(y) - log P(Y > entry), and equal intervals are one. `counts` says
/// how many each stands for.
std::vector<WeightedResponse> gathered_responses(std::span<const Response> responses,
                                                 std::span<const double> counts, bool positive);

/// Whether log densities of the family are smooth in a value: not about a threshold, nor of counts.
bool can_be_gathered(const ResponseForm& form);

}  // namespace wearwell
