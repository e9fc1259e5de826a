#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "wearwell/input/table_file.h"

struct zip;

namespace wearwell {

/// What reads an XML text as it comes; names without their prefix.
struct XmlHandler {
  using Attributes = std::map<std::string, std::string, std::less<>>;
  std::function<void(std::string_view name, const Attributes& attributes)> start;
  std::function<void(std::string_view name)> end;
  std::function<void(std::string_view text)> text = {};  ///< may come in pieces
};

/// A zip of XML texts, as spreadsheets are. Nothing is unpacked but what is read, and of that no more
/// than a limit.
class ZipXml {
 public:
  /// Throws InputError where it is no zip, or one that is cut off or damaged.
  explicit ZipXml(const TableFile& file);
  ~ZipXml();
  ZipXml(const ZipXml&) = delete;
  ZipXml& operator=(const ZipXml&) = delete;

  bool has(const std::string& part) const;
  /// Reads one text from its beginning to its end. Throws InputError where there is none, where it is
  /// damaged or no XML, or larger than `most` bytes.
  void read(const std::string& part, const XmlHandler& handler, std::size_t most) const;

 private:
  struct Close {
    void operator()(zip* archive) const;
  };
  std::string source_;
  std::unique_ptr<zip, Close> archive_;
};

}  // namespace wearwell
