#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "wearwell/input/table_file.h"

struct zip;

namespace wearwell {

/// Callbacks for an XML text; names have no prefix.
struct XmlHandler {
  using Attributes = std::map<std::string, std::string, std::less<>>;
  std::function<void(std::string_view name, const Attributes& attributes)> start;
  std::function<void(std::string_view name)> end;
  std::function<void(std::string_view text)> text = {};  ///< may be called with pieces of a text
};

/// A zip of XML texts, such as a spreadsheet. Unpacks only the requested part, up to a limit.
class ZipXml {
 public:
  /// Throws InputError if it is not a zip, or is truncated or damaged.
  explicit ZipXml(const TableFile& file);
  ~ZipXml();
  ZipXml(const ZipXml&) = delete;
  ZipXml& operator=(const ZipXml&) = delete;

  bool has(const std::string& part) const;
  /// Reads one text completely. Throws InputError if it is missing, damaged, not XML, or larger
  /// than `most` bytes.
  void read(const std::string& part, const XmlHandler& handler, std::size_t most) const;

 private:
  struct Close {
    void operator()(zip* archive) const;
  };
  std::string source_;
  std::unique_ptr<zip, Close> archive_;
};

}  // namespace wearwell
