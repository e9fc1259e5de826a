#include "wearwell/study/bearing_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/bearing/wear_fit.h"
#include "wearwell/bearing/wear_number.h"
#include "wearwell/study/columns.h"
#include "wearwell/study/prior.h"
#include "wearwell/table/table.h"

namespace wearwell {
namespace {

using bearing::Contact;
using bearing::Duty;

// UDUNITS-2 counts angles in radians, bearings turns.
Unit in_turns(Unit unit) {
  if (bearing::is_angle(unit.text)) unit.scale /= 2 * std::numbers::pi;
  return unit;
}

Unit counted(const std::string& name, const Unit& unit) {
  return name == "speed" || name == "revolutions" ? in_turns(unit) : unit;
}

std::optional<Quantity> positive(const TomlReader& table, const std::string& name,
                                 const std::string& si) {
  auto quantity = table.quantity(name, si);
  if (!quantity) return {};
  quantity->unit = counted(name, quantity->unit);
  if (!(quantity->si() > 0)) table.fail(name, "must be positive");
  return quantity;
}

// One input of every inspection: from its column, or the same for all from [conditions].
struct Series {
  std::vector<double> values;  // SI
  std::optional<Quantity> constant;
  Unit unit;
};

// Reads the inputs of all inspections, each from where the study has it.
class Inputs {
 public:
  Inputs(const TomlReader& root, const std::filesystem::path& folder)
      : data_(root.required_table("data")),
        columns_(data_.required_table("columns")),
        conditions_(root.table("conditions")),
        table_(read_table(folder / data_.required_text("file"), data_.text("sql"))) {}

  const Table& table() const { return table_; }
  const TomlReader& columns() const { return columns_; }

  std::optional<Series> optional(const std::string& name, const std::string& si) const {
    auto column = read_column(columns_, name, si);
    const auto constant = conditions_ ? positive(*conditions_, name, si) : std::nullopt;
    refuse_both(name);
    if (constant) {
      return Series{std::vector<double>(table_.rows, constant->si()), constant, constant->unit};
    }
    if (!column) return {};
    column->unit = counted(name, column->unit);
    Series series{si_numbers(table_, *column), {}, column->unit};
    for (std::size_t i = 0; i < table_.rows; ++i) {
      require(series.values[i] > 0, table_, *column, i, "positive");
    }
    return series;
  }

  Series required(const std::string& name, const std::string& si) const {
    auto series = optional(name, si);
    if (!series) {
      columns_.fail(name, fmt::format("is missing; give it here, or in [conditions] if it is the "
                                      "same for all: {} = \"NUMBER {}\"",
                                      name, si));
    }
    return *series;
  }

  // One of two ways to say a thing.
  bool first_of(const std::string& first, const std::string& second,
                const std::string& third) const {
    const bool one = has(first), other = has(second) || has(third);
    if (one == other) {
      columns_.fail(one && has(second) ? second
                    : one              ? third
                                       : first,
                    fmt::format("{}; give {}, or {} with {}",
                                one ? fmt::format("is given beside {}", first) : "is missing",
                                first, second, third));
    }
    return one;
  }

  std::vector<Contact> contacts() const {
    const auto choice = read_column(columns_, "contact", "1");
    const auto constant = contact_in(conditions_);
    refuse_both("contact");
    if (constant) return std::vector<Contact>(table_.rows, *constant);
    if (!choice) {
      columns_.fail("contact",
                    fmt::format("is missing; give a column of words, or conditions.contact: {}",
                                fmt::join(bearing::contact_names(), ", ")));
    }
    const Column& column = table_.column(choice->column);
    std::vector<Contact> contacts;
    for (std::size_t i = 0; i < table_.rows; ++i) {
      const std::string word =
          column.is_number ? fmt::format("{}", column.numbers[i]) : column.text[i];
      const auto contact = bearing::contact_named(word);
      if (!contact) {
        throw InputError(fmt::format("{}: '{}' is no contact; it is one of {} (nearest: '{}')",
                                     place(table_, choice->column, i), word,
                                     fmt::join(bearing::contact_names(), ", "),
                                     nearest_name(word, bearing::contact_names())));
      }
      contacts.push_back(*contact);
    }
    return contacts;
  }

