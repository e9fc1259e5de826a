#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/study/saved_result.h"

namespace wearwell {

/// Studies side by side: which model form predicts best, and how their parameters differ.
struct Comparison {
  struct Entry {
    std::string name;  ///< as its user calls it: the folder
    SavedResult result;
    /// elpd of the best less its own, with the standard error of the difference; only where
    /// `comparable`.
    std::optional<ElpdDifference> behind;
    double weight = 0;  ///< model_weights; only where `comparable`
  };
  std::vector<Entry> studies;         ///< best elpd first where comparable and known, else as given
  bool comparable = false;            ///< same data, of which the same observations are left out
  std::string obstacle;               ///< why not, in a sentence
  std::vector<std::string> cautions;  ///< what to bear in mind, in sentences
};

/// Takes results with their names. Studies of different data are shown, never ranked.
Comparison compare(std::vector<std::pair<std::string, SavedResult>> results);

/// For the terminal, ending with a newline.
std::string comparison_text(const Comparison& comparison);

/// comparable, obstacle, cautions, studies[].{study, title, model, ...}; keys in docs/how-to/compare.md.
nlohmann::ordered_json to_json(const Comparison& comparison);

/// One page: the tables, and the densities of parameters of the same name over each other.
std::string comparison_page(const Comparison& comparison);

}  // namespace wearwell
