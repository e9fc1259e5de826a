#include "wearwell/selection/selection_header.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "wearwell/input/fingerprint.h"

namespace wearwell {
namespace {

std::string equation_of(const SelectionResult& result) {
  if (result.selection.search.models.empty())
    return result.response + " is explained by no model found";
  std::string equation;
  for (const CoefficientRow& each : coefficient_rows(result)) {
    const bool constant = !each.selected || each.term == "1";
    const bool negative = each.original < 0;
    equation += equation.empty() ? (negative ? "-" : "") : (negative ? " - " : " + ");
    equation += fmt::format("{:.6g}{}{}", std::abs(each.original), constant ? "" : " ",
                            constant ? "" : each.term);
  }
  return result.response + " = " + equation;
}

Check search_check(const SearchResult& search) {
  if (search.certified)
    return {"search", Verdict::pass, "no other model of these terms is better", ""};
  return {"search", Verdict::fail, "stopped before the best model was proven",
          "Give it more time, or fewer terms."};
}

Check nested_check(const Nested& nested) {
  constexpr const char* name = "nested search";
  if (nested.folds == 0) return {name, Verdict::pass, "not requested", ""};
  if (!nested.problem.empty())
    return {name, Verdict::warn, nested.problem, "The prediction error for new rows is unknown."};
  const std::string detail = fmt::format(
      "R2 of rows left out of the whole search: {:.3f} +- {:.3f}", nested.r2, nested.r2_error);
  if (nested.r2 > 0) return {name, Verdict::pass, detail, ""};
  return {name, Verdict::warn, detail + ", no better than the mean",
          "These terms do not predict new rows."};
}

}  // namespace

Header selection_header(const SelectionResult& result) {
  Header header;
  header.version = result.version;
  header.title = "Terms of " + result.response;
  header.model = "selection";
  header.equation = equation_of(result);
  header.data.files = {std::filesystem::path(result.data_file).filename().string()};
  header.data.rows = static_cast<std::size_t>(result.observed.size());
  header.data.fingerprint = fingerprint(
      result.response, std::vector<double>(result.observed.begin(), result.observed.end()));
  header.data.remarks = result.data_remarks;
  header.seed = result.settings.seed;
  header.checks = {search_check(result.selection.search), nested_check(result.selection.nested)};
  header.trusted = result.selection.search.certified;
  return header;
}

}  // namespace wearwell
