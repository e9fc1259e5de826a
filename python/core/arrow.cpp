#include "arrow.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string_view>

#include "wearwell/base/error.h"

namespace wearwell::python {
namespace {

constexpr double empty = std::numeric_limits<double>::quiet_NaN();

// Releases what the producer handed over.
template <class T>
struct Owned {
  T value{};
  Owned() = default;
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  ~Owned() {
    if (value.release) value.release(&value);
  }
};

bool bit(const void* bits, std::int64_t i) {
  return static_cast<const std::uint8_t*>(bits)[i / 8] >> (i % 8) & 1;
}

bool is_null(const ArrowArray& array, std::int64_t i) {
  return array.null_count != 0 && array.n_buffers > 0 && array.buffers[0] &&
         !bit(array.buffers[0], i + array.offset);
}

// An IEEE number of 16 bits.
double half(std::uint16_t bits) {
  const double sign = bits >> 15 ? -1 : 1, fraction = bits & 0x3ff;
  const int exponent = bits >> 10 & 0x1f;
  if (exponent == 31) return fraction != 0 ? empty : sign * std::numeric_limits<double>::infinity();
  return sign *
         (exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25));
}

class ColumnReader {
 public:
  ColumnReader(const ArrowSchema& schema, const std::string& table)
      : schema_(schema), table_(table), kind_(schema.format) {
    column_.name = schema.name ? schema.name : "";
    const std::string_view values = schema.dictionary ? schema.dictionary->format : kind_;
    column_.is_number = !(values == "u" || values == "U");
    const bool known = values == "u" || values == "U" ||
                       (values.size() == 1 && values.find_first_of("nbcCsSiIlLefg") == 0);
    if (!known || (schema.dictionary && column_.is_number)) {
      throw InputError(
          fmt::format("{}, column '{}': Arrow's type '{}' is neither a number nor a text", table,
                      column_.name, values));
    }
  }

  // Rows begin at `first` within the batch's own offset.
  void add(const ArrowArray& array, std::int64_t first, std::int64_t rows) {
    for (std::int64_t i = first; i < first + rows; ++i) {
      if (column_.is_number) {
        column_.numbers.push_back(number(array, kind_, i));
      } else if (schema_.dictionary) {
        const double at = number(array, kind_, i);
        column_.text.push_back(std::isnan(at) ? std::string()
                                              : text(*array.dictionary, schema_.dictionary->format,
                                                     static_cast<std::int64_t>(at)));
      } else {
        column_.text.push_back(text(array, kind_, i));
      }
    }
  }

  Column take() { return std::move(column_); }
  bool has_truths() const { return kind_ == "b"; }

 private:
  template <class T>
  static T at(const ArrowArray& array, std::int64_t i) {
    return static_cast<const T*>(array.buffers[1])[i + array.offset];
  }

  double whole(double value) const {
    require_exact(value, table_, column_.name, column_.numbers.size());
    return value;
  }

  double number(const ArrowArray& array, std::string_view kind, std::int64_t i) const {
    if (kind == "n" || is_null(array, i)) return empty;
    switch (kind.front()) {
      case 'b':
        return bit(array.buffers[1], i + array.offset) ? 1 : 0;
      case 'c':
        return at<std::int8_t>(array, i);
      case 'C':
        return at<std::uint8_t>(array, i);
      case 's':
        return at<std::int16_t>(array, i);
      case 'S':
        return at<std::uint16_t>(array, i);
      case 'i':
        return at<std::int32_t>(array, i);
      case 'I':
        return at<std::uint32_t>(array, i);
      case 'l':
        return whole(static_cast<double>(at<std::int64_t>(array, i)));
      case 'L':
        return whole(static_cast<double>(at<std::uint64_t>(array, i)));
      case 'e':
        return half(at<std::uint16_t>(array, i));
      case 'f':
        return at<float>(array, i);
      default:
        return at<double>(array, i);
    }
  }

  template <class Offset>
  static std::string between(const ArrowArray& array, std::int64_t i) {
    const auto* ends = static_cast<const Offset*>(array.buffers[1]) + array.offset + i;
    return {static_cast<const char*>(array.buffers[2]) + ends[0],
            static_cast<std::size_t>(ends[1] - ends[0])};
  }

  static std::string text(const ArrowArray& array, std::string_view kind, std::int64_t i) {
    if (is_null(array, i)) return {};
    return kind == "u" ? between<std::int32_t>(array, i) : between<std::int64_t>(array, i);
  }

  const ArrowSchema& schema_;
  const std::string& table_;
  std::string_view kind_;
  Column column_;
};

}  // namespace

void require_exact(double magnitude, const std::string& table, const std::string& column,
                   std::size_t row) {
  constexpr double most = 0x1p53;
  if (std::abs(magnitude) <= most) return;
  throw InputError(fmt::format(
      "{}, row {}, column '{}': a whole number beyond 2^53 cannot be kept to its last digit", table,
      row + 1, column));
}

ArrowTable read_arrow(ArrowArrayStream& stream, const std::string& name) {
  struct Release {
    ArrowArrayStream& stream;
    ~Release() {
      if (stream.release) stream.release(&stream);
    }
  } const release{stream};
  const auto require = [&](int status, const char* what) {
    if (status == 0) return;
    const char* const why = stream.get_last_error ? stream.get_last_error(&stream) : nullptr;
    throw InputError(fmt::format("{}: Arrow gives no {}: {}", name, what,
                                 why ? std::string(why) : fmt::format("error {}", status)));
  };
  Owned<ArrowSchema> schema;
  require(stream.get_schema(&stream, &schema.value), "schema");
  if (std::string_view(schema.value.format) != "+s")
    throw InputError(fmt::format("{}: Arrow gives an array where a table is wanted", name));
  std::vector<ColumnReader> readers;
  for (std::int64_t c = 0; c < schema.value.n_children; ++c)
    readers.emplace_back(*schema.value.children[c], name);
  Table table;
  table.source = name;
  for (;;) {
    Owned<ArrowArray> batch;
    require(stream.get_next(&stream, &batch.value), "rows");
    if (!batch.value.release) break;  // the end
    for (std::size_t c = 0; c < readers.size(); ++c)
      readers[c].add(*batch.value.children[c], batch.value.offset, batch.value.length);
    table.rows += static_cast<std::size_t>(batch.value.length);
  }
  ArrowTable read;
  for (ColumnReader& each : readers) {
    table.columns.push_back(each.take());
    if (each.has_truths()) read.truths.push_back(table.columns.back().name);
  }
  read.table = std::move(table);
  return read;
}

}  // namespace wearwell::python
