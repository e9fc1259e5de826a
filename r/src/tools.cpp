#include "wearwell/embed/tools.h"

#include "core.h"
#include "look.h"
#include "wearwell/models/bearing/answer.h"

namespace wearwell::r {
namespace {

SEXP kept(const Rcpp::List& list, const char* name) {
  return list[name];
}

template <class T>
T option(const Rcpp::List& list, const char* name) {
  return Rcpp::as<T>(kept(list, name));
}

// `data`: a table, or the path of a file.
SEXP select(SEXP data, const Rcpp::List& asked, const Rcpp::List& how, SEXP progress) {
  using Texts = std::vector<std::string>;
  SelectData columns{{},
                     {},
                     option<std::string>(asked, "response"),
                     option<Texts>(asked, "inputs"),
                     {},
                     option<Texts>(asked, "terms"),
                     option<std::string>(asked, "weights"),
                     option<Texts>(asked, "force")};
  if (!Rf_isNull(kept(asked, "degree"))) columns.degree = option<int>(asked, "degree");
  const embed::SelectOptions options{option<std::string>(how, "criterion"),
                                     option<int>(how, "keep"),
                                     option<double>(how, "near"),
                                     option<int>(how, "folds"),
                                     option<int>(how, "nested"),
                                     std::stoull(option<std::string>(how, "seed")),
                                     option<double>(how, "time"),
                                     option<bool>(how, "report")};
  const int threads = option<int>(how, "threads");
  const Table* table = nullptr;
  if (TYPEOF(data) == EXTPTRSXP) {
    table = &held<Table>(data);
  } else {
    columns.file = Rcpp::as<std::string>(data);
  }
  embed::Selected found;
  attended(progress, [&](Monitor monitor) {
    monitor.threads = threads;
    found = embed::select(columns, table, options, monitor);
  });
  const auto summary = nlohmann::ordered_json::parse(found.summary);
  return named_list({{"summary", Rcpp::Shield<SEXP>(list_of(summary))},
                     {"text", Rcpp::Shield<SEXP>(text_of(found.text))},
                     {"models", Rcpp::Shield<SEXP>(text_of(found.models))},
                     {"page", Rcpp::Shield<SEXP>(text_of(found.page))}});
}

SEXP rainflow(const std::vector<double>& signal, bool three_points, bool repeat) {
  embed::Cycles cycles;
  attended(R_NilValue, [&](const Monitor& monitor) {
    cycles = embed::rainflow(signal, three_points, repeat, monitor);
  });
  return named_list({{"from", Rcpp::Shield<SEXP>(Rcpp::wrap(cycles.from))},
                     {"to", Rcpp::Shield<SEXP>(Rcpp::wrap(cycles.to))},
                     {"count", Rcpp::Shield<SEXP>(Rcpp::wrap(cycles.count))}});
}

SEXP bearing_answer(const std::string& command, const std::string& contact,
                    const Rcpp::CharacterVector& inputs, const std::string& unit,
                    const std::string& limit, int draws, const std::string& seed) {
  std::map<std::string, std::string> texts;
  if (inputs.size() > 0) {
    const Rcpp::CharacterVector names = inputs.names();
    for (R_xlen_t i = 0; i < inputs.size(); ++i)
      texts[Rcpp::as<std::string>(names[i])] = Rcpp::as<std::string>(inputs[i]);
  }
  const bearing::Answer answer =
      bearing::answer(command, contact, texts,
                      {.unit = unit, .limit = limit, .draws = draws, .seed = std::stoull(seed)});
  return named_list({{"answer", Rcpp::Shield<SEXP>(list_of(bearing::to_json(answer)))},
                     {"warnings", Rcpp::Shield<SEXP>(texts_of(bearing::warnings(answer)))},
                     {"margin", Rcpp::Shield<SEXP>(text_of(answer.margin))}});
}

using Held = std::shared_ptr<embed::PlateCycles>;

SEXP plate_cycles(const std::string& model, bool scatter_only, bool skip) {
  return hold(Held(std::make_shared<embed::PlateCycles>(model, scatter_only, skip)));
}
SEXP add_cycles(SEXP cycles, SEXP table) {
  return Rcpp::wrap(static_cast<double>(held<Held>(cycles)->add(held<Table>(table))));
}
SEXP add_cycles_of_file(SEXP cycles, const std::string& file) {
  return Rcpp::wrap(static_cast<double>(held<Held>(cycles)->add_file(file)));
}
SEXP worn(SEXP cycles) {
  return list_of(held<Held>(cycles)->json());
}

}  // namespace

void add_tools(Doors& doors) {
  doors.insert(doors.end(), {door<&select>("select"), door<&rainflow>("rainflow"),
                             door<&bearing_answer>("bearing"), door<&plate_cycles>("plate_cycles"),
                             door<&add_cycles>("add_cycles"),
                             door<&add_cycles_of_file>("add_cycles_of_file"), door<&worn>("worn")});
}

}  // namespace wearwell::r
