#include "wearwell/study/fingerprint.h"

#include <fmt/format.h>

#include <boost/uuid/detail/sha1.hpp>
#include <fstream>
#include <vector>

#include "wearwell/base/error.h"

namespace wearwell {

namespace {

std::string digits(boost::uuids::detail::sha1& hash) {
  boost::uuids::detail::sha1::digest_type digest;
  hash.get_digest(digest);
  std::string text;
  for (const unsigned int word : digest) text += fmt::format("{:08x}", word);
  return text;
}

}  // namespace

std::string sha1(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  boost::uuids::detail::sha1 hash;
  std::vector<char> buffer(1 << 16);
  while (stream.read(buffer.data(), static_cast<std::streamsize>(buffer.size())),
         stream.gcount() > 0) {
    hash.process_bytes(buffer.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.eof()) throw InputError(fmt::format("cannot read {}", file.string()));
  return digits(hash);
}

std::string fingerprint(const std::string& quantity, const std::vector<double>& observed) {
  std::string text = quantity;
  for (const double value : observed) text += fmt::format("\n{:.12g}", value);
  boost::uuids::detail::sha1 hash;
  hash.process_bytes(text.data(), text.size());
  return digits(hash);
}

}  // namespace wearwell
