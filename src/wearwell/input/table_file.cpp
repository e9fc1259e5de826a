#include "wearwell/input/table_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <boost/algorithm/string/case_conv.hpp>
#include <cerrno>
#include <cstring>
#include <memory>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell {
namespace {

struct Ending {
  const char* text;
  TableFormat format;
};
constexpr Ending endings[] = {{".xlsx", TableFormat::workbook},  {".xlsm", TableFormat::workbook},
                              {".csv", TableFormat::text},       {".tsv", TableFormat::text},
                              {".txt", TableFormat::text},       {".dat", TableFormat::text},
                              {".asc", TableFormat::text},       {".json", TableFormat::json},
                              {".ndjson", TableFormat::json},    {".jsonl", TableFormat::json},
                              {".parquet", TableFormat::parquet}};

TableFormat format_of(std::string name, bool& gzip, const std::string& source) {
  boost::algorithm::to_lower(name);
  gzip = name.ends_with(".gz");
  if (gzip) name.resize(name.size() - 3);
  for (const auto& [text, format] : endings) {
    const bool packs = format == TableFormat::text || format == TableFormat::json;
    if (name.ends_with(text) && (packs || !gzip)) return format;
  }
  for (const char* other : {".xls", ".xlsb", ".ods"}) {
    if (name.ends_with(other))
      throw InputError(
          fmt::format("{}: {} is not supported; save it as .xlsx or .csv", source, other));
  }
  throw InputError(
      fmt::format("{}: its extension is unknown; a table is .csv, .tsv, .txt, .dat, "
                  ".asc, .json, .ndjson, "
                  ".jsonl (each also with .gz), .parquet or .xlsx",
                  source));
}

/// Reads a whole gzip file to verify the checksum and length at its end. DuckDB checks neither, and
/// may stop at the end of a stream although another follows.
void check_gzip(const std::string& path, const std::string& source) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (!file) throw InputError(fmt::format("{} cannot be read", source));
  z_stream stream = {};
  constexpr int gzip_only = 16 + MAX_WBITS;
  if (inflateInit2(&stream, gzip_only) != Z_OK) throw MachineError("cannot start zlib");
  const std::unique_ptr<z_stream, int (*)(z_stream*)> closing(&stream, &inflateEnd);
  std::vector<unsigned char> in(1 << 16), out(1 << 18);
  bool ended = false;
  while (const std::size_t count = std::fread(in.data(), 1, in.size(), file.get())) {
    if (ended)
      throw InputError(
          fmt::format("{}: more than one gzip stream; unpack it and pack it as one", source));
    stream.next_in = in.data();
    stream.avail_in = static_cast<unsigned>(count);
    while (stream.avail_in > 0 && !ended) {
      stream.next_out = out.data();
      stream.avail_out = static_cast<unsigned>(out.size());
      const int outcome = inflate(&stream, Z_NO_FLUSH);
      ended = outcome == Z_STREAM_END;
      if (outcome != Z_OK && !ended)
        throw InputError(
            fmt::format("{}: damaged, or not a gzip file: {}", source,
                        stream.msg ? stream.msg : "its compressed data cannot be unpacked"));
    }
    if (stream.avail_in > 0)
      throw InputError(
          fmt::format("{}: more than one gzip stream; unpack it and pack it as one", source));
  }
  if (std::ferror(file.get())) throw MachineError(fmt::format("{} cannot be read", source));
  if (!ended)
    throw InputError(
        fmt::format("{} is cut off: the end of its compressed data is missing", source));
}

}  // namespace

TableFile::TableFile(const std::filesystem::path& file) : source_(valid_utf8(file.string())) {
  // Non-blocking, because a pipe without a writer would block forever.
  descriptor_ = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) {
    if (errno == ENOENT || errno == ENOTDIR)
      throw InputError(fmt::format("no such file: {}", source_));
    throw InputError(fmt::format("{} cannot be read: {}", source_, std::strerror(errno)));
  }
  try {
    struct stat status = {};
    fstat(descriptor_, &status);
    if (S_ISDIR(status.st_mode))
      throw InputError(fmt::format("{} is a folder, not a file", source_));
    if (!S_ISREG(status.st_mode))
      throw InputError(
          fmt::format("{} is a pipe or a device; save its output to a file first", source_));
    if (status.st_size == 0) throw InputError(fmt::format("{} is empty", source_));
    format_ = format_of(file.filename(), gzip_, source_);
    if (gzip_) check_gzip(path(), source_);
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

TableFile::~TableFile() {
  close(descriptor_);
}

std::string TableFile::path() const {
  return fmt::format("/proc/self/fd/{}", descriptor_);
}

}  // namespace wearwell
