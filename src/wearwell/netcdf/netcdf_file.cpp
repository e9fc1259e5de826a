#include "wearwell/netcdf/netcdf_file.h"

#include <fmt/format.h>

#include <cctype>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <numeric>
#include <stdexcept>

#include "wearwell/base/error.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/netcdf/netcdf_library.h"

namespace wearwell::netcdf {
namespace {

// of zlib: higher levels hardly compress draws further
constexpr int compression = 4;
constexpr std::size_t worth_compressing = 1000;           // values
constexpr std::size_t first_size = std::size_t{1} << 16;  // of the file in memory, bytes

// One file in memory, being written.
class MemoryFile {
 public:
  MemoryFile() : nc_(library()) {
    check(nc_.create_mem("memory", NC_NETCDF4, first_size, &id_), "the file");
  }
  ~MemoryFile() {
    if (id_ >= 0) nc_.abort(id_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  void add(const Group& group) {
    int id = -1;
    check(nc_.def_grp(id_, group.name.c_str(), &id), group.name);
    add(id, NC_GLOBAL, group.attributes, group.name);
    std::vector<int> dimensions;
    for (const Dimension& each : group.dimensions) {
      dimensions.push_back(-1);
      check(nc_.def_dim(id, each.name.c_str(), each.size, &dimensions.back()), each.name);
    }
    for (const Variable& each : group.variables) add(id, group, dimensions, each);
  }

  std::string bytes() {
    NC_memio memory{};
    const int closed = nc_.close_memio(std::exchange(id_, -1), &memory);
    const std::unique_ptr<void, decltype(&std::free)> owned(memory.memory, &std::free);
    check(closed, "the file");
    return {static_cast<const char*>(memory.memory), memory.size};
  }

 private:
  void check(int status, const std::string& what) const {
    if (status != NC_NOERR)
      throw MachineError(fmt::format("NetCDF cannot store {}: {}", what, nc_.strerror(status)));
  }

  void add(int group, int variable, const Attributes& attributes, const std::string& what) {
    for (const auto& [name, text] : attributes)
      check(nc_.put_att_text(group, variable, name.c_str(), text.size(), text.data()), what);
  }

  void add(int id, const Group& group, const std::vector<int>& dimensions,
           const Variable& variable) {
    std::vector<int> of;
    std::size_t size = 1;
    for (const std::string& name : variable.dimensions) {
      std::size_t d = 0;
      while (d < dimensions.size() && group.dimensions[d].name != name) ++d;
      if (d == dimensions.size()) throw std::logic_error(name + " is not a dimension");
      of.push_back(dimensions[d]);
      size *= group.dimensions[d].size;
    }
    const std::size_t held = std::visit([](const auto& v) { return v.size(); }, variable.values);
    if (held != size)
      throw std::logic_error(variable.name + " does not have the size of its dimensions");
    constexpr nc_type types[] = {NC_DOUBLE, NC_INT64, NC_STRING, NC_BYTE};
    int at = -1;
    check(nc_.def_var(id, variable.name.c_str(), types[variable.values.index()],
                      static_cast<int>(of.size()), of.data(), &at),
          variable.name);
    if (size >= worth_compressing &&
        !std::holds_alternative<std::vector<std::string>>(variable.values))
      check(nc_.def_var_deflate(id, at, 1, 1, compression), variable.name);
    add(id, at, variable.attributes, variable.name);
    if (std::holds_alternative<Variable::Flags>(variable.values))
      add(id, at, {{"dtype", "bool"}}, variable.name);
    if (size > 0) put(id, at, variable);
  }

  void put(int id, int at, const Variable& variable) {
    struct Put {
      const Library& nc;
      int id, at;
      int operator()(const std::vector<double>& v) const {
        return nc.put_var_double(id, at, v.data());
      }
      int operator()(const std::vector<std::int64_t>& v) const {
        const std::vector<long long> wide(v.begin(), v.end());
        return nc.put_var_longlong(id, at, wide.data());
      }
      int operator()(const Variable::Flags& v) const { return nc.put_var_schar(id, at, v.data()); }
      int operator()(const std::vector<std::string>& v) const {
        std::vector<const char*> texts;
        for (const std::string& each : v) texts.push_back(each.c_str());
        return nc.put_var_string(id, at, texts.data());
      }
    };
    check(std::visit(Put{nc_, id, at}, variable.values), variable.name);
  }

  const Library& nc_;
  int id_ = -1;
};

}  // namespace

std::string plain_name(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) || c == '_';
    name += plain && static_cast<unsigned char>(c) < 0x80 ? c : '_';
  }
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name.front()))) name = "_" + name;
  return name;
}

std::string file_of(const std::vector<Group>& groups) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  MemoryFile file;
  for (const Group& each : groups) file.add(each);
  return file.bytes();
}

void write(const std::filesystem::path& target, const std::vector<Group>& groups) {
  write_file(target, file_of(groups));
}

}  // namespace wearwell::netcdf
