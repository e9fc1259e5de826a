#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>

#include "attended.h"
#include "core.h"
#include "wearwell/base/error.h"
#include "wearwell/cli/selection_header.h"
#include "wearwell/models/bearing/commands.h"
#include "wearwell/models/clutch/clutch_model_file.h"
#include "wearwell/models/clutch/clutch_predict.h"
#include "wearwell/models/clutch/cycle_table.h"
#include "wearwell/models/fatigue/rainflow.h"
#include "wearwell/selection/data.h"
#include "wearwell/selection/json.h"
#include "wearwell/selection/report.h"
#include "wearwell/selection/text.h"
#include "wearwell/study/header_json.h"

namespace wearwell::python {
namespace {

// (summary.json, text, models.csv, page) of a selection; as `wearwell select` with these options.
py::tuple select(const std::variant<std::shared_ptr<Table>, std::string>& data, SelectData asked,
                 const std::string& criterion, int keep, double near, int folds, int nested,
                 std::uint64_t seed, double seconds, int threads, bool report) {
  std::string summary, text, models, page;
  Attended attended(py::none{});
  attended.run([&] {
    const ForkGuard guard;
    std::atomic<bool> stop = false;
    const std::stop_callback stopped(attended.stop(), [&] { stop = true; });
    const auto* table = std::get_if<std::shared_ptr<Table>>(&data);
    if (!table) asked.file = std::get<std::string>(data);
    SelectionResult result = table ? read_selection(asked, **table) : read_selection(asked);
    result.version = WEARWELL_VERSION;
    SearchSettings& search = result.settings.search;
    search.criterion = read_criterion(criterion);
    search.keep = keep;
    search.near = near;
    search.seconds = seconds;
    search.threads = guard.forked() ? 1 : threads;
    constexpr int few_terms = 20;  // as the command has it
    if (static_cast<int>(result.design.terms.size() - search.forced.size()) <= few_terms) {
      search.prove_sizes = true;
      if (report) search.cloud = CloudKind::bins;
    }
    search.stop = &stop;
    result.settings.folds = folds;
    result.settings.nested = nested;
    result.settings.seed = seed;
    result.selection =
        select_terms(result.design, result.observed, result.weights, result.settings);
    result.settings.search.stop = nullptr;
    nlohmann::ordered_json json = to_json(selection_header(result));
    json.update(to_json(result), true);
    summary = json.dump(2) + "\n";
    text = selection_text(result);
    models = models_csv(result);
    if (report && !result.selection.search.models.empty()) page = selection_report(result);
  });
  return py::make_tuple(summary, text, models, page);
}

/// Cycles and half cycles in the order in which they close: from, to, count.
py::tuple rainflow(const py::array_t<double, py::array::forcecast>& signal, bool three_points,
                   bool repeat) {
  const auto view = signal.unchecked<1>();
  std::vector<double> samples(static_cast<std::size_t>(view.shape(0)));
  for (py::ssize_t i = 0; i < view.shape(0); ++i) {
    samples[static_cast<std::size_t>(i)] = view(i);
    if (!std::isfinite(view(i))) throw InputError(fmt::format("signal, row {}: no number", i + 1));
  }
  std::vector<double> from, to, count;
  {
    const py::gil_scoped_release release;
    fatigue::Rainflow counted(
        three_points ? fatigue::Counting::three_point : fatigue::Counting::four_point,
        repeat ? fatigue::Residual::repeat : fatigue::Residual::half);
    const auto take = [&](double a, double b, double n) {
      from.push_back(a);
      to.push_back(b);
      count.push_back(n);
    };
    const auto point = [&](double p) { counted.add(p, take); };
    fatigue::TurningPoints turns;
    turns.add(samples, point);
    turns.finish(point);
    counted.finish(take);
  }
  const auto array = [](const std::vector<double>& values) {
    return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
  };
  return py::make_tuple(array(from), array(to), array(count));
}

py::tuple bearing_answer(const std::string& command, const std::string& contact,
                         const std::map<std::string, std::string>& inputs, const std::string& unit,
                         const std::string& limit, int draws, std::uint64_t seed) {
  bearing::Told told;
  {
    const py::gil_scoped_release release;
    told = bearing::answer(command, {contact, inputs, unit, limit, draws, seed});
  }
  return py::make_tuple(told.json.dump(), told.warnings, told.margin);
}

/// A wear model and the plates that went through it.
class Cycles {
 public:
  Cycles(const std::string& model, bool scatter_only, bool skip)
      : model_(clutch::read_model(model)),
        sum_(model_, !scatter_only, skip ? clutch::NotFinite::skip : clutch::NotFinite::refuse) {}

  std::size_t add(const Table& table) {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> names = names_;
    const clutch::CycleColumns cycles = clutch::cycle_columns(table, names);
    const bool named = !table.column("plate").is_number;
    if (any_ && named != named_) {
      throw InputError(table.source + ": plates are " + (named ? "names" : "numbers") +
                       " here, and were not before");
    }
    clutch::CycleSum::Rates rates;
    sum_.rates(cycles, rates);
    const std::vector<clutch::PlateWear> before = sum_.plates();
    if (named) sum_.name_plates(names);
    try {
      sum_.add(cycles, rates);
    } catch (const InputError& error) {
      sum_.restore(before);  // all of these cycles or none
      throw InputError(table.source + ", " + error.what());
    }
    any_ = true;
    named_ = named;
    names_ = std::move(names);
    return table.rows;
  }
  std::size_t add_file(const std::string& file) {
    const std::lock_guard lock(mutex_);
    const std::vector<clutch::PlateWear> before = sum_.plates();
    try {
      return clutch::sum_cycles(file, sum_);
    } catch (...) {
      sum_.restore(before);
      throw;
    }
  }
  std::string json() const {
    const std::lock_guard lock(mutex_);
    return wear_json(model_, sum_, sum_.with_replicates()).dump();
  }

 private:
  clutch::WearModel model_;
  clutch::CycleSum sum_;
  mutable std::mutex mutex_;
  std::vector<std::string> names_;
  bool any_ = false, named_ = false;
};

}  // namespace

void add_tools(py::module_& module) {
  module.def("select",
             [](const std::variant<std::shared_ptr<Table>, std::string>& data,
                const std::string& response, const std::vector<std::string>& inputs,
                std::optional<int> degree, const std::vector<std::string>& terms,
                const std::string& weights, const std::vector<std::string>& forced,
                const std::string& criterion, int keep, double near, int folds, int nested,
                std::uint64_t seed, double seconds, int threads, bool report) {
               return select(data, {{}, {}, response, inputs, degree, terms, weights, forced},
                             criterion, keep, near, folds, nested, seed, seconds, threads, report);
             });
  module.def("rainflow", &rainflow);
  module.def("bearing", &bearing_answer);
  py::class_<Cycles>(module, "Cycles")
      .def(py::init<const std::string&, bool, bool>())
      .def("add", &Cycles::add, py::call_guard<py::gil_scoped_release>())
      .def("add_file", &Cycles::add_file, py::call_guard<py::gil_scoped_release>())
      .def("json", &Cycles::json);
}

}  // namespace wearwell::python
