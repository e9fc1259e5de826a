#include "wearwell/embed/follow.h"
#include "core.h"
#include "hexadecimal.h"
#include "look.h"
#include "wearwell/embed/export.h"
#include "wearwell/embed/update.h"

namespace wearwell::r {
namespace {

using embed::Fitted;
using Unit = std::shared_ptr<embed::FollowedUnit>;
using Population = std::shared_ptr<const embed::Population>;

// `run` may be NULL: then the folder of a result.
Fitted fitted(SEXP run, const std::string& path) {
  return {Rf_isNull(run) ? nullptr : &held<embed::Run>(run), path};
}

// `rows`: tables, or paths of files.
SEXP update(SEXP run, const std::string& path, const Rcpp::List& rows, const std::string& repeated,
            int threads, bool report, SEXP progress) {
  std::vector<prognosis::NewRows> all;
  for (R_xlen_t i = 0; i < rows.size(); ++i) {
    SEXP each = rows[i];
    if (TYPEOF(each) == EXTPTRSXP) {
      all.emplace_back(held<Table>(each));
    } else {
      all.emplace_back(std::filesystem::path(Rcpp::as<std::string>(each)));
    }
  }
  embed::Run updated;
  attended(progress, [&](Monitor monitor) {
    monitor.threads = threads;
    updated = embed::update(fitted(run, path), all, repeated, report, std::move(monitor));
  });
  return hold(std::move(updated));
}

SEXP state_of(SEXP run) {
  return text_of(in_digits(embed::saved_state(held<embed::Run>(run))));
}

SEXP study_of_state(const std::string& state) {
  return hold(embed::study_of_state(of_digits(state)));
}

SEXP study_with_text(SEXP study, const std::string& text) {
  return hold(embed::with_text(held<embed::ReadStudy>(study), text));
}

SEXP population_of(SEXP run, const std::string& path) {
  const embed::Fitted of = fitted(run, path);
  return hold(interruptible([&] { return Population(embed::population_of(of)); }));
}

SEXP is_trusted(SEXP population) {
  return Rf_ScalarLogical(held<Population>(population)->trusted);
}

SEXP followed_unit(SEXP population, const std::string& unit, bool fresh) {
  const auto& all = held<Population>(population);
  return hold(
      interruptible([&] { return Unit(std::make_shared<embed::FollowedUnit>(all, unit, fresh)); }));
}

SEXP take_readings(SEXP unit, SEXP rows) {
  const Unit& followed = held<Unit>(unit);
  const Table& readings = held<Table>(rows);
  return list_of(
      nlohmann::ordered_json::parse(interruptible([&] { return followed->update(readings); })));
}

SEXP forecast(SEXP unit) {
  return list_of(nlohmann::ordered_json::parse(held<Unit>(unit)->json()));
}

SEXP risk(SEXP unit, const std::string& within) {
  return Rf_ScalarReal(held<Unit>(unit)->risk(within));
}

SEXP forecast_path(SEXP unit) {
  std::vector<double> at, low, middle, high;
  for (const prognosis::ForecastBand& each : held<Unit>(unit)->path()) {
    at.push_back(each.at);
    low.push_back(each.level05);
    middle.push_back(each.level50);
    high.push_back(each.level95);
  }
  return named_list({{"at", Rcpp::Shield<SEXP>(Rcpp::wrap(at))},
                     {"q05", Rcpp::Shield<SEXP>(Rcpp::wrap(low))},
                     {"q50", Rcpp::Shield<SEXP>(Rcpp::wrap(middle))},
                     {"q95", Rcpp::Shield<SEXP>(Rcpp::wrap(high))}});
}

SEXP backtest(SEXP population, SEXP readings, SEXP lives) {
  embed::Backtested test;
  attended(R_NilValue, [&](const Monitor&) {
    test =
        embed::backtest(*held<Population>(population), held<Table>(readings), held<Table>(lives));
  });
  const auto summary = nlohmann::ordered_json::parse(test.json);
  return named_list({{"summary", Rcpp::Shield<SEXP>(list_of(summary))},
                     {"text", Rcpp::Shield<SEXP>(text_of(test.text))},
                     {"forecasts", Rcpp::Shield<SEXP>(text_of(test.forecasts))}});
}

// `target`: the folder.
SEXP export_c(SEXP run, const std::string& path, const std::string& arguments,
              const std::string& target) {
  const embed::CCode code = embed::export_c(fitted(run, path), arguments);
  embed::write_folder(target, code.files);
  return named_list({{"text", Rcpp::Shield<SEXP>(text_of(code.text))},
                     {"trusted", Rcpp::Shield<SEXP>(Rf_ScalarLogical(code.trusted))}});
}

SEXP export_sql(SEXP run, const std::string& path, const std::string& arguments) {
  const embed::SqlCode code = embed::export_sql(fitted(run, path), arguments);
  return named_list({{"text", Rcpp::Shield<SEXP>(text_of(code.text))},
                     {"trusted", Rcpp::Shield<SEXP>(Rf_ScalarLogical(code.trusted))}});
}

}  // namespace

void add_followed(Doors& doors) {
  doors.insert(
      doors.end(),
      {door<&update>("update"), door<&state_of>("state"), door<&study_of_state>("study_of_state"),
       door<&study_with_text>("study_with_text"), door<&population_of>("population_of"),
       door<&is_trusted>("is_trusted"), door<&followed_unit>("followed_unit"),
       door<&take_readings>("take_readings"), door<&forecast>("forecast"), door<&risk>("risk"),
       door<&forecast_path>("forecast_path"), door<&backtest>("backtest"),
       door<&export_c>("export_c"), door<&export_sql>("export_sql")});
}

}  // namespace wearwell::r
