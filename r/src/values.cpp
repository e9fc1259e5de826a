#include "core.h"

namespace wearwell::r {
namespace {

using Json = nlohmann::ordered_json;

// No text of R holds a zero.
SEXP char_of(const std::string& text) {
  if (const std::size_t zero = text.find('\0'); zero != std::string::npos)
    return char_of(text.substr(0, zero) + "\\0" + text.substr(zero + 1));
  return Rf_mkCharLenCE(text.data(), static_cast<int>(text.size()), CE_UTF8);
}

template <class Kind>
bool all_are(const Json& array, const Kind& kind) {
  bool any = false;
  for (const Json& each : array) {
    if (each.is_null()) continue;
    if (!kind(each)) return false;
    any = true;
  }
  return any;
}

SEXP vector_of(const Json& array) {
  const auto n = static_cast<R_xlen_t>(array.size());
  const auto is_null = [&](R_xlen_t i) { return array[static_cast<std::size_t>(i)].is_null(); };
  if (all_are(array, [](const Json& each) { return each.is_number(); })) {
    Rcpp::NumericVector all(n);
    for (R_xlen_t i = 0; i < n; ++i)
      all[i] = is_null(i) ? NA_REAL : array[static_cast<std::size_t>(i)].get<double>();
    return all;
  }
  if (all_are(array, [](const Json& each) { return each.is_string(); })) {
    Rcpp::CharacterVector all(n);
    for (R_xlen_t i = 0; i < n; ++i) {
      all[i] =
          is_null(i) ? NA_STRING : char_of(array[static_cast<std::size_t>(i)].get<std::string>());
    }
    return all;
  }
  if (all_are(array, [](const Json& each) { return each.is_boolean(); })) {
    Rcpp::LogicalVector all(n);
    for (R_xlen_t i = 0; i < n; ++i)
      all[i] = is_null(i) ? NA_LOGICAL : array[static_cast<std::size_t>(i)].get<bool>();
    return all;
  }
  Rcpp::List all(n);
  for (R_xlen_t i = 0; i < n; ++i) all[i] = list_of(array[static_cast<std::size_t>(i)]);
  return all;
}

}  // namespace

SEXP text_of(const std::string& text) {
  const Rcpp::Shield<SEXP> one(char_of(text));
  return Rf_ScalarString(one);
}

SEXP texts_of(const std::vector<std::string>& texts) {
  Rcpp::CharacterVector all(static_cast<R_xlen_t>(texts.size()));
  for (std::size_t i = 0; i < texts.size(); ++i) all[static_cast<R_xlen_t>(i)] = char_of(texts[i]);
  return all;
}

SEXP list_of(const Json& json) {
  if (json.is_object()) {
    const auto n = static_cast<R_xlen_t>(json.size());
    Rcpp::List all(n);
    Rcpp::CharacterVector names(n);
    R_xlen_t i = 0;
    for (const auto& [key, value] : json.items()) {
      all[i] = list_of(value);
      names[i++] = char_of(key);
    }
    all.names() = names;
    return all;
  }
  if (json.is_array()) return vector_of(json);
  if (json.is_string()) return text_of(json.get<std::string>());
  if (json.is_boolean()) return Rf_ScalarLogical(json.get<bool>());
  return Rf_ScalarReal(json.is_null() ? NA_REAL : json.get<double>());
}

SEXP named_list(const std::vector<std::pair<std::string, SEXP>>& entries) {
  Rcpp::List all(static_cast<R_xlen_t>(entries.size()));
  Rcpp::CharacterVector names(all.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    all[static_cast<R_xlen_t>(i)] = entries[i].second;
    names[static_cast<R_xlen_t>(i)] = char_of(entries[i].first);
  }
  all.names() = names;
  return all;
}

SEXP failure(const char* kind, const char* message) {
  Rcpp::RObject words(texts_of({kind, shown(message)}));
  words.attr("class") = "wearwell_failure";
  return words;
}

}  // namespace wearwell::r
