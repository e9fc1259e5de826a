#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/study/saved_result.h"

namespace wearwell {

/// Differences of elpd below it are small (Sivula, Magnusson and Vehtari 2020).
inline constexpr double small_elpd_difference = 4;

/// Studies side by side: which model form predicts best, and how their parameters differ.
struct Comparison {
  struct Entry {
    std::string name;  ///< the user's name for it: the folder
    SavedResult result;
    /// elpd of the best study minus its own, with the standard error of the difference; only if
    /// `comparable`.
    std::optional<ElpdDifference> behind;
    double weight = 0;  ///< model_weights; only if `comparable`
  };
  std::vector<Entry> studies;         ///< best elpd first if comparable and known, else in the
                                      ///< order given
  bool comparable = false;            ///< same data, and the same observations are left out
  std::string obstacle;               ///< the reason if not comparable, as a sentence
  std::vector<std::string> cautions;  ///< warnings, as sentences
  std::string note;                   ///< what the parameters are, if names do not say it
  std::string conclusion;             ///< as sentences; empty if there is none
};

/// Compares results by name. Studies of different data are shown but not ranked.
Comparison compare(std::vector<std::pair<std::string, SavedResult>> results);

/// "B10 life of seal 80 degC", without its unit.
std::string life_label(const QuantitySummary& quantity);

/// The quantity of another result with the same name, part and condition; null if it has none.
const QuantitySummary* same_quantity(const SavedResult& result, const QuantitySummary& wanted);

/// For the terminal, ending with a newline.
std::string comparison_text(const Comparison& comparison);

/// comparable, obstacle, note, cautions, conclusion, studies[].{study, title, model, ...}; keys in
/// docs/how-to/compare.md.
nlohmann::ordered_json to_json(const Comparison& comparison);

/// One page: the tables, and overlaid densities of parameters of the same name.
std::string comparison_page(const Comparison& comparison);

}  // namespace wearwell
