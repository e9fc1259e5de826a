#pragma once

#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "arrow.h"
#include "core.h"

namespace wearwell::python {

/// (name, unit, array of numbers or list of texts).
using ExportedColumn = std::tuple<std::string, std::string, py::object>;

/// A capsule "arrow_array_stream" of one batch with these columns: float64, int64, booleans, and texts (None is null).
/// Contiguous arrays of float64 and int64 are not copied: the stream's consumer holds them until it releases the batch,
/// from whichever thread. A unit is the field's metadata "unit". Throws InputError of columns of other lengths or types.
py::capsule arrow_stream_of(const std::vector<ExportedColumn>& columns);

}  // namespace wearwell::python
