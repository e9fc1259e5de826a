#include "wearwell/prognosis/carried_state.h"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/sha1.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/bayes/log_density.h"
#include "wearwell/prognosis/bytes.h"
#include "wearwell/prognosis/packed.h"

namespace wearwell::prognosis {
namespace {

constexpr std::string_view magic("wearwell state\r\n", 16);  // a transfer in text mode corrupts it
constexpr std::uint32_t version = 1;
constexpr std::size_t head = 16 + 4 + 8, digest = 40;  // bytes

void write(const Column& column, ByteWriter& out) {
  out.text(column.name);
  out.text(column.unit);
  out.text(column.doubt);
  out.byte(column.marks.has_value());
  out.byte(column.marks ? static_cast<std::uint8_t>(column.marks->decimal) : 0);
  out.byte(column.marks ? static_cast<std::uint8_t>(column.marks->thousands) : 0);
  out.byte(column.is_number);
  for (const double each : column.numbers) {
    check_stop();
    out.number(each);
  }
  for (const std::string& each : column.text) {
    check_stop();
    out.text(each);
  }
}

Column read_column(std::size_t rows, ByteReader& in) {
  Column column;
  column.name = in.text();
  column.unit = in.text();
  column.doubt = in.text();
  const bool marked = in.flag();
  const char decimal = static_cast<char>(in.byte()), thousands = static_cast<char>(in.byte());
  if (marked) column.marks = NumberMarks{decimal, thousands};
  column.is_number = in.flag();
  in.require(rows, 8);
  for (std::size_t i = 0; i < rows; ++i) {
    if (column.is_number) {
      column.numbers.push_back(in.number());
    } else {
      column.text.push_back(in.text());
    }
  }
  return column;
}

void write(const Table& table, ByteWriter& out) {
  out.text(table.source);
  out.text(table.layout.text);
  out.u64(table.rows);
  out.u64(table.columns.size());
  for (const Column& column : table.columns) write(column, out);
}

Table read_table(ByteReader& in) {
  constexpr std::size_t least_column = 28;
  Table table;
  table.source = in.text();
  table.layout.text = in.text();
  table.rows = in.count(1);
  const std::size_t columns = in.count(least_column);
  for (std::size_t c = 0; c < columns; ++c) table.columns.push_back(read_column(table.rows, in));
  return table;
}

void write(const Points& points, ByteWriter& out) {
  for (Eigen::Index i = 0; i < points.size(); ++i) out.number(points.data()[i]);
}

Points read_points(std::size_t rows, std::size_t columns, ByteReader& in) {
  in.require(rows * columns, 8);
  Points points(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
  for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] = in.number();
  return points;
}

void write(const WeightedDraws& draws, ByteWriter& out) {
  out.u64(static_cast<std::uint64_t>(draws.values.rows()));
  const bool cells = !draws.lower.empty() && draws.lower.front().rows() == draws.values.rows();
  out.u64(cells ? draws.lower.size() : 0);
  out.byte(cells && draws.has_cells());
  write(draws.values, out);
  write(Points(draws.weights), out);
  if (!cells) return;
  for (const Points& each : draws.lower) write(each, out);
  for (const Points& each : draws.upper) write(each, out);
  if (!draws.has_cells()) return;
  write(Points(draws.cells.mass), out);
  for (const Points* each : {&draws.cells.node, &draws.cells.mean, &draws.cells.square})
    write(*each, out);
}

// A check of plausibility: without it a corrupt length would request any amount of memory.
Eigen::VectorXd read_weights(std::size_t rows, ByteReader& in) {
  const Points weights = read_points(rows, 1, in);
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    if (!(weights(i, 0) >= 0) || !std::isfinite(weights(i, 0)))
      in.fail(fmt::format("{} is not a weight", weights(i, 0)));
  }
  if (!(std::abs(weights.sum() - 1) < 1e-6)) in.fail("weights do not sum to 1");
  return weights.col(0);
}

WeightedDraws read_draws(std::size_t parameters, ByteReader& in) {
  WeightedDraws draws;
  const std::size_t rows = in.count(8 * (parameters + 1)), axes = in.u64();
  if (rows == 0) in.fail("the posterior has no points");
  if (axes != 0 && axes != parameters)
    in.fail(fmt::format("{} axes of cells for {} parameters", axes, parameters));
  const bool cells = in.flag();
  if (cells && axes == 0) in.fail("cells have no axes");
  draws.values = read_points(rows, parameters, in);
  draws.weights = read_weights(rows, in);
  for (std::vector<Points>* each : {&draws.lower, &draws.upper}) {
    for (std::size_t a = 0; a < axes; ++a) each->push_back(read_points(rows, parameters, in));
  }
  if (!cells) return draws;
  draws.cells.mass = read_weights(rows, in);
  for (Points* each : {&draws.cells.node, &draws.cells.mean, &draws.cells.square})
    *each = read_points(rows, axes, in);
  return draws;
}

std::string body_of(const CarriedState& state) {
  ByteWriter out;
  out.text(state.model);
  out.byte(state.trusted);
  out.text(state.source.study.path.string());
  out.text(state.source.study.text);
  out.u64(state.source.tables.size());
  for (const auto& [name, table] : state.source.tables) {
    out.text(name);
    write(table, out);
  }
  out.u64(state.parameters.size());
  for (const std::string& each : state.parameters) out.text(each);
  if (!state.parameters.empty()) write(state.posterior, out);
  return out.take();
}

CarriedState state_of(std::string_view body, const std::string& file) {
  constexpr std::size_t least_table = 40, least_text = 8;
  ByteReader in(body, file);
  CarriedState state;
  state.model = in.text();
  state.trusted = in.flag();
  state.source.study.path = in.text();
  state.source.study.text = in.text();
  const std::size_t tables = in.count(least_table);
  for (std::size_t t = 0; t < tables; ++t) {
    const std::string name = in.text();
    if (!state.source.tables.emplace(name, read_table(in)).second)
      in.fail(fmt::format("table '{}' occurs twice", printable(name)));
  }
  const std::size_t parameters = in.count(least_text);
  if (parameters > static_cast<std::size_t>(max_dimension))
    in.fail(fmt::format("{} parameters", parameters));
  for (std::size_t p = 0; p < parameters; ++p) state.parameters.push_back(in.text());
  if (parameters > 0) state.posterior = read_draws(parameters, in);
  in.end();
  return state;
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!stream || stream.bad())
    throw InputError(
        fmt::format("{} cannot be read: {}", valid_utf8(file.string()), std::strerror(errno)));
  return bytes;
}

}  // namespace