  // Which bearing each row belongs to; without a column each is one of its own.
  std::vector<std::size_t> bearings() const {
    std::vector<std::size_t> numbers(table_.rows);
    const auto choice = read_column(columns_, "bearing", "1");
    std::map<std::string, std::size_t> known;
    for (std::size_t i = 0; i < table_.rows; ++i) {
      std::string name = fmt::format("row {}", i + 1);
      if (choice) {
        const Column& column = table_.column(choice->column);
        name = !column.is_number               ? column.text[i]
               : std::isnan(column.numbers[i]) ? ""
                                               : fmt::format("{}", column.numbers[i]);
        if (name.empty()) {
          throw InputError(
              fmt::format("{}: no bearing is named", place(table_, choice->column, i)));
        }
      }
      numbers[i] = known.emplace(name, known.size()).first->second;
    }
    return numbers;
  }

  static std::optional<Contact> contact_in(const std::optional<TomlReader>& table) {
    const auto word = table ? table->choice("contact", bearing::contact_names()) : std::nullopt;
    return word ? bearing::contact_named(*word) : std::nullopt;
  }
  std::optional<Contact> constant_contact() const { return contact_in(conditions_); }

 private:
  bool has(const std::string& name) const {
    return columns_.has(name) || (conditions_ && conditions_->has(name));
  }
  void refuse_both(const std::string& name) const {
    if (!conditions_ || !conditions_->has(name) || !columns_.has(name)) return;
    conditions_->fail(name, fmt::format("is given here and as data.columns.{}; keep one", name));
  }

