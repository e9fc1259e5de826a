#pragma once

#include <string>
#include <vector>

#include "wearwell/input/source.h"
#include "wearwell/study/comparison.h"
#include "wearwell/study/model.h"

namespace wearwell {

/// One study of lives fitted with several families (study/family_study.h).
struct FamilyRanking {
  Comparison comparison;
  std::vector<std::string> close;  ///< families that the data do not separate from the best
};

/// `families`: names separated by commas, or "all". Fits each by quadrature up to four parameters, else by NUTS. Throws
/// InputError.
FamilyRanking rank_families(const Source& study, const std::string& families, Models models);

/// B-lives by family, and whether the choice of the family matters, for a terminal.
std::string ranking_text(const FamilyRanking& ranking);

/// studies[].b_lives[].{name, of, at, unit, q05, q50, q95} and `close`, added to the JSON of the comparison.
nlohmann::ordered_json ranking_json(const FamilyRanking& ranking);

}  // namespace wearwell
