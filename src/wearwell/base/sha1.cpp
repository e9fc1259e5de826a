#include "wearwell/base/sha1.h"

#include <fmt/format.h>

#include <boost/uuid/detail/sha1.hpp>
#include <vector>

namespace wearwell {
namespace {

using Sha1 = boost::uuids::detail::sha1;

std::string digits(Sha1& hash) {
  Sha1::digest_type digest;
  hash.get_digest(digest);
  std::string text;
  for (const unsigned int word : digest) text += fmt::format("{:08x}", word);
  return text;
}

}  // namespace

std::string sha1_of(std::string_view bytes) {
  Sha1 hash;
  hash.process_bytes(bytes.data(), bytes.size());
  return digits(hash);
}

std::string sha1_of(std::istream& stream) {
  Sha1 hash;
  std::vector<char> buffer(1 << 16);
  while (stream.read(buffer.data(), static_cast<std::streamsize>(buffer.size())),
         stream.gcount() > 0) {
    hash.process_bytes(buffer.data(), static_cast<std::size_t>(stream.gcount()));
  }
  return digits(hash);
}

}  // namespace wearwell
