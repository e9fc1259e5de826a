#include "wearwell/selection/data.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/input/fingerprint.h"
#include "wearwell/input/table.h"
#include "wearwell/regress/search_problem.h"

namespace wearwell {
namespace {

constexpr int min_rows = 3;

Eigen::VectorXd read_numbers(const Table& table, const std::string& column) {
  const auto values = si_numbers(table, column, Unit{"1", 1, 0});
  const auto numbers =
      Eigen::VectorXd::Map(values.data(), static_cast<Eigen::Index>(values.size()));
  require_size(fmt::format("{}, column '{}'", table.source, column), numbers);
  return numbers;
}

/// A column that must vary between rows.
Eigen::VectorXd read_varied(const Table& table, const std::string& column) {
  const Eigen::VectorXd values = read_numbers(table, column);
  if ((values.array() == values[0]).all())
    throw InputError(fmt::format("{}, column '{}' is {} in every row: it has no information",
                                 table.source, column, values[0]));
  return values;
}

std::vector<std::string> factors_of(const std::string& name) {
  std::vector<std::string> factors;
  std::size_t from = 0;
  for (std::size_t at; (at = name.find('*', from)) != std::string::npos; from = at + 1)
    factors.push_back(name.substr(from, at - from));
  factors.push_back(name.substr(from));
  return factors;
}

bool has_column(const Table& table, const std::string& name) {
  return std::any_of(table.columns.begin(), table.columns.end(),
                     [&](const Column& column) { return column.name == name; });
}

void refuse_twice(const char* what, const std::vector<std::string>& names) {
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (std::find(names.begin(), name, *name) != name)
      throw InputError(fmt::format("{} '{}' is given twice", what, *name));
  }
}

/// The constant, and each of `names`: a column, or a product of columns. Appends columns that are
/// new to `inputs`.
std::vector<Term> terms_as_given(const Table& table, const std::vector<std::string>& names,
                                 std::vector<std::string>& inputs) {
  std::vector<Term> terms = {{{}, "1"}};
  for (const std::string& name : names) {
    if (name == "1") continue;
    Term term{{}, name};
    const auto factors = has_column(table, name) ? std::vector{name} : factors_of(name);
    for (const std::string& factor : factors) {
      static_cast<void>(table.column(factor));  // throws and names the nearest
      const auto known = std::find(inputs.begin(), inputs.end(), factor);
      term.factors.push_back(static_cast<int>(known - inputs.begin()));
      if (known == inputs.end()) inputs.push_back(factor);
    }
    std::sort(term.factors.begin(), term.factors.end());
    for (const Term& other : terms) {
      if (other.factors == term.factors)
        throw InputError(fmt::format("--terms: '{}' and '{}' are the same", other.name, name));
    }
    terms.push_back(term);
  }
  return terms;
}

/// A term by its name, with its inputs in any order.
int find_term(const std::vector<Term>& terms, const std::vector<std::string>& inputs,
              const std::string& name) {
  std::vector<int> factors;
  for (const std::string& factor : factors_of(name)) {
    const auto known = std::find(inputs.begin(), inputs.end(), factor);
    factors.push_back(static_cast<int>(known - inputs.begin()));
  }
  std::sort(factors.begin(), factors.end());
  std::vector<std::string> names;
  for (std::size_t t = 0; t < terms.size(); ++t) {
    if (terms[t].name == name || (name != "1" && terms[t].factors == factors))
      return static_cast<int>(t);
    names.push_back(terms[t].name);
  }
  throw InputError(fmt::format("--force: '{}' is not a candidate term (nearest: '{}')", name,
                               nearest_name(name, names)));
}

void check(const SelectData& data) {
  if (data.response.empty()) throw InputError("--response is missing: give the column to explain");
  if (data.inputs.empty() == data.terms.empty())
    throw InputError(
        data.inputs.empty()
            ? "--inputs (with --degree) or --terms is missing: give the columns that may explain it"
            : "--inputs and --terms are both given; give one or the other");
  if (!data.terms.empty() && data.degree)
    throw InputError("--degree applies to --inputs; remove it or use --inputs instead of --terms");
  if (data.degree.value_or(1) < 1)
    throw InputError(fmt::format("--degree is {}; it must be at least 1", *data.degree));
  refuse_twice("input", data.inputs);
  refuse_twice("term", data.terms);
  refuse_twice("forced term", data.forced);
}

}  // namespace

SelectionResult read_selection(const SelectData& data) {
  check(data);
  const ReadFile read(data.file);
  const Table table = [&] {
    try {
      return read_table(data.file, data.sql);
    } catch (const QueryError& error) {
      throw InputError(fmt::format("--sql: {}", error.what()));
    }
  }();
  std::string sha1 = read.sha1();
  SelectionResult result = read_selection(data, table);
  result.data_sha1 = std::move(sha1);
  result.sql = data.sql.value_or("");
  return result;
}

SelectionResult read_selection(const SelectData& data, const Table& table) {
  check(data);
  SelectionResult result;
  result.data_file = table.source;
  result.data_remarks = table.layout.remarks;
  result.response = data.response;
  result.weights_column = data.weights;
  result.inputs = data.inputs;
  const std::vector<Term> terms = data.terms.empty()
                                      ? polynomial_terms(data.inputs, data.degree.value_or(1))
                                      : terms_as_given(table, data.terms, result.inputs);
  if (terms.size() > most_search_terms)
    throw InputError(fmt::format(
        "{} makes {} terms; a search takes at most {}",
        data.terms.empty()
            ? fmt::format("--degree {} in {} inputs", data.degree.value_or(1), data.inputs.size())
            : "--terms",
        terms.size(), most_search_terms));
  for (const std::string& input : result.inputs) {
    if (input == data.response)
      throw InputError(fmt::format("'{}' is the response; it cannot be a term", input));
    if (input == data.weights)
      throw InputError(
          fmt::format("'{}' is the column of weights; it cannot be an input too", input));
  }
  if (table.rows < min_rows)
    throw InputError(fmt::format("{} has {} rows; a selection needs at least {}", table.source,
                                 table.rows, min_rows));
  if (data.weights == data.response)
    throw InputError(
        fmt::format("'{}' is the response; it cannot be the column of weights", data.response));

  result.observed = read_varied(table, data.response);
  result.input_values.resize(result.observed.size(),
                             static_cast<Eigen::Index>(result.inputs.size()));
  for (std::size_t i = 0; i < result.inputs.size(); ++i)
    result.input_values.col(static_cast<Eigen::Index>(i)) = read_varied(table, result.inputs[i]);
  result.design = make_design(terms, result.input_values);
  if (!data.weights.empty()) {
    result.weights = read_numbers(table, data.weights);
    for (Eigen::Index i = 0; i < result.weights.size(); ++i) {
      if (!(result.weights[i] > 0))
        throw InputError(fmt::format("{}: the weight is {}; it must be positive",
                                     place(table, data.weights, static_cast<std::size_t>(i)),
                                     result.weights[i]));
    }
  }
  for (const std::string& name : data.forced)
    result.settings.search.forced.push_back(find_term(terms, result.inputs, name));
  return result;
}

}  // namespace wearwell
