#pragma once

#include <cstdint>

#include "wearwell/input/table.h"

// The Arrow C data interface (arrow.apache.org/docs/format/CDataInterface.html): its structures are what two libraries
// agree on, so they are written down as they are there.
extern "C" {

struct ArrowSchema {
  const char* format;
  const char* name;
  const char* metadata;
  std::int64_t flags;
  std::int64_t n_children;
  ArrowSchema** children;
  ArrowSchema* dictionary;
  void (*release)(ArrowSchema*);
  void* private_data;
};

struct ArrowArray {
  std::int64_t length;
  std::int64_t null_count;
  std::int64_t offset;
  std::int64_t n_buffers;
  std::int64_t n_children;
  const void** buffers;
  ArrowArray** children;
  ArrowArray* dictionary;
  void (*release)(ArrowArray*);
  void* private_data;
};

struct ArrowArrayStream {
  int (*get_schema)(ArrowArrayStream*, ArrowSchema*);
  int (*get_next)(ArrowArrayStream*, ArrowArray*);
  const char* (*get_last_error)(ArrowArrayStream*);
  void (*release)(ArrowArrayStream*);
  void* private_data;
};

}  // extern "C"

namespace wearwell::python {

/// A table, and the headings of its columns of booleans, which are numbers in it.
struct ArrowTable {
  Table table;
  std::vector<std::string> truths;
};

/// Reads all batches of a stream of structures, and releases it: numbers, booleans, texts, and dictionaries of texts.
/// Null is an empty cell. Throws InputError that names the column where it is something else.
ArrowTable read_arrow(ArrowArrayStream& stream, const std::string& name);

/// A whole number that no double holds is no column of measurements. Throws InputError.
void require_exact(double magnitude, const std::string& table, const std::string& column,
                   std::size_t row);

}  // namespace wearwell::python
