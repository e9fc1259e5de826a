#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wearwell/models/formula_model/field_returns.h"
#include "wearwell/models/formula_model/returns_forecast.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::formula_model {

/// What a study of returns asks for.
struct AskedReturns {
  std::shared_ptr<const FieldReturns> returns;
  std::vector<Risk> risks;
  std::vector<std::string> modes = {};  ///< failure modes, one for each risk; empty without
  int ahead = 0;  ///< periods of the forecast, from the last fitted one on; 0: none
  std::optional<double> cost = {};
  std::string currency = {};
  std::vector<std::pair<int, int>> planned = {};  ///< period of sale and quantity

  int most_after() const;  ///< the last period after a sale
  /// "month", or "months" for more than one.
  std::string period(int count) const;
};

/// Returns of one period by one failure mode.
struct ReturnsByMode {
  int observed = 0;     ///< with this mode for certain
  ReturnsCount number;  ///< given what was observed before
  ReturnsCount until;   ///< of a forecast: from its beginning on
};

/// Returns of one period of the calendar: fitted, or to come.
struct ReturnsPeriod {
  int at = 0;
  std::optional<int> observed;  ///< empty: to come
  ReturnsCount number;          ///< given what was observed before
  ReturnsCount field, planned;  ///< of a forecast: from the units in use, and from planned sales
  ReturnsCount until;           ///< of a forecast: from its beginning on
  std::vector<ReturnsByMode> by_mode = {};
  int masked = 0;                            ///< observed, of unknown mode or of one of several
  std::map<std::string, int> unfitted = {};  ///< observed, by modes that the fit does not have
};

/// The returns of the units of one period of sale.
struct ReturnsOfSale {
  int at = 0, sold = 0, returned = 0;    ///< until the end of the fit
  ReturnsCount fitted;                   ///< until then, as the fit gives it for units just sold
  ReturnsCount ahead;                    ///< in the forecast
  std::vector<ReturnsCount> cells = {};  ///< by period of the forecast
};

struct ReturnsResult {
  std::vector<ReturnsPeriod> fitted, forecast;
  std::vector<ReturnsOfSale> sales;
};

/// What a result has beside the returns of each period.
struct ReturnsParts {
  bool sales = false;  ///< by period of sale
  bool modes = false;  ///< by failure mode, if there are several
};
ReturnsResult returns_result(const AskedReturns& asked, const WeightedDraws& draws,
                             const ReturnsParts& parts = {});

/// Observed less expected, in standard deviations of the number.
double residual(int observed, const ReturnsCount& number);

/// Tables of returns by failure mode, the sums of the forecast as text for a terminal, and their JSON (returns_modes.cpp).
present::Table modes_fitted_table(const AskedReturns& asked, const ReturnsResult& result);
present::Table modes_forecast_table(const AskedReturns& asked, const ReturnsResult& result);
std::string modes_text(const AskedReturns& asked, const ReturnsResult& result);
/// Sentences on returns that are in no row of a fitted mode.
std::vector<std::string> modes_remarks(const AskedReturns& asked, const ReturnsResult& result);
nlohmann::ordered_json modes_json(const AskedReturns& asked, const ReturnsPeriod& each,
                                  bool to_come);
/// expected, expected_q05, ..., number_q95.
nlohmann::ordered_json count_json(const ReturnsCount& count);

/// Tables, terminal text, and `returns` in summary.json.
PresetAddition returns_addition(const AskedReturns& asked, const WeightedDraws& draws);

/// Returns by period, and their running sum, observed, fitted and to come.
std::vector<html::Figure> returns_figures(const AskedReturns& asked, const WeightedDraws& draws);

/// "76 returns are expected ...": for the verdict.
std::string returns_clause(const AskedReturns& asked, const WeightedDraws& draws);

/// Of a study with data.returns: reads predict.next, cost_per_return and planned_sales. Throws
/// InputError.
AskedReturns read_asked_returns(const TomlReader& root, const Source& source,
                                const std::shared_ptr<const FormulaModel>& model);

/// Adds notes, tables and figures to a study with data.returns; nothing to others. Throws InputError.
void add_returns(const TomlReader& root, const Source& source,
                 const std::shared_ptr<const FormulaModel>& model, PosteriorStudy& study);

}  // namespace wearwell::formula_model
