#include <toml++/toml.h>
#include <sstream>

#include "core.h"
#include "hexadecimal.h"
#include "look.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/embed/residuals.h"
#include "wearwell/study/inference_data.h"
#include "wearwell/study/json.h"
#include "wearwell/study/result_writer.h"

namespace wearwell::r {
namespace {

using embed::ReadStudy;
using embed::Run;

SEXP read_file(const std::string& file) {
  return hold(interruptible([&] { return embed::read(source_of(file)); }));
}

SEXP read_text(const std::string& text, const std::string& path, const Rcpp::List& tables) {
  std::map<std::string, Table> all;
  if (tables.size() > 0) {
    const Rcpp::CharacterVector names = tables.names();
    for (R_xlen_t i = 0; i < tables.size(); ++i)
      all.emplace(Rcpp::as<std::string>(names[i]), held<Table>(tables[i]));
  }
  return hold(interruptible([&] { return embed::read_text(text, path, std::move(all)); }));
}

SEXP study_text(SEXP study) {
  return text_of(held<ReadStudy>(study).text);
}
SEXP description(SEXP study) {
  return text_of(held<ReadStudy>(study).study->description());
}

// The tables and keys of a study, as lists.
SEXP keys(const std::string& text) {
  try {
    const toml::table table = toml::parse(text);
    std::ostringstream json;
    json << toml::json_formatter(table);
    return list_of(nlohmann::ordered_json::parse(json.str()));
  } catch (const toml::parse_error& error) {
    throw InputError(std::string(error.description()));
  }
}

// Texts and numbers as a study file has them: every number is read back to the bit.
SEXP written(SEXP values) {
  std::vector<std::string> all;
  if (TYPEOF(values) == REALSXP) {
    for (const double each : Rcpp::as<std::vector<double>>(values))
      all.push_back(nlohmann::json(each).dump());
  } else {
    for (const std::string& each : Rcpp::as<std::vector<std::string>>(values))
      all.push_back(nlohmann::json(each).dump());
  }
  return texts_of(all);
}

template <class T>
std::optional<T> if_given(SEXP value) {
  if (Rf_isNull(value)) return {};
  return Rcpp::as<T>(value);
}

// `seed` is a text: R's numbers end at 2^53.
SEXP run(SEXP study, const std::string& method, SEXP chains, SEXP warmup, SEXP draws,
         const std::string& seed, int threads, bool report, SEXP progress) {
  RunOptions options{{{}, if_given<int>(chains), if_given<int>(warmup), if_given<int>(draws), {}},
                     report};
  if (!seed.empty()) options.sampler.seed = std::stoull(seed);
  if (!method.empty()) {
    options.sampler.method = method == "exact"  ? Method::exact
                             : method == "nuts" ? Method::nuts
                                                : Method::metropolis;
  }
  const ReadStudy& read = held<ReadStudy>(study);
  Run found;
  attended(progress, [&](Monitor monitor) {
    monitor.threads = threads;
    found = embed::run(read, options, std::move(monitor));
  });
  return hold(std::move(found));
}

SEXP summary(SEXP run) {
  return list_of(summary_json(*held<Run>(run).result));
}
SEXP terminal(SEXP run) {
  return text_of(terminal_text(*held<Run>(run).result, {}));
}

// Iterations x chains x parameters, as R lays arrays out: the first runs fastest.
SEXP draws_of(SEXP run) {
  const auto& posterior = held<Run>(run).result->posterior;
  if (!posterior || posterior->posterior_draws.empty()) return R_NilValue;
  const Draws& draws = posterior->posterior_draws;
  const auto n = draws.front().values.rows(), columns = draws.front().values.cols();
  Rcpp::NumericVector all(static_cast<R_xlen_t>(draws.size()) * n * columns);
  double* to = all.begin();
  for (Eigen::Index c = 0; c < columns; ++c) {
    for (const Chain& chain : draws)
      for (Eigen::Index d = 0; d < n; ++d) *to++ = chain.values(d, c);
  }
  all.attr("dim") = Rcpp::IntegerVector::create(static_cast<int>(n), static_cast<int>(draws.size()),
                                                static_cast<int>(columns));
  return all;
}

SEXP sample_stats(SEXP run) {
  Rcpp::List stats;
  for (const auto& [name, values] : embed::sample_stats(held<Run>(run)))
    stats.push_back(Rcpp::NumericVector(values.begin(), values.end()), name);
  return stats;
}

// Files that end in .bin go over in hexadecimal digits.
bool is_bytes(const std::string& name) {
  return name.ends_with(".bin");
}

SEXP files_of(SEXP run) {
  std::vector<std::string> names, contents;
  const Run& fitted = held<Run>(run);
  embed::Files files = interruptible([&] { return embed::files_of(fitted); });
  for (auto& [name, content] : files) {
    contents.push_back(is_bytes(name) ? in_digits(content) : std::move(content));
    names.push_back(name);
  }
  Rcpp::CharacterVector all(texts_of(contents));
  all.names() = Rcpp::CharacterVector(texts_of(names));
  return all;
}

embed::Files pairs_of(const Rcpp::CharacterVector& named) {
  embed::Files pairs;
  if (named.size() == 0) return pairs;
  const Rcpp::CharacterVector names = named.names();
  for (R_xlen_t i = 0; i < named.size(); ++i)
    pairs.emplace_back(Rcpp::as<std::string>(names[i]), Rcpp::as<std::string>(named[i]));
  return pairs;
}

SEXP page_of(const std::string& summary, const std::string& report) {
  return text_of(embed::page_of(summary, report));
}

SEXP write_folder(const std::string& target, const Rcpp::CharacterVector& files) {
  embed::Files pairs = pairs_of(files);
  for (auto& [name, content] : pairs) {
    if (is_bytes(name)) content = of_digits(content);
  }
  embed::write_folder(target, pairs);
  return R_NilValue;
}

SEXP write_page(const std::string& target, const std::string& page) {
  write_file(target, page);
  return R_NilValue;
}

SEXP write_netcdf(SEXP run, const std::string& target) {
  embed::write_netcdf(held<Run>(run), target);
  return R_NilValue;
}

SEXP asked(SEXP run, SEXP other, double level) {
  const Run& fitted = held<Run>(run);
  const ReadStudy& study = held<ReadStudy>(other);
  return list_of(interruptible([&] { return embed::asked(fitted, study, level); }));
}

SEXP residuals_of(SEXP run) {
  const Run& fitted = held<Run>(run);
  const embed::Residuals found = interruptible([&] { return embed::residuals(fitted); });
  return Rcpp::List::create(
      Rcpp::Named("score") = Rcpp::NumericVector(found.score.begin(), found.score.end()),
      Rcpp::Named("censored") = Rcpp::IntegerVector(found.censored.begin(), found.censored.end()),
      Rcpp::Named("noun") = found.noun);
}

// A text in JSON, as lists.
SEXP from_json(const std::string& text) {
  return list_of(nlohmann::ordered_json::parse(text));
}

SEXP lists_of(const embed::Compared& found) {
  return named_list({{"summary", Rcpp::Shield<SEXP>(list_of(found.json))},
                     {"text", Rcpp::Shield<SEXP>(text_of(found.text))},
                     {"page", Rcpp::Shield<SEXP>(text_of(found.page))}});
}

SEXP compared(const Rcpp::CharacterVector& folders) {
  const embed::Files pairs = pairs_of(folders);
  return lists_of(interruptible([&] { return embed::compared(pairs); }));
}

SEXP compared_families(SEXP study, const std::string& families, int threads, SEXP progress) {
  const ReadStudy& read = held<ReadStudy>(study);
  embed::Compared found;
  attended(progress, [&](Monitor monitor) {
    monitor.threads = threads;
    found = embed::compared_families(read, families, std::move(monitor));
  });
  return lists_of(found);
}

// An object that R kept beyond its session is an address of nothing.
SEXP is_there(SEXP object) {
  return Rf_ScalarLogical(TYPEOF(object) == EXTPTRSXP && R_ExternalPtrAddr(object) != nullptr);
}

}  // namespace

void add_studies(Doors& doors) {
  doors.insert(doors.end(), {door<&read_file>("read_file"),
                             door<&read_text>("read_text"),
                             door<&study_text>("study_text"),
                             door<&description>("description"),
                             door<&keys>("keys"),
                             door<&written>("written"),
                             door<&run>("run"),
                             door<&summary>("summary"),
                             door<&terminal>("terminal"),
                             door<&draws_of>("draws"),
                             door<&sample_stats>("sample_stats"),
                             door<&files_of>("files"),
                             door<&page_of>("page_of"),
                             door<&write_folder>("write_folder"),
                             door<&write_page>("write_page"),
                             door<&write_netcdf>("write_netcdf"),
                             door<&asked>("asked"),
                             door<&compared>("compared"),
                             door<&compared_families>("compared_families"),
                             door<&is_there>("is_there"),
                             door<&residuals_of>("residuals"),
                             door<&from_json>("from_json")});
}

}  // namespace wearwell::r