  TomlReader data_, columns_;
  std::optional<TomlReader> conditions_;
  Table table_;
};

// What all inspections have in common is what a prediction is for, unless it says otherwise.
struct Common {
  std::optional<Contact> contact;
  std::optional<Quantity> radius, clearance, pressure, speed;
};

struct BearingData {
  bearing::Inspections inspections;
  Common common;
  Unit depth_unit, pressure_unit;
  std::size_t bearings = 0;
};

BearingData read_data(const Inputs& inputs, ObservationFamily family) {
  const Table& table = inputs.table();
  const Series radius = inputs.required("radius", "m");
  const Series clearance = inputs.required("clearance", "m");
  const std::vector<Contact> contacts = inputs.contacts();
  BearingData data;
  data.pressure_unit = read_unit("MPa", "Pa");
  std::vector<double> pressures, revolutions;
  if (inputs.first_of("pressure", "force", "length")) {
    const Series pressure = inputs.required("pressure", "Pa");
    pressures = pressure.values;
    data.pressure_unit = pressure.unit;
    data.common.pressure = pressure.constant;
  } else {
    const Series force = inputs.required("force", "N"), length = inputs.required("length", "m");
    for (std::size_t i = 0; i < table.rows; ++i) {
      pressures.push_back(force.values[i] / (2 * radius.values[i] * length.values[i]));
    }
    if (force.constant && length.constant && radius.constant) {
      data.common.pressure =
          Quantity{from_si(data.pressure_unit, pressures.front()), data.pressure_unit};
    }
  }
  if (inputs.first_of("revolutions", "speed", "time")) {
    revolutions = inputs.required("revolutions", "1").values;
  } else {
    const Series speed = inputs.required("speed", "1/s"), time = inputs.required("time", "s");
    for (std::size_t i = 0; i < table.rows; ++i) {
      revolutions.push_back(speed.values[i] * time.values[i]);
    }
    data.common.speed = speed.constant;
  }
  data.common.contact = inputs.constant_contact();
  data.common.radius = radius.constant;
  data.common.clearance = clearance.constant;

  const ColumnChoice depth = required_column(inputs.columns(), "depth", "m");
  data.depth_unit = depth.unit;
  data.inspections.depth = si_numbers(table, depth);
  for (std::size_t i = 0; i < table.rows; ++i) {
    const double d = data.inspections.depth[i];
    require(family == ObservationFamily::normal || d > 0, table, depth, i,
            "positive for the lognormal likelihood (or use family = \"normal\")");
    require(contacts[i] != Contact::stationary || d < 2 * radius.values[i], table, depth, i,
            "less than the journal's diameter");
    require(contacts[i] != Contact::journal || d < radius.values[i], table, depth, i,
            "less than the journal's radius");
    data.inspections.duty.push_back(
        {contacts[i], radius.values[i], clearance.values[i], pressures[i], revolutions[i]});
  }
  data.inspections.bearing = inputs.bearings();
  data.bearings =
      1 + *std::max_element(data.inspections.bearing.begin(), data.inspections.bearing.end());
  return data;
}

std::vector<Parameter> read_parameters(const TomlReader& root, const Inputs& inputs,
                                       const BearingData& data, bearing::WearModel& model) {
  const TomlReader priors = root.required_table("prior");
  bearing::WearGuess guess{};
  try {
    guess = bearing::guess(data.inspections);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", inputs.table().source, error.what()));
  }
  model.has_scatter = priors.has("k_scatter");
  if (model.has_scatter && data.bearings < 2) {
    priors.fail("k_scatter", fmt::format("all rows of {} are of one bearing; the scatter between "
                                         "bearings needs at least 2",
                                         inputs.table().source));
  }
  std::vector<Parameter> parameters;
  parameters.push_back(read_prior(priors, {"k", "m^3/(N m)", 0, INFINITY, guess.k}));
  if (model.depth_error) {
    if (priors.has("sigma")) {
      priors.fail("sigma", "is given, but likelihood.depth_error says that it is known; keep one");
    }
  } else {
    if (data.inspections.depth.size() < 2) {
      throw InputError(fmt::format(
          "{} has 1 inspection; a wear rate and the scatter of depths need at least 2 (or a known "
          "likelihood.depth_error)",
          inputs.table().source));
    }
    double largest = 0;
    for (const double d : data.inspections.depth) largest = std::max(largest, std::abs(d));
    // Where bearings differ, not all of the residuals is the measurement's.
    const double sigma = std::max((model.has_scatter ? 0.5 : 1) * guess.sigma, 1e-3 * largest);
    parameters.push_back(read_prior(priors, {"sigma", "m", 0, INFINITY, sigma}));
  }
  if (model.has_scatter) {
    parameters.push_back(
        read_prior(priors, {"k_scatter", "1", 0, INFINITY, std::max(guess.scatter, 0.05)}));
  }
  return parameters;
}

std::string in_words(const bearing::WearModel& model, const BearingData& data) {
  const std::string sd =
      model.depth_error
          ? fmt::format("{:.4g} {} (known)", from_si(data.depth_unit, *model.depth_error),
                        data.depth_unit.text)
          : "sigma";
  const std::string rate =
      model.has_scatter
          ? fmt::format(", k of each of {} bearings = k exp(k_scatter z), z ~ N(0, 1)",
                        data.bearings)
          : "";
  return fmt::format(
      "depth = radius x delta(p_a k n, clearance/radius){}; depth measured with {} scatter of "
      "standard deviation {}",
      rate, model.family == ObservationFamily::normal ? "normal" : "lognormal", sd);
}

// The depth of one duty as a function of the wear rate; a bearing worn beyond its geometry stays
// at the last depth that it has.
std::function<double(double k)> depth_function(const Duty& duty, double k) {
  const bearing::DepthLaw law = bearing::depth_laws({duty}, k).front();
  return [law](double rate) { return law.depth(std::min(std::log(rate), law.limit())); };
}

PredictionRequest depth_request(const bearing::WearModel& model, const BearingData& data,
                                const Duty& duty, double k, std::optional<double> measured) {
  const auto depth = depth_function(duty, k);
  PredictionRequest request{"revolutions",
                            duty.revolutions,
                            "depth",
                            data.depth_unit,
                            [depth](const double* x) { return depth(x[0]); },
                            [model](const double* x) { return model.sigma(x); },
                            model.family,
                            measured,
                            {}};
  if (model.has_scatter) {
    request.item = [model, depth](const double* x, double z) {
      return depth(x[0] * std::exp(model.scatter(x) * z));
    };
  }
  return request;
}

std::string in_words(const Quantity& quantity) {
  return fmt::format("{:.6g} {}", quantity.value, quantity.unit.text);
}

// Reads [predict]: of a bearing as in [conditions], or as said here.
class Predictions {
 public:
  Predictions(const TomlReader& predict, const bearing::WearModel& model, const BearingData& data,
              double k, Study& study)
      : predict_(predict), model_(model), data_(data), k_(k), study_(study) {
    contact_ =
        Inputs::contact_in(predict).value_or(data.common.contact.value_or(Contact::stationary));
    has_contact_ = predict.has("contact") || data.common.contact;
    radius_ = mine("radius", "m", data.common.radius);
    clearance_ = mine("clearance", "m", data.common.clearance);
    speed_ = mine("speed", "1/s", data.common.speed);
    force_ = positive(predict, "force", "N");
    const auto length = positive(predict, "length", "m");
    pressure_ = mine("pressure", "Pa", data.common.pressure);
    if (length) {
      if (!force_) predict.fail("length", "needs predict.force: together they are a pressure");
      if (predict.has("pressure")) {
        predict.fail("pressure", "is given beside force and length; keep one way to say the load");
      }
      const Unit& unit = data.pressure_unit;
      pressure_ = Quantity{
          from_si(unit, force_->si() / (2 * need(radius_, "radius", "length").si() * length->si())),
          unit};
      force_.reset();  // its length is known
    }
  }

