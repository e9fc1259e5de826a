#include "fuzz/targets.h"

#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "fuzz/monitor_targets.h"
#include "fuzz/state_targets.h"
#include "wearwell/base/error.h"
#include "wearwell/base/unit.h"
#include "wearwell/formula/program.h"
#include "wearwell/input/labelled.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/bearing/uncertain.h"
#include "wearwell/models/clutch/clutch_model_file.h"
#include "wearwell/models/registry.h"
#include "wearwell/study/saved_result.h"

namespace wearwell::fuzz {
namespace {

namespace fs = std::filesystem;

// In memory, one for each process, removed at its end.
const fs::path& scratch() {
  struct Folder {
    fs::path path;
    Folder() {
      const bool shared_memory = fs::is_directory("/dev/shm");
      std::string pattern = ((shared_memory ? fs::path("/dev/shm") : fs::temp_directory_path()) /
                             "wearwell-fuzz-XXXXXX")
                                .string();
      if (!mkdtemp(pattern.data())) throw std::runtime_error("cannot make a folder");
      path = pattern;
    }
    ~Folder() {
      std::error_code ignored;
      fs::remove_all(path, ignored);
    }
  };
  static const Folder folder;
  return folder.path;
}

fs::path file_of(const char* name, std::string_view bytes) {
  const fs::path file = scratch() / name;
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file;
}

void demand(bool kept, const char* promise) {
  if (!kept) throw std::logic_error(promise);
}

template <class F>
void read_or_refuse(const F& read) {
  try {
    read();
  } catch (const InputError& refused) {
    demand(*refused.what() != '\0', "a refusal says why");
  }
}

constexpr const char* si_units[] = {"1", "m", "m^3/(N m)", "N m", "rad/s", "K", "log10(Pa)", "s"};

void unit(std::string_view bytes) {
  for (const char* si : si_units) {
    read_or_refuse([&] {
      const Unit unit = read_unit(bytes, si);
      demand(std::isfinite(unit.scale) && unit.scale != 0, "a unit has a finite scale");
      demand(std::isfinite(unit.offset), "a unit has a finite offset");
      demand(to_si(unit, 2) != to_si(unit, 1), "a unit tells one from two");
    });
    read_or_refuse([&] {
      const Quantity quantity = read_quantity(bytes, si);
      demand(std::isfinite(quantity.value), "a quantity is finite");
    });
    read_or_refuse([&] { read_uncertain(std::string(bytes), si); });
  }
}

// The first line names the column, the others are headings.
void heading(std::string_view bytes) {
  std::vector<std::string> headings;
  for (std::size_t from = 0; from <= bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', from), bytes.size());
    headings.emplace_back(bytes.substr(from, end - from));
    from = end + 1;
  }
  if (headings.size() < 2) return;
  const std::string name = headings.front();
  headings.erase(headings.begin());
  for (const char* si : si_units) {
    read_or_refuse([&] {
      const Unit found = find_labelled(headings, name, si, "a table").unit;
      demand(std::isfinite(found.scale) && found.scale != 0, "a unit has a finite scale");
    });
  }
}

void walk(const TomlReader& table) {
  for (const std::string& key : table.keys()) {
    read_or_refuse([&] { table.text(key); });
    read_or_refuse([&] { table.texts(key); });
    read_or_refuse([&] { table.quantities(key, "m"); });
    read_or_refuse([&] { table.integer(key, 0, 10); });
    read_or_refuse([&] {
      if (const auto child = table.table(key)) walk(*child);
    });
  }
}

void toml(std::string_view bytes) {
  const fs::path file = file_of("study.toml", bytes);
  read_or_refuse([&] { walk(TomlReader::parse_file(file)); });
}

void table(std::string_view bytes) {
  const fs::path file = file_of("data.csv", bytes);
  read_or_refuse([&] {
    const Table read = read_table(file);
    demand(read.rows > 0, "a table has rows");
    for (const Column& column : read.columns) {
      demand((column.is_number ? column.numbers.size() : column.text.size()) == read.rows,
             "a column is as long as its table");
    }
  });
}

void study(std::string_view bytes) {
  static const bool copied = [] {
    const fs::path examples = PROJECT_SOURCE_DIR "/examples";
    for (const char* data :
         {"joint/joint_wear.csv", "bearing/inspections.csv", "spring/spring_life.csv"}) {
      fs::copy_file(examples / data, scratch() / fs::path(data).filename());
    }
    return true;
  }();
  static_cast<void>(copied);
  const fs::path file = file_of("study.toml", bytes);
  read_or_refuse([&] {
    demand(!read_study(source_of(file), all_models())->description().empty(), "a study has words");
  });
}

void model(std::string_view bytes) {
  const fs::path file = file_of("model.json", bytes);
  read_or_refuse([&] { clutch::read_model(file); });
}

void state(std::string_view bytes) {
  const fs::path file = file_of("state.json", bytes);
  read_or_refuse([&] {
    for (const auto& plate : clutch::read_state(file, "fingerprint", 2)) {
      demand(std::isfinite(plate.volume), "a state is finite");
    }
  });
}

// Results as `wearwell report` reads them, a chain of two draws beside them; what was read must draw.
void result(const char* name, std::string_view bytes) {
  static const bool complete = [] {
    const fs::path seeds = PROJECT_SOURCE_DIR "/tests/fuzz/corpus";
    fs::copy_file(seeds / "summary/joint_lognormal_flat.json", scratch() / "summary.json");
    fs::copy_file(seeds / "report/joint_lognormal_flat.json", scratch() / "report.json");
    file_of("draws_1.csv", "lp__,k,sigma\n-1,1e-3,2\n-2,2e-3,3\n");
    return true;
  }();
  static_cast<void>(complete);
  file_of(name, bytes);
  read_or_refuse([&] {
    read_saved_result(scratch());
    const SavedReport read = read_saved_report(scratch());
    report_html(read.header, read.sections);
  });
}
void summary(std::string_view bytes) {
  result("summary.json", bytes);
}
void report(std::string_view bytes) {
  result("report.json", bytes);
}

// Lines "name := expression" are of [formula], any other is an output.
void laws(std::string_view bytes) {
  const formula::Powers metre = {{"meter", 1}}, newton = formula::read_any_unit("N").powers;
  const formula::Symbols symbols = {
      {{"x", {}}, {"force", newton}, {"distance", metre}, {"depth", metre, true}},
      {{"material", {"PTFE", "PEEK"}}},
      {{"a", {}},
       {"b", {}},
       {"q", {}, formula::Scope::per_level, "material"},
       {"u", {}, formula::Scope::per_row}},
      {{"g", formula::read_any_unit("m/s^2").powers, 9.81}}};
  std::vector<formula::Line> lines;
  std::vector<formula::Wanted> wanted;
  for (std::size_t from = 0; from < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', from), bytes.size());
    const std::string line(bytes.substr(from, end - from));
    from = end + 1;
    if (const std::size_t at = line.find(" := "); at != line.npos)
      lines.push_back({line.substr(0, at), line.substr(at + 4)});
    else
      wanted.push_back({"output", line});
  }
  read_or_refuse([&] {
    const formula::Program program = formula::compile(lines, wanted, symbols);
    const std::vector<double> x = {0.5, 2, -1}, force = {10, 20, 5}, distance = {0, 1, 1},
                              u = {1, 0, -1};
    const std::vector<int> material = {0, 1, 0};
    const formula::Data data =
        program.bind({3, {x, force, distance, std::span<const double>()}, {material}, {0}});
    formula::Workspace work = program.workspace(3);
    const std::vector<double> parameters = {0.7, 1.3, 2, -0.5};
    const double* by_row[] = {u.data()};
    program.forward(data, 0, 3, {parameters, by_row}, work);
    bool finite = true;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      for (const double each : work.values(i)) finite = finite && std::isfinite(each);
      for (double& each : work.adjoints(i)) each = 1;
      demand(!program.text(i).empty(), "an output can be shown");
    }
    std::vector<double> gradient(4);
    program.reverse(data, 0, 3, {parameters, by_row}, work, gradient);
    const auto fault = program.first_fault(data, 0, 3, {parameters, by_row});
    demand(fault.has_value() != finite, "what is not finite has a first cause");
  });
}

constexpr Target all[] = {{"unit", unit},     {"heading", heading}, {"toml", toml},
                          {"table", table},   {"study", study},     {"model", model},
                          {"state", state},   {"summary", summary}, {"report", report},
                          {"formula", laws},  {"carried", carried}, {"tracked", tracked},
                          {"events", events}, {"influx", influx},   {"opc_ua", opc_ua}};

}  // namespace

std::span<const Target> targets() {
  return all;
}

}  // namespace wearwell::fuzz
