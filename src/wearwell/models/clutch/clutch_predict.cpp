#include "wearwell/models/clutch/clutch_predict.h"

#include <fmt/format.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <memory>

#include "wearwell/base/error.h"
#include "wearwell/input/column_stream.h"
#include "wearwell/input/csv_reader.h"
#include "wearwell/input/labelled.h"
#include "wearwell/models/clutch/clutch_tables.h"

namespace wearwell::clutch {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

constexpr std::size_t batch_rows = 16'384;
constexpr std::size_t batches_in_flight = 8;

struct Batch {
  std::size_t first_row = 0;
  std::vector<std::vector<double>> raw;  ///< by column of the file
  CycleColumns cycles;
  CycleSum::Rates rates;
  std::shared_ptr<const std::vector<std::string>>
      names;  ///< of all earlier plates, if they have names
};

enum Place { plate, number, slip_speed, torque, temperature, closing_time, energy, places };
constexpr const char* names[places] = {"plate",       "cycle",        "slip_speed", "torque",
                                       "temperature", "closing_time", "energy"};
constexpr const char* dimensions[places] = {"1", "cycle", "rad/s", "N m", "K", "s", "J"};

class Reader {
 public:
  /// `known`: the plates named in an earlier file.
  Reader(const std::filesystem::path& file, const std::vector<PlateWear>& known) : stream_(file) {
    std::vector<std::string> headings;
    const Table all = stream_.columns();
    for (int c = 0; c < places; ++c) {
      columns_.push_back(find_labelled(all, names[c], dimensions[c]));
      headings.push_back(columns_.back().column);
    }
    std::vector<std::string> known_names(known.size());
    bool named = false;
    for (const PlateWear& p : known) {
      named = named || !p.name.empty();
      if (!p.name.empty() && p.plate >= 1 && p.plate <= std::ssize(known))
        known_names[static_cast<std::size_t>(p.plate - 1)] = p.name;
    }
    stream_.select(headings, headings[plate], named ? known_names : std::vector<std::string>());
    if (!known.empty() && named != stream_.has_words())
      throw InputError(fmt::format("{}: its plates are {}, but those of the state are {}",
                                   stream_.source(), named ? "numbers" : "names",
                                   named ? "names" : "numbers"));
  }

  bool next(Batch& batch) {
    batch.raw.assign(places, {});
    bool first = true;
    while (batch.raw.front().size() < batch_rows && stream_.next(chunk_)) {
      if (first) batch.first_row = chunk_.first_row;
      first = false;
      for (std::size_t c = 0; c < places; ++c) {
        auto& column = batch.raw[c];
        column.insert(column.end(), chunk_.columns[c].begin(), chunk_.columns[c].end());
      }
    }
    if (stream_.has_words() && (!names_ || names_->size() != stream_.words().size()))
      names_ = std::make_shared<const std::vector<std::string>>(stream_.words());
    batch.names = names_;
    return !first;
  }

  /// Into SI, checked.
  void convert(Batch& batch) const {
    const Index n = std::ssize(batch.raw.front());
    const auto si = [&](int c) {
      const Unit& unit = columns_[static_cast<std::size_t>(c)].unit;
      const auto& raw = batch.raw[static_cast<std::size_t>(c)];
      ArrayXd values = unit.offset + unit.scale * Eigen::Map<const ArrayXd>(raw.data(), n);
      if (c == temperature) {
        if (!values.allFinite()) refuse(batch, c, values, "must be a finite number");
        if (!(values >= 0).all()) refuse(batch, c, values, "is below absolute zero");
        values -= celsius_zero;
      } else if (!(values > 0).all() || !values.allFinite()) {
        refuse(batch, c, values, "must be a positive number");
      }
      return values;
    };
    const auto whole = [&](int c) {
      auto raw = batch.raw[static_cast<std::size_t>(c)];
      const double most = c == plate ? 2e9 : 9e15;
      for (std::size_t i = 0; i < raw.size(); ++i) {
        raw[i] *= columns_[static_cast<std::size_t>(c)].unit.scale;
        if (!(raw[i] >= 1 && raw[i] <= most) || raw[i] != std::trunc(raw[i]))
          throw InputError(
              fmt::format("{}, row {}, column '{}': {} must be a whole number of at "
                          "least 1",
                          stream_.source(), batch.first_row + i + 1,
                          columns_[static_cast<std::size_t>(c)].column, raw[i]));
      }
      return raw;
    };
    batch.cycles.plate = whole(plate);
    batch.cycles.number = whole(number);
    batch.cycles.slip_speed = si(slip_speed);
    batch.cycles.torque = si(torque);
    batch.cycles.temperature = si(temperature);
    batch.cycles.closing_time = si(closing_time);
    batch.cycles.energy = si(energy);
  }

  const std::string& source() const { return stream_.source(); }

