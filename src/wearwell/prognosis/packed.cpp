#include "wearwell/prognosis/packed.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <zlib.h>

#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/stop_scope.h"

namespace wearwell::prognosis {
namespace {

constexpr std::size_t piece_length = std::size_t{1} << 20;
constexpr std::uint64_t most_bytes = std::uint64_t{1} << 36;  // of a body
// zlib does not compress more in one call
constexpr std::uint64_t most_packed = 1100;

struct Piece {
  std::string bytes;
  uLong checksum = 0;
};

// Deflated without a header, up to the end of a byte, so that another piece can follow.
Piece packed_piece(std::string_view body, bool last) {
  constexpr int level = 1, window = 15, memory = 9;
  z_stream stream = {};
  Piece piece;
  if (deflateInit2(&stream, level, Z_DEFLATED, -window, memory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw MachineError("out of memory for the state of the result");
  constexpr std::size_t end_of_byte = 16;
  piece.bytes.resize(deflateBound(&stream, body.size()) + end_of_byte);
  // zlib only reads it, but its interface predates const.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(body.data()));
  stream.avail_in = static_cast<uInt>(body.size());
  stream.next_out = reinterpret_cast<Bytef*>(piece.bytes.data());
  stream.avail_out = static_cast<uInt>(piece.bytes.size());
  const int outcome = deflate(&stream, last ? Z_FINISH : Z_FULL_FLUSH);
  const bool whole = stream.avail_in == 0 && outcome == (last ? Z_STREAM_END : Z_OK);
  piece.bytes.resize(stream.total_out);
  deflateEnd(&stream);
  if (!whole) throw std::logic_error("packed: a piece does not fit");
  piece.checksum = adler32(adler32(0, nullptr, 0), reinterpret_cast<const Bytef*>(body.data()),
                           static_cast<uInt>(body.size()));
  return piece;
}

}  // namespace

std::string packed(std::string_view body) {
  std::vector<Piece> pieces(body.size() / piece_length + 1);
  tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t i) {
    check_stop();
    pieces[i] = packed_piece(body.substr(i * piece_length, piece_length), i + 1 == pieces.size());
  });
  std::string bytes("\x78\x01", 2);  // deflated, window of 32 kB, fastest
  uLong checksum = adler32(0, nullptr, 0);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::size_t length = body.substr(i * piece_length, piece_length).size();
    bytes += pieces[i].bytes;
    checksum = adler32_combine(checksum, pieces[i].checksum, static_cast<z_off_t>(length));
  }
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(checksum >> shift & 0xff);
  return bytes;
}

std::string unpacked(std::string_view bytes, std::uint64_t size, const std::string& file) {
  const auto damaged = [&] {
    throw InputError(fmt::format("{} is damaged: its packed content has another length", file));
  };
  if (size > most_bytes || size / most_packed > bytes.size()) damaged();
  std::string body(size, '\0');
  uLongf length = size, taken = bytes.size();
  const int outcome = uncompress2(reinterpret_cast<Bytef*>(body.data()), &length,
                                  reinterpret_cast<const Bytef*>(bytes.data()), &taken);
  if (outcome != Z_OK || length != size || taken != bytes.size()) damaged();
  return body;
}

}  // namespace wearwell::prognosis
