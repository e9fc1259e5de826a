#include "wearwell/monitor/message.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/trimmed.h"

namespace wearwell::monitor {
namespace {

using Json = nlohmann::json;

std::string in_quotes(std::string_view text) {
  return fmt::format("'{}'", printable(shortened(text)));
}

/// Collects the fields of one object while parsing, without a tree.
class FieldReader : public nlohmann::json_sax<Json> {
 public:
  Fields fields;

  bool null() override { return put(Field::Kind::null); }
  bool boolean(bool) override { return put(Field::Kind::flag); }
  bool number_integer(Json::number_integer_t value) override {
    return put_number(static_cast<double>(value), value, true);
  }
  bool number_unsigned(Json::number_unsigned_t value) override {
    const bool fits = value <= static_cast<std::uint64_t>(INT64_MAX);
    return put_number(static_cast<double>(value), fits ? static_cast<std::int64_t>(value) : 0,
                      fits);
  }
  bool number_float(Json::number_float_t value, const Json::string_t&) override {
    constexpr double exact = 9007199254740992.0;  // 2^53
    const bool whole = value == std::floor(value) && std::abs(value) <= exact;
    return put_number(value, whole ? static_cast<std::int64_t>(value) : 0, whole);
  }
  bool string(Json::string_t& value) override {
    if (!put(Field::Kind::text)) return false;
    if (lists_ == 0) fields.back().text = std::move(value);
    return true;
  }
  bool binary(Json::binary_t&) override { return false; }

  bool start_object(std::size_t) override {
    deeper();
    if (lists_ == 0 && depth_ > 1) path_.push_back(path_.back() + "/" + key_);
    if (lists_ == 0 && depth_ == 1) path_.push_back("");
    return true;
  }
  bool end_object() override {
    if (lists_ == 0) path_.pop_back();
    --depth_;
    return true;
  }
  bool key(Json::string_t& name) override {
    if (lists_ == 0) key_ = std::move(name);
    return true;
  }
  bool start_array(std::size_t) override {
    if (depth_ == 0) throw InputError("is a list, not an object");
    deeper();
    if (lists_++ == 0) return put_named(Field::Kind::list);
    return true;
  }
  bool end_array() override {
    --lists_;
    --depth_;
    return true;
  }
  bool parse_error(std::size_t position, const std::string&,
                   const Json::exception& error) override {
    // A number out of range is reported as another kind of error.
    throw InputError(error.id == 406 ? std::string("has a number that is too large")
                                     : fmt::format("is not JSON, from byte {} on", position));
  }

 private:
  void deeper() {
    if (++depth_ > deepest_message)
      throw InputError(fmt::format("is nested more than {} deep", deepest_message));
  }
  bool put(Field::Kind kind) {
    if (depth_ == 0) throw InputError("is not an object");
    return lists_ > 0 || put_named(kind);
  }
  bool put_named(Field::Kind kind) {
    const std::string name = path_.size() == 1 ? key_ : path_.back() + "/" + key_;
    if (find_field(fields, name)) throw InputError(fmt::format("has {} twice", in_quotes(name)));
    if (fields.size() == most_fields)
      throw InputError(fmt::format("has more than {} fields", most_fields));
    fields.push_back({name, kind});
    return true;
  }
  bool put_number(double value, std::int64_t integer, bool whole) {
    put(Field::Kind::number);
    if (lists_ > 0) return true;
    fields.back().number = value;
    fields.back().integer = integer;
    fields.back().whole = whole;
    return true;
  }

