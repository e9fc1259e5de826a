#include <charconv>

#include "core.h"
#include "look.h"
#include "wearwell/embed/question.h"

namespace wearwell::r {
namespace {

// The answer to a question. `arguments` is a JSON object; `run`, `other` and `study` may be NULL.
SEXP answered(const std::string& kind, const std::string& arguments, SEXP run, SEXP other,
              SEXP study, const std::string& path, const Rcpp::List& tables, int threads,
              SEXP progress) {
  embed::Subject subject;
  if (!Rf_isNull(run)) subject.run = &held<embed::Run>(run);
  if (!Rf_isNull(other)) subject.other = &held<embed::Run>(other);
  if (!Rf_isNull(study)) subject.study = &held<embed::ReadStudy>(study);
  subject.path = path;
  if (tables.size() > 0) {
    const Rcpp::CharacterVector names = tables.names();
    for (R_xlen_t i = 0; i < tables.size(); ++i)
      subject.tables.emplace_back(Rcpp::as<std::string>(names[i]), held<Table>(tables[i]));
  }
  embed::Answer answer;
  attended(progress, [&](Monitor monitor) {
    monitor.threads = threads;
    answer = embed::answer(kind, arguments, subject, std::move(monitor));
  });
  std::vector<std::string> names, contents;
  for (auto& [name, content] : answer.tables) {
    names.push_back(name);
    contents.push_back(std::move(content));
  }
  Rcpp::CharacterVector csv(texts_of(contents));
  csv.names() = Rcpp::CharacterVector(texts_of(names));
  const auto summary = nlohmann::ordered_json::parse(answer.json);
  return named_list({{"title", Rcpp::Shield<SEXP>(text_of(answer.title))},
                     {"text", Rcpp::Shield<SEXP>(text_of(answer.text))},
                     {"json", Rcpp::Shield<SEXP>(text_of(answer.json))},
                     {"summary", Rcpp::Shield<SEXP>(list_of(summary))},
                     {"tables", Rcpp::Shield<SEXP>(csv)},
                     {"page", Rcpp::Shield<SEXP>(text_of(answer.page))},
                     {"trusted", Rcpp::Shield<SEXP>(Rf_ScalarLogical(answer.trusted))}});
}

// A column of a CSV file: numbers, if each cell that is not empty is one.
SEXP column_of(const Rcpp::CharacterVector& texts) {
  Rcpp::NumericVector numbers(texts.size(), NA_REAL);
  for (R_xlen_t i = 0; i < texts.size(); ++i) {
    const std::string text = Rcpp::as<std::string>(texts[i]);
    if (text.empty()) continue;
    const char* const end = text.data() + text.size();
    double value = 0;
    const auto [at, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || at != end) return texts;
    numbers[i] = value;
  }
  return numbers;
}

}  // namespace

void add_plans(Doors& doors) {
  doors.insert(doors.end(), {door<&answered>("answer"), door<&column_of>("column_of")});
}

}  // namespace wearwell::r