 private:
  [[noreturn]] void refuse(const Batch& batch, int c, const ArrayXd& values,
                           const char* allowed) const {
    Index i = 0;
    while (std::isfinite(values[i]) && (c == temperature ? values[i] >= 0 : values[i] > 0)) ++i;
    const double raw = batch.raw[static_cast<std::size_t>(c)][static_cast<std::size_t>(i)];
    throw InputError(fmt::format("{}, row {}, column '{}': {} {}", stream_.source(),
                                 batch.first_row + static_cast<std::size_t>(i) + 1,
                                 columns_[static_cast<std::size_t>(c)].column,
                                 std::isnan(raw) ? "no value;" : fmt::format("{}", raw), allowed));
  }

  ColumnStream stream_;
  std::vector<ColumnChoice> columns_;
  ColumnStream::Batch chunk_;
  std::shared_ptr<const std::vector<std::string>> names_;
};

std::string trace_lines(std::size_t every, const Batch& batch, const CycleSum::Trace& trace) {
  std::string text;
  const auto end = std::back_inserter(text);
  for (std::size_t i = 0; i < trace.volume.size(); ++i) {
    if ((batch.first_row + i + 1) % every != 0) continue;
    const unsigned bits = batch.rates.outside[i];
    const std::string flags =
        trace.skipped[i] ? "skipped"
                         : names_of_inputs(bits) + (bits & CycleSum::negative ? " negative" : "");
    const std::string plate =
        batch.names ? printable_csv_cell(
                          (*batch.names)[static_cast<std::size_t>(batch.cycles.plate[i]) - 1])
                    : fmt::format("{}", batch.cycles.plate[i]);
    fmt::format_to(end, "{},{},{:.9g}", plate, batch.cycles.number[i], trace.volume[i] / mm3);
    const auto interval = [&](double sd) {
      fmt::format_to(end, ",{:.9g},{:.9g},{:.9g}", sd / mm3, (trace.volume[i] - 2 * sd) / mm3,
                     (trace.volume[i] + 2 * sd) / mm3);
    };
    interval(trace.sd[i]);
    if (!trace.full_sd.empty()) interval(trace.full_sd[i]);
    fmt::format_to(end, ",{}\n", flags);
  }
  return text;
}

}  // namespace

CycleColumns columns_of(const std::vector<Cycle>& cycles, std::size_t first, std::size_t last) {
  CycleColumns columns;
  const Index n = static_cast<Index>(last - first);
  for (ArrayXd* each : {&columns.slip_speed, &columns.torque, &columns.temperature,
                        &columns.closing_time, &columns.energy})
    each->resize(n);
  for (std::size_t i = first; i < last; ++i) {
    const Index at = static_cast<Index>(i - first);
    columns.plate.push_back(cycles[i].plate);
    columns.number.push_back(static_cast<double>(cycles[i].number));
    columns.slip_speed[at] = cycles[i].at.slip_speed;
    columns.torque[at] = cycles[i].at.torque;
    columns.temperature[at] = cycles[i].at.temperature;
    columns.closing_time[at] = cycles[i].at.closing_time;
    columns.energy[at] = cycles[i].energy;
  }
  return columns;
}

std::size_t sum_cycles(const std::filesystem::path& file, CycleSum& sum,
                       const std::function<void(std::string_view)>& trace, std::size_t every,
                       int threads) {
  Reader reader(file, sum.plates());
  std::size_t rows = 0;
  if (trace) {
    trace(fmt::format(
        "plate,cycle,volume [mm^3],sd_scatter [mm^3],scatter_low [mm^3],"
        "scatter_high [mm^3]{},outside\n",
        sum.with_replicates() ? ",sd_full [mm^3],full_low [mm^3],full_high [mm^3]" : ""));
  }
  // Owned here: oneTBB does not free its items if a stage throws. Batches leave in their original
  // order, so that the slot of the next one is free.
  std::vector<Batch> batches(batches_in_flight);
  std::size_t read_so_far = 0;
  const auto read = [&](tbb::flow_control& control) -> Batch* {
    Batch* batch = &batches[read_so_far++ % batches_in_flight];
    if (reader.next(*batch)) return batch;
    control.stop();
    return nullptr;
  };
  const auto evaluate = [&](Batch* batch) {
    reader.convert(*batch);
    sum.rates(batch->cycles, batch->rates);
    return batch;
  };
  std::shared_ptr<const std::vector<std::string>> named;
  const auto add = [&](const Batch* batch) {
    CycleSum::Trace steps;
    if (batch->names && batch->names != named) sum.name_plates(*batch->names);
    named = batch->names;
    try {
      sum.add(batch->cycles, batch->rates, batch->first_row, trace ? &steps : nullptr);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}, {}", reader.source(), error.what()));
    }
    if (trace) trace(trace_lines(every, *batch, steps));
    rows += static_cast<std::size_t>(batch->cycles.size());
  };
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_pipeline(
        batches_in_flight,
        tbb::make_filter<void, Batch*>(tbb::filter_mode::serial_in_order, read) &
            tbb::make_filter<Batch*, Batch*>(tbb::filter_mode::parallel, evaluate) &
            tbb::make_filter<Batch*, void>(tbb::filter_mode::serial_in_order, add));
  });
  if (rows == 0) throw InputError(fmt::format("{} has no rows", reader.source()));
  return rows;
}

}  // namespace wearwell::clutch
