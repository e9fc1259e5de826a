#pragma once

#include <string>
#include <vector>

namespace wearwell {

/// A column of numbers to be written; NaN is no value.
struct NumberColumn {
  std::string name;
  std::vector<double> values;
};

/// A column of texts, UTF-8.
struct WordColumn {
  std::string name;
  std::vector<std::string> values;
};

/// A Parquet file of columns of equal length, as its bytes. Throws MachineError.
std::string parquet_of(const std::vector<NumberColumn>& columns);
/// The texts first. There is one column at least.
std::string parquet_of(const std::vector<WordColumn>& texts,
                       const std::vector<NumberColumn>& columns);

}  // namespace wearwell