  void read() {
    const auto revolutions = predict_.quantities("revolutions", "1");
    const auto times = predict_.quantities("time", "s");
    for (Quantity n : revolutions) {
      n.unit = in_turns(n.unit);
      depth("revolutions", n.si(), fmt::format("after {:.6g} revolutions", n.si()));
    }
    for (const Quantity& time : times) {
      depth("time", time.si() * need(speed_, "speed", "time").si(), "after " + in_words(time));
    }
    const auto limit = positive(predict_, "limit", "m");
    const auto required = required_revolutions();
    if (required && !limit) {
      predict_.fail(required_key_, "needs predict.limit: the depth that is allowed until then");
    }
    if (limit) reach(*limit, required);
    if (force_ && !required) {
      predict_.fail("force",
                    "needs predict.required_revolutions (or required_time) for the length that it "
                    "needs, or predict.length for the pressure that it gives");
    }
  }

 private:
  std::optional<Quantity> mine(const char* name, const char* si,
                               const std::optional<Quantity>& common) const {
    const auto own = positive(predict_, name, si);
    return own ? own : common;
  }

  const Quantity& need(const std::optional<Quantity>& quantity, const char* name,
                       const char* key) const {
    if (!quantity) {
      predict_.fail(key, fmt::format("needs predict.{}: it is not the same for all data", name));
    }
    return *quantity;
  }

  Duty duty(const char* key, double revolutions, double pressure) const {
    if (!has_contact_) {
      predict_.fail(key, "needs predict.contact: it is not the same for all data");
    }
    return {contact_, need(radius_, "radius", key).si(), need(clearance_, "clearance", key).si(),
            pressure, revolutions};
  }

  // The two ways to ask for a life: a number of revolutions, or a time at a speed.
  std::optional<double> required_revolutions() {
    auto turns = positive(predict_, "required_revolutions", "1");
    const auto time = positive(predict_, "required_time", "s");
    if (turns && time) {
      predict_.fail("required_time", "is given beside required_revolutions; keep one of the two");
    }
    if (turns) {
      required_key_ = "required_revolutions";
      turns->unit = in_turns(turns->unit);
      required_words_ = fmt::format("{:.6g} revolutions", turns->si());
      return turns->si();
    }
    if (!time) return {};
    required_key_ = "required_time";
    required_words_ = in_words(*time);
    time_unit_ = time->unit;
    return time->si() * need(speed_, "speed", "required_time").si();
  }

  // A quantity of the bearing in the middle, and of a new one where bearings differ.
  void add(QuantityRequest request) {
    request.driver = [](const double* x) { return x[0]; };
    request.of = model_.has_scatter ? "median bearing" : "bearing";
    study_.quantities.push_back(request);
    if (!model_.has_scatter) return;
    request.scatter = [model = model_](const double* x) { return model.scatter(x); };
    request.of = "new bearing";
    study_.quantities.push_back(request);
  }

