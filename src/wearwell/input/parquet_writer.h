#pragma once

#include <string>
#include <vector>

namespace wearwell {

/// A column of numbers; NaN is a missing value.
struct NumberColumn {
  std::string name;
  std::vector<double> values;
};

/// A column of texts, UTF-8.
struct WordColumn {
  std::string name;
  std::vector<std::string> values;
};

/// The bytes of a Parquet file with columns of equal length. Throws MachineError.
std::string parquet_of(const std::vector<NumberColumn>& columns);
/// Text columns come first. At least one column is required.
std::string parquet_of(const std::vector<WordColumn>& texts,
                       const std::vector<NumberColumn>& columns);

}  // namespace wearwell
