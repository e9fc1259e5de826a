#include "wearwell/formula/lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/trim.hpp>
#include <optional>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"

namespace wearwell::formula {
namespace {

std::string where(const std::string& name) {
  return fmt::format("[formula] {}", printable(shortened(name)));
}

std::string without_spaces(std::string text) {
  std::erase_if(text, [](char c) { return c == ' ' || c == '\t'; });
  return text;
}

struct RateName {
  std::string state, axis;
};

// "d(depth)/d(distance)".
std::optional<RateName> rate_name(const std::string& name) {
  const std::string text = without_spaces(name);
  const std::size_t middle = text.find(")/d(");
  if (!text.starts_with("d(") || middle == text.npos || text.back() != ')') return {};
  return RateName{text.substr(2, middle - 2), text.substr(middle + 4, text.size() - middle - 5)};
}

class Sorter {
 public:
  explicit Sorter(const Symbols& symbols) : symbols_(symbols) {}

  Lines run(const std::vector<Line>& law) {
    if (law.size() > 1000) throw InputError("[formula] has more than 1000 lines");
    for (const Line& line : law) {
      const Text text{where(line.name), line.text};
      const std::size_t bracket = line.name.find('(');
      if (const auto rate = rate_name(line.name))
        add_rate(*rate, text);
      else if (bracket != line.name.npos)
        add_beginning(line.name, bracket, text);
      else
        add_named(line.name, text);
    }
    if (lines_.has_beginning) check_beginning();
    if (!lines_.state.empty()) check_state();
    return std::move(lines_);
  }

 private:
  template <class List>
  static const typename List::value_type* find(const List& list, const std::string& name) {
    const auto at =
        std::find_if(list.begin(), list.end(), [&](const auto& each) { return each.name == name; });
    return at == list.end() ? nullptr : &*at;
  }

  // The existing meaning of a name.
  const char* taken(const std::string& name) const {
    if (find(symbols_.columns, name)) return "column";
    if (find(symbols_.labels, name)) return "label";
    if (find(symbols_.parameters, name)) return "parameter";
    if (find(symbols_.constants, name)) return "constant";
    return nullptr;
  }

  void add_named(const std::string& name, const Text& text) {
    check_name(name, "line of [formula]");
    if (const char* what = taken(name)) {
      throw InputError(fmt::format(
          "'{}' is the name of a {} and of a line of [formula]; give one of them another name",
          name, what));
    }
    if (find(lines_.named, name))
      throw InputError(fmt::format("[formula] has two lines '{}'", name));
    lines_.named.push_back({name, text, tokens_of(text)});
  }

  void add_rate(const RateName& rate, const Text& text) {
    if (!lines_.state.empty()) {
      throw InputError(fmt::format("{}: '{}' is already a state; a study can have only one",
                                   text.where, lines_.state));
    }
    check_name(rate.state, "state");
    lines_.state = rate.state;
    lines_.rate = {rate.state, text, tokens_of(text)};
    const ColumnSymbol* axis = find(symbols_.columns, rate.axis);
    if (axis == nullptr) {
      std::vector<std::string> names;
      for (const ColumnSymbol& each : symbols_.columns) names.push_back(each.name);
      throw InputError(fmt::format(
          "{}: a state needs a column as its axis, but '{}' is not a column{}", text.where,
          printable(shortened(rate.axis)),
          names.empty()
              ? ""
              : fmt::format("; did you mean '{}'?", nearest_name(shortened(rate.axis), names))));
    }
    if (axis->measured)
      throw InputError(fmt::format(
          "{}: '{}' is the measured response; the axis of a state must be a known column",
          text.where, rate.axis));
    lines_.start.axis = static_cast<int>(axis - symbols_.columns.data());
  }

  // "depth(0)", "depth(first)", "depth(2 km)".
  void add_beginning(const std::string& name, std::size_t bracket, const Text& text) {
    if (lines_.has_beginning)
      throw InputError(fmt::format("{}: define the beginning of a state only once", text.where));
    lines_.has_beginning = true;
    if (name.back() != ')')
      throw InputError(fmt::format(
          "{}: neither a name, nor a rate \"d(x)/d(y)\", nor the beginning of a state \"x(0)\"",
          text.where));
    lines_.beginning = {boost::algorithm::trim_copy(name.substr(0, bracket)), text,
                        tokens_of(text)};
    check_name(lines_.beginning.name, "state");
    place_ = boost::algorithm::trim_copy(name.substr(bracket + 1, name.size() - bracket - 2));
  }

  void check_beginning() {
    const Text& text = lines_.beginning.text;
    if (lines_.state != lines_.beginning.name) {
      throw InputError(
          lines_.state.empty()
              ? fmt::format(
                    "{}: a beginning without a state; add its rate as a line \"d({})/d(...)\"",
                    text.where, printable(shortened(lines_.beginning.name)))
              : fmt::format("{}: the state is '{}'", text.where, lines_.state));
    }
    if (place_ == "first") {
      lines_.start.at_first_row = true;
      return;
    }
    const ColumnSymbol& axis = symbols_.columns[static_cast<std::size_t>(lines_.start.axis)];
    try {
      const AnyQuantity place = read_any_quantity(place_);
      lines_.start.at = place.quantity.si();
      if (place.quantity.value != 0 || place.quantity.unit.text != "1") {
        if (place.powers != axis.powers)
          throw InputError(fmt::format("'{}' is {}, but '{}' is {}", place_,
                                       description(place.powers), axis.name,
                                       description(axis.powers)));
      }
    } catch (const InputError& error) {
      throw InputError(
          fmt::format("{}: the beginning of the state is unclear: {}; write {}(0), {}(first) or a "
                      "value of '{}' with its unit",
                      text.where, error.what(), lines_.state, lines_.state, axis.name));
    }
  }

  void check_state() const {
    const ColumnSymbol* column = find(symbols_.columns, lines_.state);
    const char* what = taken(lines_.state);
    if (find(lines_.named, lines_.state)) what = "line of [formula]";
    if (what == nullptr || (column != nullptr && column->measured)) return;
    throw InputError(
        fmt::format("'{}' is the name of a {} and of a state; give one of them another "
                    "name",
                    lines_.state, what));
  }

  const Symbols& symbols_;
  Lines lines_;
  std::string place_;
};

}  // namespace

Lines sort_lines(const std::vector<Line>& law, const Symbols& symbols) {
  return Sorter(symbols).run(law);
}

}  // namespace wearwell::formula