  void depth(const char* key, double revolutions, const std::string& when) {
    if (!(revolutions > 0)) predict_.fail(key, "must be positive");
    const Quantity& pressure = need(pressure_, "pressure", key);
    const Duty at = duty(key, revolutions, pressure.si());
    study_.predictions.push_back(depth_request(model_, data_, at, k_, {}));
    add({"depth",
         "",
         fmt::format("{} at {}", when, in_words(pressure)),
         data_.depth_unit,
         true,
         false,
         depth_function(at, k_),
         {},
         {}});
  }

  void reach(const Quantity& limit, std::optional<double> required) {
    const Duty at = duty("limit", 0, 0);
    double wear = 0;
    try {
      wear = bearing::wear_number(at.contact, at.clearance / at.radius, limit.si() / at.radius);
    } catch (const InputError& error) {
      predict_.fail("limit", error.what());
    }
    const std::string to = "to " + in_words(limit);
    if (!pressure_ && !required) {
      predict_.fail("limit",
                    "needs predict.pressure for the life until then, or required_revolutions (or "
                    "required_time) for the pressure that is allowed");
    }
    if (pressure_) {
      const std::string where = fmt::format("{} at {}", to, in_words(*pressure_));
      const double rate = pressure_->si();
      add({"life",
           "",
           where,
           Unit{"revolutions", 1, 0},
           false,
           true,
           [=](double k) { return wear / (k * rate); },
           {},
           {}});
      if (speed_) {
        const double turns = speed_->si();
        add({"life",
             "",
             fmt::format("{}, {}", where, in_words(*speed_)),
             time_unit_,
             false,
             true,
             [=](double k) { return wear / (k * rate * turns); },
             {},
             {}});
      }
    }
    if (!required) return;
    const double n = *required;
    add({"pressure",
         "",
         fmt::format("{} in {}", to, required_words_),
         data_.pressure_unit,
         false,
         false,
         [=](double k) { return wear / (k * n); },
         {},
         {}});
    if (!force_) return;
    const double per_rate = force_->si() * n / (2 * at.radius * wear);
    add({"length",
         "",
         fmt::format("{} in {} under {}", to, required_words_, in_words(*force_)),
         read_unit("mm", "m"),
         true,
         false,
         [=](double k) { return k * per_rate; },
         {},
         {}});
  }

  const TomlReader& predict_;
  const bearing::WearModel& model_;
  const BearingData& data_;
  double k_;
  Study& study_;
  Contact contact_;
  bool has_contact_ = false;
  std::optional<Quantity> radius_, clearance_, pressure_, speed_, force_;
  std::string required_key_, required_words_;
  Unit time_unit_ = read_unit("h", "s");
};

}  // namespace

void read_bearing_study(const TomlReader& root, const std::filesystem::path& folder, Study& study) {
  bearing::WearModel model;
  if (const auto likelihood = root.table("likelihood")) {
    const auto family = likelihood->choice("family", {"normal", "lognormal"});
    if (family == "lognormal") model.family = ObservationFamily::lognormal;
    if (const auto error = positive(*likelihood, "depth_error", "m")) {
      model.depth_error = error->si();
    }
  }
  const Inputs inputs(root, folder);
  const BearingData data = read_data(inputs, model.family);
  study.parameters = read_parameters(root, inputs, data, model);
  study.equation = in_words(model, data);
  study.data_rows = data.inspections.depth.size();
  study.quantity = "wear depth";
  study.meanings = {"specific wear rate"};
  if (!model.depth_error) study.meanings.push_back("scatter of one measured depth");
  if (model.has_scatter) study.meanings.push_back("scatter of ln k between bearings");
  study.likelihood = [=, inspections = data.inspections](std::size_t rows) {
    return bearing::wear_likelihood(model, inspections, rows);
  };
  const double k = study.parameters.front().start;
  study.stage_predictions = [=](std::size_t rows) {
    std::vector<PredictionRequest> requests;
    for (std::size_t i = rows - 1; i < std::min(rows + 1, data.inspections.depth.size()); ++i) {
      requests.push_back(
          depth_request(model, data, data.inspections.duty[i], k, data.inspections.depth[i]));
    }
    return requests;
  };
  if (const auto predict = root.table("predict")) {
    Predictions(*predict, model, data, k, study).read();
  }
}

}  // namespace wearwell
