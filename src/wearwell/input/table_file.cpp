#include "wearwell/input/table_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/predicate.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <cerrno>
#include <cstring>
#include <map>
#include <memory>
#include <optional>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell {
namespace {

constexpr std::size_t longest_line = 16 << 20;
constexpr int sampled_records = 1000;  // to tell what separates the columns

struct CloseGzip {
  void operator()(gzFile file) const { gzclose(file); }
};
using GzipFile = std::unique_ptr<gzFile_s, CloseGzip>;

// As written in the file, in the order in which they are tried.
constexpr char delimiters[] = {'\t', ';', '|', ','};

struct Ending {
  const char* text;
  TableFormat format;
};
constexpr Ending endings[] = {{".csv", TableFormat::csv},        {".tsv", TableFormat::csv},
                              {".txt", TableFormat::csv},        {".json", TableFormat::json},
                              {".ndjson", TableFormat::json},    {".jsonl", TableFormat::json},
                              {".parquet", TableFormat::parquet}};

TableFormat format_of(std::string name, bool& gzip, const std::string& source) {
  boost::algorithm::to_lower(name);
  gzip = name.ends_with(".gz");
  if (gzip) name.resize(name.size() - 3);
  for (const auto& [text, format] : endings) {
    if (name.ends_with(text) && !(gzip && format == TableFormat::parquet)) return format;
  }
  throw InputError(fmt::format(
      "{}: its ending does not say what it holds; a table is .csv, .tsv, .txt, .json, .ndjson, "
      ".jsonl (each also with .gz behind) or .parquet",
      source));
}

/// Reads all of a gzip: its checksum and length are at its end. DuckDB looks at neither, and would
/// stop at some ends of a stream though another follows.
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
            fmt::format("{}: damaged, or no gzip: {}", source,
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

/// Lines of a text, compressed or not, without the ends.
class Lines {
 public:
  explicit Lines(const TableFile& file) : source_(file.source()) {
    file_.reset(gzopen(file.path().c_str(), "rb"));
    if (!file_) throw InputError(fmt::format("{} cannot be read", source_));
    gzbuffer(file_.get(), 1 << 17);
  }

  bool next(std::string& line) {
    line.clear();
    char piece[1 << 12];
    while (gzgets_whole(piece, sizeof(piece), line)) {
      if (!line.empty() && line.back() == '\n') {
        line.pop_back();
        has_return = !line.empty() && line.back() == '\r';
        if (has_return) line.pop_back();
        ++number;
        return true;
      }
      if (line.size() > longest_line)
        throw InputError(fmt::format("{}, line {}: a line of more than {} MB is no line of a table",
                                     source_, number + 1, longest_line >> 20));
    }
    if (line.empty()) return false;
    ++number;
    last = true;
    return true;
  }

  bool unpacks() const { return gzdirect(file_.get()) == 0; }

  std::size_t number = 0;   ///< of the line that came last, from 1
  bool has_return = false;  ///< it ended with a carriage return
  bool last = false;        ///< it had no end

 private:
  /// gzgets stops at a zero byte as far as strlen can tell; gztell says how many there were.
  bool gzgets_whole(char* piece, int size, std::string& line) {
    const auto before = gztell(file_.get());
    if (!gzgets(file_.get(), piece, size)) return false;
    line.append(piece, static_cast<std::size_t>(gztell(file_.get()) - before));
    return true;
  }

  std::string source_;
  GzipFile file_;
};

/// What one line adds to the values of a record.
struct Scan {
  std::size_t values = 1;
  bool quoted = false;  ///< within quotes that go on in the next line
};

/// Counts the values of a line; `field`, when given, takes what they say.
void scan(const std::string& line, char delimiter, Scan& state,
          std::vector<std::string>* fields = nullptr) {
  bool at_start = !state.quoted;
  if (fields && fields->empty()) fields->emplace_back();
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (state.quoted) {
      if (c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
        if (fields) fields->back() += c;
        ++i;
      } else if (c == '"') {
        state.quoted = false;
      } else if (fields) {
        fields->back() += c;
      }
    } else if (c == delimiter) {
      ++state.values;
      at_start = true;
      if (fields) fields->emplace_back();
      continue;
    } else if (c == '"' && at_start) {
      state.quoted = true;
    } else if (fields) {
      fields->back() += c;
    }
    at_start = false;
  }
}

/// How many values each of the first records has; empty where they differ or there is but one.
std::optional<std::size_t> even_count(const TableFile& file, char delimiter) {
  Lines lines(file);
  std::string line;
  std::optional<std::size_t> count;
  Scan state;
  for (int i = 0; i < sampled_records && lines.next(line); ++i) {
    scan(line, delimiter, state);
    if (state.quoted) continue;
    if (!line.empty()) {
      if (count && *count != state.values) return {};
      count = state.values;
    }
    state = {};
  }
  return count && *count > 1 ? count : std::nullopt;
}

char find_delimiter(const TableFile& file, const std::string& heading) {
  std::string candidates;
  for (const char each : delimiters) {
    Scan state;
    scan(heading, each, state);
    if (state.values > 1) candidates += each;
  }
  if (candidates.empty()) return ',';
  if (candidates.size() == 1) return candidates.front();
  std::string even;
  for (const char each : candidates) {
    if (even_count(file, each)) even += each;
  }
  if (even.size() > 1)
    throw InputError(fmt::format(
        "{}: its columns can be separated by '{}' and by '{}'; put the headings with such a sign "
        "in double quotes, or write the other one into none of the cells",
        file.source(), even[0] == '\t' ? "tab" : std::string(1, even[0]), even[1]));
  return even.empty() ? candidates.front() : even.front();
}

void refuse_equal_names(const std::vector<std::string>& names, const std::string& source) {
  std::map<std::string, std::string> seen;
  for (const std::string& name : names) {
    if (name.empty()) continue;
    const auto [other, fresh] = seen.emplace(boost::algorithm::to_lower_copy(name), name);
    if (fresh) continue;
    if (other->second == name)
      throw InputError(fmt::format("{} has two columns named '{}'", source, name));
    throw InputError(
        fmt::format("{} has two columns, '{}' and '{}', that differ by capital "
                    "letters only; rename one",
                    source, other->second, name));
  }
}

}  // namespace