  std::vector<std::string> path_;
  std::string key_;
  std::size_t depth_ = 0, lists_ = 0;
};

/// The value of a cell: a number if all of it is one, nothing if it is empty.
Field field_of_cell(const std::string& name, std::string_view cell) {
  Field field{name};
  const std::string_view value = trimmed(cell);
  if (value.empty()) return field;
  const char* end = value.data() + value.size();
  const auto [rest, error] = std::from_chars(value.data(), end, field.number);
  if (error == std::errc() && rest == end && std::isfinite(field.number)) {
    field.kind = Field::Kind::number;
    const auto [last, fault] = std::from_chars(value.data(), end, field.integer);
    field.whole = fault == std::errc() && last == end;
  } else {
    field.kind = Field::Kind::text;
  }
  field.text = value;
  return field;
}

void for_each_line(std::string_view text, const std::function<void(std::string_view)>& visit) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    if (!line.empty()) visit(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

void read_csv(std::string_view payload, const std::function<void(const Fields&)>& row,
              const std::function<void(const std::string&)>& bad) {
  std::vector<std::string> heading;
  Fields fields;
  for_each_line(payload, [&](std::string_view line) {
    if (line.size() > longest_row) return bad(fmt::format("a line of {} bytes", line.size()));
    std::vector<std::string> cells;
    try {
      cells = cells_of(line);
    } catch (const InputError& error) {
      if (heading.empty()) throw;
      return bad(error.what());  // the other lines are read
    }
    if (heading.empty()) {
      for (const std::string& cell : cells) heading.emplace_back(trimmed(cell));
      if (heading.size() > most_fields)
        throw InputError(fmt::format("has more than {} columns", most_fields));
      for (std::size_t i = 0; i < heading.size(); ++i) {
        if (std::find(heading.begin(), heading.begin() + i, heading[i]) != heading.begin() + i)
          throw InputError(fmt::format("has two columns {}", in_quotes(heading[i])));
      }
      return;
    }
    if (cells.size() != heading.size())
      return bad(fmt::format("line {} has {} cells, but the heading {}{}", in_quotes(line),
                             cells.size(), heading.size(), separator_problem(line)));
    fields.clear();
    for (std::size_t i = 0; i < cells.size(); ++i)
      fields.push_back(field_of_cell(heading[i], cells[i]));
    row(fields);
  });
}

}  // namespace

std::string separator_problem(std::string_view line) {
  return line.find(';') == line.npos && line.find('\t') == line.npos
             ? ""
             : "; cells of messages are separated by commas, and decimals by points";
}

const Field* find_field(const Fields& fields, std::string_view name) {
  for (const Field& field : fields) {
    if (field.name == name) return &field;
  }
  return nullptr;
}

Fields fields_of_json(std::string_view text) {
  FieldReader reader;
  if (!Json::sax_parse(text.begin(), text.end(), &reader)) throw InputError("is not JSON");
  return std::move(reader.fields);
}

std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells(1);
  bool quoted = false, closed = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted && c == '"') {
      const bool doubled = i + 1 < line.size() && line[i + 1] == '"';
      if (doubled) cells.back() += line[++i];
      quoted = doubled;
      closed = !doubled;
    } else if (quoted) {
      cells.back() += c;
    } else if (c == ',') {
      cells.emplace_back();
      closed = false;
    } else if (closed) {
      // "2"5 would be one number, and neither 2 nor 25.
      if (!trimmed({&c, 1}).empty())
        throw InputError(fmt::format("line {} has a cell that goes on behind its closing quote",
                                     in_quotes(line)));
    } else if (c == '"' && trimmed(cells.back()).empty()) {
      cells.back().clear();
      quoted = true;
    } else {
      cells.back() += c;
    }
  }
  if (quoted) throw InputError(fmt::format("line {} has an unclosed quote", in_quotes(line)));
  return cells;
}

void for_each_row(std::string_view payload, const std::function<void(const Fields&)>& row,
                  const std::function<void(const std::string&)>& bad, Form form) {
  const auto guarded = [&](const std::function<void()>& read) {
    try {
      read();
    } catch (const InputError& error) {
      bad(error.what());
    }
  };
  if (payload.size() > longest_message)
    return bad(fmt::format("has {} bytes; the limit is {}", payload.size(), longest_message));
  const std::string_view text = trimmed(payload);
  if (text.empty()) return bad("is empty");
  const bool stream = form == Form::json_lines;
  if (!stream && text.front() != '{' && text.front() != '[')
    return guarded([&] { read_csv(text, row, bad); });
  const auto read_object = [&](std::string_view object) {
    guarded([&] {
      if (object.size() > longest_row)
        throw InputError(fmt::format("has {} bytes; the limit is {}", object.size(), longest_row));
      row(fields_of_json(object));
    });
  };
  // One object over many lines, or one per line: the first line decides. In a stream it may be half
  // a line, which does not affect the others.
  const std::string_view first = trimmed(text.substr(0, text.find('\n')));
  const bool lines = first.size() == text.size() || first.back() == '}';
  if (!lines && (!stream || Json::accept(text))) return read_object(text);
  for_each_line(text, read_object);
}

}  // namespace wearwell::monitor
