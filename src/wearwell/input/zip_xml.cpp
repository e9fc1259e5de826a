#include "wearwell/input/zip_xml.h"

#include <expat.h>
#include <fmt/format.h>
#include <unistd.h>
#include <zip.h>

#include <array>
#include <exception>
#include <vector>

#include "wearwell/base/error.h"

namespace wearwell {
namespace {

constexpr std::size_t piece = 1 << 16;

/// The state of the parser. Exceptions are stored here, because they must not pass through C code.
struct Parse {
  const XmlHandler* handler = nullptr;
  XML_Parser parser = nullptr;
  std::exception_ptr failure;

  template <class F>
  void guard(const F& call) {
    if (failure) return;
    try {
      call();
    } catch (...) {
      failure = std::current_exception();
      XML_StopParser(parser, XML_FALSE);
    }
  }
};

std::string_view local(const char* name) {
  const std::string_view text(name);
  const std::size_t colon = text.rfind(':');
  return colon == text.npos ? text : text.substr(colon + 1);
}

extern "C" {
void start_element(void* data, const XML_Char* name, const XML_Char** attributes) {
  auto& parse = *static_cast<Parse*>(data);
  parse.guard([&] {
    XmlHandler::Attributes read;
    for (; *attributes; attributes += 2) read.emplace(local(attributes[0]), attributes[1]);
    parse.handler->start(local(name), read);
  });
}
void end_element(void* data, const XML_Char* name) {
  auto& parse = *static_cast<Parse*>(data);
  parse.guard([&] { parse.handler->end(local(name)); });
}
void character_data(void* data, const XML_Char* text, int length) {
  auto& parse = *static_cast<Parse*>(data);
  if (parse.handler->text)
    parse.guard([&] { parse.handler->text({text, static_cast<std::size_t>(length)}); });
}
/// Custom entities could expand without limit, and spreadsheets have none.
void start_doctype(void* data, const XML_Char*, const XML_Char*, const XML_Char*, int) {
  auto& parse = *static_cast<Parse*>(data);
  parse.guard([] { throw InputError("it declares custom entities, which spreadsheets never do"); });
}
}

}  // namespace

void ZipXml::Close::operator()(zip* archive) const {
  zip_discard(archive);
}

ZipXml::ZipXml(const TableFile& file) : source_(file.source()) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{} cannot be read as a workbook: {}", source_, why));
  };
  std::array<unsigned char, 4> start{};
  if (pread(file.descriptor(), start.data(), start.size(), 0) == 4 && start[0] == 0xD0 &&
      start[1] == 0xCF)
    refuse("it has a password or is an old .xls; save it as .xlsx without a password");
  const int descriptor = dup(file.descriptor());
  if (descriptor < 0) throw MachineError("no file descriptor is left");
  lseek(descriptor, 0, SEEK_SET);
  int error = 0;
  archive_.reset(zip_fdopen(descriptor, ZIP_CHECKCONS, &error));
  if (archive_) return;
  close(descriptor);
  zip_error_t details;
  zip_error_init_with_code(&details, error);
  const std::string why = zip_error_strerror(&details);
  zip_error_fini(&details);
  refuse(fmt::format("it is truncated, damaged or not an .xlsx ({})", why));
}

ZipXml::~ZipXml() = default;

bool ZipXml::has(const std::string& part) const {
  return zip_name_locate(archive_.get(), part.c_str(), 0) >= 0;
}

void ZipXml::read(const std::string& part, const XmlHandler& handler, std::size_t most) const {
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{} cannot be read as a workbook: {}: {}", source_, part, why));
  };
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> entry(
      zip_fopen(archive_.get(), part.c_str(), 0), &zip_fclose);
  if (!entry) refuse(zip_strerror(archive_.get()));
  const std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> parser(XML_ParserCreate(nullptr),
                                                                       &XML_ParserFree);
  if (!parser) throw MachineError("no memory for XML");
  Parse parse{&handler, parser.get(), {}};
  XML_SetUserData(parser.get(), &parse);
  XML_SetElementHandler(parser.get(), start_element, end_element);
  XML_SetCharacterDataHandler(parser.get(), character_data);
  XML_SetStartDoctypeDeclHandler(parser.get(), start_doctype);
  std::vector<char> bytes(piece);
  std::size_t sum = 0;
  for (bool more = true; more;) {
    const zip_int64_t count = zip_fread(entry.get(), bytes.data(), bytes.size());
    if (count < 0) refuse(fmt::format("it is damaged ({})", zip_file_strerror(entry.get())));
    more = count > 0;
    sum += static_cast<std::size_t>(count);
    if (sum > most)
      refuse(fmt::format("it unpacks to more than {} MB; save the table as .csv", most >> 20));
    const auto status = XML_Parse(parser.get(), bytes.data(), static_cast<int>(count), !more);
    if (parse.failure) {
      try {
        std::rethrow_exception(parse.failure);
      } catch (const InputError& error) {
        refuse(error.what());
      }
    }
    if (status != XML_STATUS_OK)
      refuse(fmt::format("line {}: {}", XML_GetCurrentLineNumber(parser.get()),
                         XML_ErrorString(XML_GetErrorCode(parser.get()))));
  }
}

}  // namespace wearwell