TableFile::TableFile(const std::filesystem::path& file) : source_(valid_utf8(file.string())) {
  // Not blocking: a pipe without a writer would wait for ever.
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
          fmt::format("{} is a pipe or a device; save what it gives to a file first", source_));
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

CsvHeading read_csv_heading(const TableFile& file) {
  const std::string& source = file.source();
  Lines lines(file);
  std::string heading, more;
  if (!lines.next(heading)) throw InputError(fmt::format("{} is empty", source));
  const auto starts = [&](std::string_view bytes) { return heading.starts_with(bytes); };
  if (lines.unpacks() && !file.gzip())
    throw InputError(fmt::format("{} is compressed; name it .gz at the end", source));
  if (starts("\xFF\xFE") || starts("\xFE\xFF") || heading.find('\0') != heading.npos)
    throw InputError(fmt::format(
        "{} is no UTF-8 text but UTF-16 (\"Unicode\"), or no text at all; save it as UTF-8",
        source));
  if (starts("\xEF\xBB\xBF")) heading.erase(0, 3);
  if (heading.find('\r') != heading.npos)
    throw InputError(fmt::format(
        "{}: its lines end with carriage returns alone; save it with usual line ends", source));
  if (valid_utf8(heading) != heading)
    throw InputError(
        fmt::format("{}, line 1: '{}' is not UTF-8; save the file as UTF-8 (it may be Latin-1)",
                    source, valid_utf8(heading)));
  if (boost::algorithm::trim_copy(heading).empty())
    throw InputError(fmt::format("{}: line 1 is empty; it must hold the headings", source));
  // A heading in quotes may hold the end of a line.
  const auto open = [&] {
    Scan state;
    scan(heading, ',', state);
    return state.quoted;
  };
  while (open() && heading.size() < longest_line && lines.next(more)) heading += '\n' + more;

  CsvHeading result{find_delimiter(file, heading), {}};
  Scan state;
  scan(heading, result.delimiter, state, &result.names);
  for (std::string& name : result.names) boost::algorithm::trim(name);
  refuse_equal_names(result.names, source);
  return result;
}

std::string csv_fault(const TableFile& file, const CsvHeading& heading) {
  Lines lines(file);
  std::string line;
  Scan state;
  std::size_t opened = 0;  // the line in which the record begins
  std::optional<bool> returns;
  while (lines.next(line)) {
    const std::string where = fmt::format("line {}", lines.number);
    if (valid_utf8(line) != line)
      return fmt::format("{}: '{}' is not UTF-8; save the file as UTF-8 (it may be Latin-1)", where,
                         valid_utf8(line));
    if (!lines.last && returns.value_or(lines.has_return) != lines.has_return)
      return fmt::format(
          "{} ends in another way than those before it (with or without a carriage "
          "return)",
          where);
    if (!lines.last) returns = lines.has_return;
    if (!state.quoted) opened = lines.number;
    scan(line, heading.delimiter, state);
    if (state.quoted) continue;
    const std::size_t wanted = heading.names.size();
    if (!line.empty() && state.values != wanted)
      return fmt::format("{}: {} value{} where the heading has {}: '{}'{}", where, state.values,
                         state.values == 1 ? "" : "s", wanted, line,
                         opened > 1 && line.starts_with("#") ? " (a table has no comment lines)"
                         : wanted == 1 ? " (the first line must be the heading)"
                                       : "");
    state = {};
  }
  if (state.quoted) return fmt::format("line {}: a quote is opened and never closed", opened);
  return "";
}

}  // namespace wearwell
