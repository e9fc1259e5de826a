#include "wearwell/models/joint/joint_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/prior.h"
#include "wearwell/input/table.h"
#include "wearwell/models/joint/archard.h"
#include "wearwell/models/joint/inspection.h"
#include "wearwell/models/joint/work_history.h"

// Longer than others: work and volume have many sources, which exclude each other.
namespace wearwell {
namespace {

// The inspections with what is needed to speak of them in the user's terms.
struct JointData {
  joint::Inspections inspections;  // SI
  std::vector<double> cycles;
  Unit volume_unit;
  std::optional<double> work_per_cycle;  // J, where it is constant
  std::string work_in_words;
  std::optional<PointwiseTable> pointwise;
  std::vector<DataColumn> columns;
  std::string layout;  // of the table, in words
};

// A profile of force and slip over one cycle: work per cycle.
double read_profile(const TomlReader& profile, const Source& source) {
  const auto rule = profile.choice("rule", {"rectangle", "trapezoid"});
  if (!rule) profile.fail("rule", "is missing: \"rectangle\" (sum of F_i ds_i) or \"trapezoid\"");
  const TomlReader columns = profile.required_table("columns");
  const Table table = read_table(profile, source);
  const ColumnChoice force = required_column(columns, "force", "N", table);
  const ColumnChoice slip = required_column(columns, "slip_increment", "m", table);
  try {
    return joint::work_per_cycle(
        si_numbers(table, force), si_numbers(table, slip),
        *rule == "rectangle" ? joint::WorkRule::rectangle : joint::WorkRule::trapezoid);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", table.source, error.what()));
  }
}

// k = V/(F s), every measurement for itself.
PointwiseTable pointwise_table(const Table& table, const std::vector<double>& cycles,
                               const ColumnChoice& volume, const ColumnChoice& force,
                               const ColumnChoice& slip) {
  PointwiseTable result{
      volume.unit.text,
      force.unit.text,
      slip.unit.text,
      fmt::format("{}/({} {})", volume.unit.text, force.unit.text, slip.unit.text),
      {}};
  const auto v = si_numbers(table, volume), f = si_numbers(table, force),
             s = si_numbers(table, slip);
  for (std::size_t i = 0; i < table.rows; ++i) {
    require(f[i] > 0, table, force, i, "positive");
    require(s[i] > 0, table, slip, i, "positive");
    const double fv = from_si(force.unit, f[i]), sv = from_si(slip.unit, s[i]),
                 vv = from_si(volume.unit, v[i]);
    result.rows.push_back({cycles[i], fv, sv, vv, vv / (fv * sv)});
  }
  return result;
}

// The friction work of each inspection, from whichever source the study names.
void read_work(const TomlReader& root, const TomlReader& columns, const Source& source,
               const Table& table, JointData& data) {
  const auto conditions = root.table("conditions");
  const auto constant =
      conditions ? conditions->quantity("work_per_cycle", "N m/cycle") : std::nullopt;
  const auto profile = conditions ? conditions->table("profile") : std::nullopt;
  const auto work = read_column(columns, "work", "N m", table);
  const auto force = read_column(columns, "force", "N", table);
  const auto slip = read_column(columns, "slip", "m", table);
  if (force.has_value() != slip.has_value()) {
    columns.fail(force ? "slip" : "force", "is missing: force and slip go together");
  }
  if (constant.has_value() + profile.has_value() + work.has_value() > 1) {
    root.fail("conditions",
              "the work is given twice; keep one of conditions.work_per_cycle, conditions.profile "
              "and data.columns.work");
  }

  if (constant || profile) {
    data.work_per_cycle = constant ? constant->si() : read_profile(*profile, source);
    if (!(*data.work_per_cycle > 0)) conditions->fail("work_per_cycle", "must be positive");
    data.work_in_words =
        constant ? fmt::format("cycles x {:.6g} {}", constant->value, constant->unit.text)
                 : fmt::format("cycles x {:.6g} N m (from the profile)", *data.work_per_cycle);
    for (const double c : data.cycles) data.inspections.work.push_back(c * *data.work_per_cycle);
  } else if (work) {
    data.work_in_words = fmt::format("column '{}'", work->column);
    data.inspections.work = si_numbers(table, *work);
    for (std::size_t i = 0; i < table.rows; ++i) {
      require(data.inspections.work[i] >= 0, table, *work, i, "0 or more");
    }
    data.columns.push_back({"work", "N m", work->unit, data.inspections.work});
  } else if (force) {
    data.work_in_words = fmt::format("'{}' x '{}'", force->column, slip->column);
    const auto f = si_numbers(table, *force), s = si_numbers(table, *slip);
    for (std::size_t i = 0; i < table.rows; ++i) data.inspections.work.push_back(f[i] * s[i]);
    data.columns.push_back({"force", "N", force->unit, f, true});
    data.columns.push_back(
        {.name = "slip", .si = "m", .unit = slip->unit, .values = s, .endless = true});
  } else {
    root.fail("conditions",
              "the friction work is missing; give conditions.work_per_cycle, conditions.profile, "
              "data.columns.work, or data.columns.force and slip");
  }
  if (force && data.inspections.volume.size() == table.rows) {
    data.pointwise = pointwise_table(table, data.cycles,
                                     *read_column(columns, "volume", "m^3", table), *force, *slip);
  }
}

// Worn volume from pin positions: rows are angles, inspections are the distinct numbers of cycles.
void read_pin_positions(const TomlReader& root, const TomlReader& columns, const Table& table,
                        JointData& data) {
  if (columns.has("force") || columns.has("work")) {
    columns.fail(columns.has("force") ? "force" : "work",
                 "pin positions (dx, dy) have many rows an inspection; give "
                 "conditions.work_per_cycle or profile");
  }
  const ColumnChoice dx = required_column(columns, "dx", "m", table),
                     dy = required_column(columns, "dy", "m", table);
  const TomlReader conditions = root.required_table("conditions");
  const Quantity pin = conditions.required_quantity("pin_radius", "m");
  const Quantity bushing = conditions.required_quantity("bushing_radius", "m");
  const Quantity length = conditions.required_quantity("length", "m");
  if (!(pin.si() > 0 && bushing.si() > pin.si())) {
    conditions.fail("bushing_radius", "must be larger than pin_radius, and both positive");
  }
  if (!(length.si() > 0)) conditions.fail("length", "must be positive");
  data.volume_unit = read_unit("mm^3", "m^3");
  data.columns.push_back({"dx", "m", dx.unit, si_numbers(table, dx)});
  data.columns.push_back({"dy", "m", dy.unit, si_numbers(table, dy)});
  joint::WornVolume worn =
      joint::worn_volume({pin.si(), bushing.si(), length.si()}, data.cycles,
                         (data.columns.end() - 2)->values, data.columns.back().values);
  data.cycles = std::move(worn.cycles);
  data.inspections.volume = std::move(worn.volume);
}

JointData read_data(const TomlReader& root, const Source& source, ObservationFamily family) {
  const TomlReader data_table = root.required_table("data");
  const TomlReader columns = data_table.required_table("columns");
  const bool positions = columns.has("dx") || columns.has("dy");
  if (positions && columns.has("volume")) {
    columns.fail("volume", "is given beside pin positions (dx, dy); keep one of the two");
  }

  const Table table = with_counts(columns, read_table(data_table, source));
  const ColumnChoice cycles = required_column(columns, "cycles", "cycle", table);
  JointData data;
  data.layout = table.layout;
  data.cycles = si_numbers(table, cycles);
  for (std::size_t i = 0; i < table.rows; ++i) {
    require(data.cycles[i] >= 0, table, cycles, i, "0 or more");
  }
  data.columns.push_back({"cycles", "cycle", cycles.unit, data.cycles});
  if (positions) {
    read_pin_positions(root, columns, table, data);
  } else {
    const ColumnChoice volume = required_column(columns, "volume", "m^3", table);
    data.volume_unit = volume.unit;
    data.inspections.volume = si_numbers(table, volume);
    data.columns.push_back({"volume", "m^3", volume.unit, data.inspections.volume});
    if (family == ObservationFamily::lognormal) {
      for (std::size_t i = 0; i < table.rows; ++i) {
        require(data.inspections.volume[i] > 0, table, volume, i,
                "positive for the lognormal likelihood (or use family = \"normal\")");
      }
    }
  }
  read_work(root, columns, source, table, data);

  const std::size_t rows = data.cycles.size();
  if (rows < 2) {
    throw InputError(
        fmt::format("{} has {} inspection; a wear coefficient and its scatter need at least 2",
                    table.source, rows));
  }
  const auto& work = data.inspections.work;
  if (*std::max_element(work.begin(), work.end()) <= 0) {
    throw InputError(fmt::format("{}: no inspection after any friction work", table.source));
  }
  if (family == ObservationFamily::lognormal) {
    for (std::size_t i = 0; i < rows; ++i) {
      if (work[i] <= 0 || data.inspections.volume[i] <= 0) {
        throw InputError(
            fmt::format("{}, inspection {}: work and volume must be positive for the lognormal "
                        "likelihood (or use family = \"normal\")",
                        table.source, i + 1));
      }
    }
  }
  return data;
}

std::vector<Parameter> read_parameters(const TomlReader& root, const JointData& data,
                                       joint::Archard& law) {
  const auto priors = root.table("prior");
  const joint::LeastSquares guess = joint::least_squares(data.inspections);
  const double largest =
      std::abs(*std::max_element(data.inspections.volume.begin(), data.inspections.volume.end(),
                                 [](double a, double b) { return std::abs(a) < std::abs(b); }));
  // Data that a line fits perfectly still scatter a little.
  const double sigma = std::max({guess.sigma, 1e-3 * largest, std::numeric_limits<double>::min()});
  const double k = guess.k > 0 ? guess.k : sigma / law.reference_work;

  // Defaults: Archard's coefficient of metals and polymers lies between 1e-8 and 1e-2 (Archard and
  // Hirst 1956), which at a hardness of about 1 GPa is as much in mm^3/(N m); a measurement does not
  // scatter by more than what it measures.
  const std::string& unit = data.volume_unit.text;
  const double size = rounded_up(largest);
  const auto read = [&](ParameterSpec spec, DefaultPrior fallback) {
    spec.fallback = std::move(fallback);
    return read_prior(root, priors, spec);
  };
  std::vector<Parameter> parameters;
  parameters.push_back(read({"k", "m^3/(N m)", 0, INFINITY, k},
                            {"lognormal", Lognormal{std::log(1e-14), 4.2}, unit + "/(N m)"}));
  parameters.push_back(
      read({"sigma", "m^3", 0, INFINITY, sigma}, {"half-normal", Normal{0, size}, unit, 0}));
  law.has_constant = priors && priors->has("V0");
  law.has_exponent = priors && priors->has("exponent");
  if (law.has_constant) {
    parameters.push_back(
        read({"V0", "m^3", -INFINITY, INFINITY, 0.1 * sigma}, {"normal", Normal{0, size}, unit}));
  }
  if (law.has_exponent) {
    parameters.push_back(
        read({"exponent", "1", 0, INFINITY, 1}, {"lognormal", Lognormal{0, 0.5}, "1"}));
  }
  return parameters;
}

std::string in_words(const joint::Archard& law, ObservationFamily family, const JointData& data) {
  std::string mean = "k W";
  if (law.has_exponent) mean += " (W/W_ref)^(exponent - 1)";
  if (law.has_constant) mean = "V0 + " + mean;
  return fmt::format(
      "V = {}, W = {}{}; V measured with {} scatter of standard deviation sigma", mean,
      data.work_in_words,
      law.has_exponent ? fmt::format(", W_ref = {:.6g} N m", law.reference_work) : "",
      family == ObservationFamily::normal ? "normal" : "lognormal");
}

}  // namespace

void read_joint_study(const TomlReader& root, const Source& source, PosteriorStudy& study) {
  const TomlReader likelihood = root.required_table("likelihood");
  const auto family_name = likelihood.choice("family", {"normal", "lognormal"});
  if (!family_name) likelihood.fail("family", "is missing: \"normal\" or \"lognormal\"");
  const ObservationFamily family =
      *family_name == "normal" ? ObservationFamily::normal : ObservationFamily::lognormal;

  const JointData data = read_data(root, source, family);
  const auto& work = data.inspections.work;
  joint::Archard law;
  law.reference_work = *std::max_element(work.begin(), work.end());
  study.parameters = read_parameters(root, data, law);
  study.equation = in_words(law, family, data);
  study.data_rows = data.cycles.size();
  study.pointwise = data.pointwise;
  study.quantity = "worn volume";
  study.observed = data.inspections.volume;
  study.data_columns = data.columns;
  study.data_layout = data.layout;
  study.meanings = {"wear coefficient", "scatter of one measurement"};
  if (law.has_constant) study.meanings.push_back("volume before any work");
  if (law.has_exponent) study.meanings.push_back("exponent of the work");
  study.likelihood = [=, inspections = data.inspections](std::size_t rows) {
    return joint::archard_likelihood(law, family, inspections, rows);
  };

  study.fit_data = FitData{joint::archard_scores(law, family, data.inspections),
                           {},
                           {{"friction work", work}},
                           Rise{"worn volume grows with friction work",
                                work,
                                data.inspections.volume,
                                {},
                                !law.has_constant},
                           "inspection"};

  // Where the work per cycle is constant, it is so past and to come.
  const auto predict = root.table("predict");
  std::optional<double> rate = data.work_per_cycle;
  if (predict && !rate) {
    if (const auto future = predict->quantity("work_per_cycle", "N m/cycle")) {
      if (!(future->si() > 0)) predict->fail("work_per_cycle", "must be positive");
      rate = future->si();
    }
  }
  const joint::WorkHistory history = data.work_per_cycle
                                         ? joint::WorkHistory({}, {}, rate)
                                         : joint::WorkHistory(data.cycles, work, rate);
  const auto request = [=](double cycles, double at_work, std::optional<double> measured) {
    return PredictionRequest{"cycles",
                             cycles,
                             "volume",
                             data.volume_unit,
                             [=](const double* x) { return law.mean_volume(x, at_work); },
                             [](const double* x) { return x[1]; },
                             family,
                             measured};
  };
  study.stage_predictions = [=](std::size_t rows) {
    std::vector<PredictionRequest> requests;
    for (std::size_t i = rows - 1; i < std::min(rows + 1, data.cycles.size()); ++i) {
      requests.push_back(request(data.cycles[i], work[i], data.inspections.volume[i]));
    }
    return requests;
  };
  // The curve ends after the last inspection or prediction, or somewhat after the limit.
  constexpr int points = 32;
  const double seen = *std::max_element(data.cycles.begin(), data.cycles.end());
  double end = seen;
  if (predict && rate) {
    for (const Quantity& cycles : predict->quantities("cycles", "cycle")) {
      end = std::max(end, cycles.si());
    }
    if (const auto limit = predict->quantity("limit", "m^3")) {
      const double k = joint::least_squares(data.inspections).k;
      const double reached = history.cycles_at(limit->si() / k);
      if (reached > 0) end = std::max(end, std::min(reached, 3 * end));
    }
    end *= 1.1;
  }
  for (int i = 0; i <= points; ++i) {
    const double cycles = end * std::max<double>(i, 1e-3) / points;
    study.history.push_back(request(cycles, history.work_at(cycles), {}));
  }
  if (!predict) return;

  const auto need_rate = [&](const char* key) {
    if (!rate) predict->fail(key, "needs the work of future cycles; give predict.work_per_cycle");
  };
  for (const Quantity& cycles : predict->quantities("cycles", "cycle")) {
    need_rate("cycles");
    if (!(cycles.si() >= 0)) predict->fail("cycles", "must be 0 or more");
    std::optional<double> measured;
    for (std::size_t i = 0; i < data.cycles.size(); ++i) {
      if (data.cycles[i] == cycles.si()) measured = data.inspections.volume[i];
    }
    study.predictions.push_back(request(cycles.si(), history.work_at(cycles.si()), measured));
    study.reaches.push_back({fmt::format("the prediction at {:.6g} cycles", cycles.si()),
                             fmt::format("the last inspection was after {:.6g} cycles", seen),
                             cycles.si(), seen});
  }
  const auto risk = predict->quantity("risk", "1");
  if (risk && !(risk->si() > 0 && risk->si() < 1))
    predict->fail("risk", "must lie between 0 and 1, as 0.05 or \"5 %\"");
  if (const auto limit = predict->quantity("limit", "m^3")) {
    need_rate("limit");
    if (!(limit->si() > 0)) predict->fail("limit", "must be positive");
    const auto& volumes = data.inspections.volume;
    const double most = *std::max_element(volumes.begin(), volumes.end());
    if (most > 0) {
      study.reaches.push_back(
          {fmt::format("the limit of {:.6g} {}", limit->value, limit->unit.text),
           fmt::format("the largest volume measured is {:.4g} {}", from_si(data.volume_unit, most),
                       data.volume_unit.text),
           limit->si(), most});
    }
    study.life = LifeRequest{Unit{"1", 1, 0},
                             "cycles",
                             *limit,
                             *std::max_element(data.cycles.begin(), data.cycles.end()),
                             risk ? risk->si() : 0.01,
                             [=, limit = limit->si()](const WeightedDraws& draws) {
                               return life_law(draws, [=](const double* x) {
                                 return history.cycles_at(law.work_at(x, limit));
                               });
                             }};
  } else if (risk) {
    predict->fail("risk", "needs predict.limit");
  }
}

}  // namespace wearwell
