#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace wearwell::netcdf {

/// Name and text of an attribute of a variable, a group or a file.
using Attributes = std::vector<std::pair<std::string, std::string>>;

/// A dimension of arrays and its length.
struct Dimension {
  std::string name;
  std::size_t size = 0;
};

/// An array; the last of its dimensions varies fastest. Flags are bytes that xarray reads as bool.
struct Variable {
  using Flags = std::vector<signed char>;
  std::string name;
  std::vector<std::string> dimensions;  ///< of its group
  std::variant<std::vector<double>, std::vector<std::int64_t>, std::vector<std::string>, Flags>
      values;
  Attributes attributes = {};
};

/// A group of variables with their dimensions.
struct Group {
  std::string name;
  std::vector<Dimension> dimensions;
  std::vector<Variable> variables;
  Attributes attributes = {};
};

/// A letter or _ first, then letters, digits and _: a valid name for every reader of NetCDF.
std::string plain_name(const std::string& text);

/// A NetCDF-4 file of these groups, as bytes. One thread at a time: HDF5 is not thread-safe. Throws
/// MachineError if the library of NetCDF is missing or fails; std::logic_error if an array does not
/// have the size of its dimensions.
std::string file_of(const std::vector<Group>& groups);

/// Writes the same as a file that appears whole or not at all. Throws also InputError when `target`
/// cannot be written (no folder, no permission), and MachineError when the disk fails.
void write(const std::filesystem::path& target, const std::vector<Group>& groups);

}  // namespace wearwell::netcdf
