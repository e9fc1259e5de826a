#include "wearwell/prognosis/carry.h"

#include <fmt/format.h>

#include "wearwell/base/error.h"
#include "wearwell/infer/fit.h"
#include "wearwell/input/as_read.h"
#include "wearwell/input/fingerprint.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell::prognosis {
namespace {

using Eigen::Index;

constexpr std::string_view of_file = ".file";

TomlReader section_at(const TomlReader& root, const std::string& path) {
  if (path.empty()) return root;
  const std::size_t end = std::min(path.find('.'), path.size());
  return section_at(root.required_table(path.substr(0, end)),
                    path.substr(std::min(end + 1, path.size())));
}

// Paths of all sections with a file.
std::vector<std::string> paths_of(const TomlReader& root) {
  std::vector<std::string> paths;
  for (const TomlReader::Present& each : root.present()) {
    if (!each.is_table && !each.text.empty() && each.path.ends_with(of_file))
      paths.push_back(each.path.substr(0, each.path.size() - of_file.size()));
  }
  return paths;
}

TableSection described(const TomlReader& section, const std::string& path) {
  return {path, section.required_text("file"), section.text("sql"), as_read_name(section),
          before_sql_name(section)};
}

// The path and the lines of a file are not valid where the state is read.
Table kept_table(Table table, const std::string& source) {
  table.source = source;
  table.lines.clear();
  return table;
}

Table before_sql(const TomlReader& section, const TableSection& about, const Source& source) {
  const auto found = source.tables.find(about.before_sql);
  if (found != source.tables.end()) return found->second;
  return wearwell::read_table(required_file(section, "file", source.folder()), {}, {},
                              read_table_settings(section));
}

// Rows `chosen` of a matrix.
Points rows_of(const Points& all, const std::vector<Index>& chosen) {
  Points some(static_cast<Index>(chosen.size()), all.cols());
  for (std::size_t i = 0; i < chosen.size(); ++i)
    some.row(static_cast<Index>(i)) = all.row(chosen[i]);
  return some;
}

WeightedDraws without_negligible(const WeightedDraws& draws) {
  constexpr double negligible = 1e-9;
  constexpr std::size_t most_cells = 20'000;
  const double least = negligible / static_cast<double>(draws.values.rows());
  std::vector<Index> chosen;
  for (Index i = 0; i < draws.values.rows(); ++i) {
    if (draws.weights[i] > least || draws.cell_weight(i) > least) chosen.push_back(i);
  }
  const bool all = static_cast<Index>(chosen.size()) == draws.values.rows();
  if (draws.lower.empty()) return draws;
  // Cells that represent nodes beside them are useless once the nodes are reweighted.
  const bool with_cells =
      chosen.size() <= most_cells && draws.lower.front().rows() == draws.values.rows();
  if (all && with_cells) return draws;
  WeightedDraws kept;
  kept.values = rows_of(draws.values, chosen);
  kept.weights = rows_of(draws.weights, chosen).col(0);
  kept.weights /= kept.weights.sum();
  if (!with_cells) return kept;
  for (const Points& each : draws.lower) kept.lower.push_back(rows_of(each, chosen));
  for (const Points& each : draws.upper) kept.upper.push_back(rows_of(each, chosen));
  if (!draws.has_cells()) return kept;
  kept.cells = {rows_of(draws.cells.mass, chosen).col(0), rows_of(draws.cells.node, chosen),
                rows_of(draws.cells.mean, chosen), rows_of(draws.cells.square, chosen)};
  kept.cells.mass /= kept.cells.mass.sum();
  return kept;
}

}  // namespace

std::vector<TableSection> table_sections(const TextFile& study) {
  const TomlReader root = TomlReader::parse(study);
  std::vector<TableSection> sections;
  for (const std::string& path : paths_of(root))
    sections.push_back(described(section_at(root, path), path));
  return sections;
}

Source carried_source(const Source& source, const PosteriorStudy& study) {
  Source kept{{source.study.path.filename(), source.study.text}};
  const TomlReader root = TomlReader::parse(source.study);
  for (const std::string& path : paths_of(root)) {
    const TomlReader section = section_at(root, path);
    const TableSection about = described(section, path);
    const std::string name = about.file + (about.sql ? " (through sql)" : "");
    kept.tables[about.as_read] = kept_table(wearwell::read_table(section, source), name);
    // No rows can be added to a triangle, so the rows before its sql are not needed; they may be many.
    if (about.sql && !section.has("returns"))
      kept.tables[about.before_sql] = kept_table(before_sql(section, about, source), about.file);
  }
  const auto file = source.folder() / study.data_file;
  if (!study.data_sha1.empty() && sha1(file) != study.data_sha1)
    throw InputError(
        fmt::format("{} changed while it was read: run the command again", file.string()));
  return kept;
}

CarriedState state_of_result(Source source, const Result& result) {
  const PosteriorSummary& posterior = *result.posterior;
  CarriedState state{result.header.model, result.header.trusted, std::move(source), {}, {}};
  for (const ParameterSummary& each : posterior.parameters) state.parameters.push_back(each.name);
  const Fit& fit = *posterior.fit;
  state.posterior = without_negligible(fit.exact ? fit.exact->nodes : fit.pooled);
  return state;
}

}  // namespace wearwell::prognosis