std::string state_bytes(const CarriedState& state) {
  const std::string body = body_of(state);
  ByteWriter out;
  for (const char each : magic) out.byte(static_cast<std::uint8_t>(each));
  out.u32(version);
  out.u64(body.size());
  std::string bytes = out.take() + packed(body);
  return bytes + sha1_of(bytes);
}

CarriedState state_of_bytes(std::string_view bytes, const std::string& name) {
  if (!bytes.starts_with(magic.substr(0, bytes.size())) || bytes.empty())
    throw InputError(fmt::format("{} is not a state written by wearwell", name));
  if (bytes.size() < head + digest) throw InputError(fmt::format("{} is truncated", name));
  ByteReader in(bytes.substr(magic.size()), name);
  const std::uint32_t written = in.u32();
  if (written != version)
    throw InputError(
        fmt::format("{} has version {}; this wearwell reads version {}: fit the study again", name,
                    written, version));
  const std::uint64_t size = in.u64();
  const std::string_view signed_part = bytes.substr(0, bytes.size() - digest);
  if (sha1_of(signed_part) != bytes.substr(bytes.size() - digest))
    throw InputError(fmt::format("{} is truncated or damaged: its checksum does not match", name));
  return state_of(unpacked(signed_part.substr(head), size, name), name);
}

std::string fingerprint_of(const CarriedState& state) {
  return sha1_of(body_of(state));
}

std::string population_fingerprint(const CarriedState& state) {
  std::string print = state.source.study.text;
  const auto add = [&](const double* values, Eigen::Index count) {
    print.append(reinterpret_cast<const char*>(values),
                 static_cast<std::size_t>(count) * sizeof(double));
  };
  add(state.posterior.values.data(), state.posterior.values.size());
  add(state.posterior.weights.data(), state.posterior.weights.size());
  return sha1_of(print);
}

void require_parameters(const CarriedState& state, const std::vector<std::string>& names) {
  if (names != state.parameters)
    throw InputError(fmt::format("{}: the saved posterior has other parameters",
                                 state.source.study.path.string()));
}

CarriedState read_state(const std::filesystem::path& result) {
  std::error_code error;
  const bool folder = std::filesystem::is_directory(result, error);
  const std::filesystem::path file = folder ? result / "state.bin" : result;
  if (!std::filesystem::exists(result, error))
    throw InputError(fmt::format("no such file or folder: {}", valid_utf8(result.string())));
  if (!std::filesystem::is_regular_file(file, error)) {
    throw InputError(folder ? fmt::format("{} has no state.bin: wearwell fit writes it for studies "
                                          "with a posterior (not for a clutch campaign)",
                                          valid_utf8(result.string()))
                            : fmt::format("{} is not a file", valid_utf8(result.string())));
  }
  return state_of_bytes(content_of(file), valid_utf8(file.string()));
}

}  // namespace wearwell::prognosis
