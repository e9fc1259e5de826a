#include "arrow_export.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>

#include <cerrno>
#include <cstring>
#include <limits>
#include <memory>

#include "wearwell/base/error.h"

namespace wearwell::python {
namespace {

constexpr std::int64_t nullable = 2;  // ARROW_FLAG_NULLABLE

struct ExportedArray {
  std::string name, format, metadata;
  std::vector<std::uint8_t> valid, bits;
  std::vector<std::int32_t> ends;
  std::string text;
  PyObject* numbers = nullptr;  // whose memory is handed out
  std::int64_t nulls = 0;
  std::vector<const void*> buffers;
};

// What is handed out; it goes with the last who holds a part of it.
struct Content {
  std::vector<ExportedArray> columns;
  std::int64_t rows = 0;

  Content() = default;
  Content(const Content&) = delete;
  Content& operator=(const Content&) = delete;
  ~Content() {
    if (!Py_IsInitialized()) return;  // an interpreter that has ended has freed its own
    const py::gil_scoped_acquire acquire;
    for (const ExportedArray& each : columns) Py_XDECREF(each.numbers);
  }
};
using Shared = std::shared_ptr<const Content>;

// One pair, as the format writes them: counts and lengths as int32 of this machine.
std::string metadata_of(const std::string& key, const std::string& value) {
  std::string all;
  const auto number = [&](std::size_t n) {
    const auto value32 = static_cast<std::int32_t>(n);
    all.append(reinterpret_cast<const char*>(&value32), sizeof value32);
  };
  number(1);
  number(key.size());
  all += key;
  number(value.size());
  return all + value;
}

void set_bit(std::vector<std::uint8_t>& bits, std::size_t i) {
  bits[i / 8] = static_cast<std::uint8_t>(bits[i / 8] | 1U << (i % 8));
}

void add_numbers(ExportedArray& column, const py::array& values) {
  const char kind = values.dtype().kind();
  if (values.ndim() != 1)
    throw InputError(
        fmt::format("column '{}' has {} dimensions; a column has one", column.name, values.ndim()));
  if (kind == 'b') {
    const auto flags = py::array_t<bool, py::array::forcecast>::ensure(values);
    column.format = "b";
    column.bits.resize(static_cast<std::size_t>(flags.size() + 7) / 8);
    for (py::ssize_t i = 0; i < flags.size(); ++i)
      if (flags.at(i)) set_bit(column.bits, static_cast<std::size_t>(i));
    column.buffers = {nullptr, column.bits.data()};
    return;
  }
  py::object numbers;  // the same array where it is contiguous and of this type
  constexpr int plain = py::array::c_style | py::array::forcecast;
  if (kind == 'f') {
    column.format = "g";
    numbers = py::array_t<double, plain>::ensure(values);
  } else if (kind == 'i' || (kind == 'u' && values.dtype().itemsize() < 8)) {
    column.format = "l";
    numbers = py::array_t<std::int64_t, plain>::ensure(values);
  } else {
    throw InputError(fmt::format("column '{}' holds {}, which is neither numbers nor texts",
                                 column.name, std::string(py::str(values.dtype()))));
  }
  if (!numbers) throw py::error_already_set();
  column.buffers = {nullptr, py::reinterpret_borrow<py::array>(numbers).data()};
  column.numbers = numbers.release().ptr();
}

void add_text(ExportedArray& column, const py::sequence& values) {
  column.format = "u";
  const std::size_t rows = values.size();
  column.valid.resize((rows + 7) / 8);
  column.ends.push_back(0);
  for (std::size_t i = 0; i < rows; ++i) {
    const py::object each = values[i];
    if (each.is_none()) {
      ++column.nulls;
    } else if (py::isinstance<py::str>(each)) {
      column.text += py::cast<std::string>(each);
      set_bit(column.valid, i);
    } else {
      throw InputError(fmt::format(
          "row {}, column '{}': {} in a column of objects, which may hold texts alone", i + 1,
          column.name, std::string(py::str(py::type::handle_of(each).attr("__name__")))));
    }
    if (column.text.size() > std::numeric_limits<std::int32_t>::max())
      throw InputError(fmt::format("column '{}' holds more than 2 GB of texts", column.name));
    column.ends.push_back(static_cast<std::int32_t>(column.text.size()));
  }
  column.buffers = {column.nulls > 0 ? column.valid.data() : nullptr, column.ends.data(),
                    column.text.data()};
}

// ---- Schemas and arrays: a parent owns the places of its children, and each child what it needs itself, since a
// consumer may move it away.

template <class Struct>
struct Parent {
  Shared content;
  std::vector<Struct> children;
  std::vector<Struct*> at;
  const void* none = nullptr;  // the one buffer of a structure: its validity
};

template <class Struct>
void release_parent(Struct* self) {
  auto* const own = static_cast<Parent<Struct>*>(self->private_data);
  for (Struct& child : own->children)
    if (child.release) child.release(&child);
  self->release = nullptr;
  delete own;
}

template <class Struct>
void release_child(Struct* self) {
  auto* const own = static_cast<Shared*>(self->private_data);
  self->release = nullptr;
  delete own;
}

template <class Struct>
std::unique_ptr<Parent<Struct>> parent_of(const Shared& content) {
  auto own = std::make_unique<Parent<Struct>>();
  own->content = content;
  own->children.resize(content->columns.size());
  for (Struct& child : own->children) own->at.push_back(&child);
  return own;
}

void fill(const Shared& content, ArrowSchema* out) {
  auto own = parent_of<ArrowSchema>(content);
  for (std::size_t c = 0; c < own->children.size(); ++c) {
    const ExportedArray& column = content->columns[c];
    own->children[c] = {column.format.c_str(),
                        column.name.c_str(),
                        column.metadata.empty() ? nullptr : column.metadata.data(),
                        nullable,
                        0,
                        nullptr,
                        nullptr,
                        &release_child<ArrowSchema>,
                        new Shared(content)};
  }
  *out = {"+s",
          "",
          nullptr,
          0,
          static_cast<std::int64_t>(own->children.size()),
          own->at.data(),
          nullptr,
          &release_parent<ArrowSchema>,
          nullptr};
  out->private_data = own.release();
}

void fill(const Shared& content, ArrowArray* out) {
  auto own = parent_of<ArrowArray>(content);
  for (std::size_t c = 0; c < own->children.size(); ++c) {
    const ExportedArray& column = content->columns[c];
    own->children[c] = {content->rows,
                        column.nulls,
                        0,
                        static_cast<std::int64_t>(column.buffers.size()),
                        0,
                        const_cast<const void**>(column.buffers.data()),
                        nullptr,
                        nullptr,
                        &release_child<ArrowArray>,
                        new Shared(content)};
  }
  *out = {content->rows,
          0,
          0,
          1,
          static_cast<std::int64_t>(own->children.size()),
          &own->none,
          own->at.data(),
          nullptr,
          &release_parent<ArrowArray>,
          nullptr};
  out->private_data = own.release();
}

// ---- The stream.

struct Streamed {
  Shared content;
  bool given = false;
};

template <class Struct>
int filled(const Shared& content, Struct* out) {
  try {
    fill(content, out);
    return 0;
  } catch (const std::bad_alloc&) {
    return ENOMEM;
  }
}

int get_schema(ArrowArrayStream* self, ArrowSchema* out) {
  return filled(static_cast<Streamed*>(self->private_data)->content, out);
}

int get_next(ArrowArrayStream* self, ArrowArray* out) {
  auto& own = *static_cast<Streamed*>(self->private_data);
  if (own.given) {
    std::memset(out, 0, sizeof *out);  // the end
    return 0;
  }
  const int status = filled(own.content, out);
  own.given = status == 0;
  return status;
}

const char* last_error(ArrowArrayStream*) {
  return nullptr;
}

void release_stream(ArrowArrayStream* self) {
  auto* const own = static_cast<Streamed*>(self->private_data);
  self->release = nullptr;
  delete own;
}

// A capsule that nobody took.
void drop_capsule(PyObject* capsule) {
  auto* const stream =
      static_cast<ArrowArrayStream*>(PyCapsule_GetPointer(capsule, "arrow_array_stream"));
  if (!stream) return PyErr_Clear();
  if (stream->release) stream->release(stream);
  delete stream;
}

}  // namespace

py::capsule arrow_stream_of(const std::vector<ExportedColumn>& columns) {
  auto content = std::make_shared<Content>();
  content->columns.resize(columns.size());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const auto& [name, unit, values] = columns[c];
    ExportedArray& column = content->columns[c];
    column.name = name;
    if (!unit.empty()) column.metadata = metadata_of("unit", unit);
    std::int64_t rows = 0;
    if (py::isinstance<py::array>(values)) {
      const auto array = py::reinterpret_borrow<py::array>(values);
      add_numbers(column, array);
      rows = array.shape(0);
    } else {
      const auto texts = py::reinterpret_borrow<py::sequence>(values);
      add_text(column, texts);
      rows = static_cast<std::int64_t>(texts.size());
    }
    if (c > 0 && rows != content->rows)
      throw InputError(fmt::format("column '{}' has {} rows, and '{}' has {}", name, rows,
                                   content->columns.front().name, content->rows));
    content->rows = rows;
  }
  auto stream = std::make_unique<ArrowArrayStream>(
      ArrowArrayStream{&get_schema, &get_next, &last_error, &release_stream, nullptr});
  stream->private_data = new Streamed{content};
  PyObject* const capsule = PyCapsule_New(stream.get(), "arrow_array_stream", &drop_capsule);
  if (!capsule) {
    stream->release(stream.get());
    throw py::error_already_set();
  }
  stream.release();
  return py::reinterpret_steal<py::capsule>(capsule);
}

}  // namespace wearwell::python
