#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "wearwell/base/monitor.h"
#include "wearwell/input/source.h"
#include "wearwell/study/comparison.h"
#include "wearwell/study/model.h"

namespace wearwell {

/// One study of lives fitted with several families (study/family_study.h).
struct FamilyRanking {
  Comparison comparison;
  std::vector<std::string> close;  ///< families that the data do not separate from the best
};

/// `families`: two or more names separated by commas, or "all". Fits each by quadrature up to four parameters, else by
/// NUTS, with the sampler and the seed of the study. Throws InputError; `Cancelled` once the monitor requests a stop.
FamilyRanking rank_families(const Source& study, const std::string& families, Models models,
                            const Monitor& monitor);

/// The comparison, B-lives by family, and whether the choice of the family matters, for a terminal.
std::string ranking_text(const FamilyRanking& ranking);

/// The JSON of the comparison with studies[].b_lives[].{name, of, at, unit, q05, q50, q95} and `close`.
nlohmann::ordered_json ranking_json(const FamilyRanking& ranking);

}  // namespace wearwell
