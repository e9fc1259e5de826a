#pragma once

#include <Random123/philox.h>

#include <cmath>
#include <cstdint>

namespace wearwell {

/// A stream of random numbers from Philox4x32-10 (Salmon et al. 2011), a counter-based generator:
/// (seed, stream) names the stream, so every chain, stage or specimen has its own stream and
/// results do not depend on threads. The normal transform is implemented here, so that results do
/// not depend on the standard library.
class Rng {
 public:
  Rng(std::uint64_t seed, std::uint64_t stream)
      : key_{{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}},
        counter_{
            {0, 0, static_cast<std::uint32_t>(stream), static_cast<std::uint32_t>(stream >> 32)}} {}

  std::uint64_t bits() {
    if (left_ == 0) refill();
    return block_[--left_];
  }

  /// Uniform on the open interval (0, 1): 52 bits plus a half, so never 0 or 1.
  double uniform() { return (static_cast<double>(bits() >> 12) + 0.5) * 0x1p-52; }

  double uniform(double lower, double upper) { return lower + (upper - lower) * uniform(); }

  /// Standard normal, by Marsaglia's polar method.
  double normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    double u, v, s;
    do {
      u = 2 * uniform() - 1;
      v = 2 * uniform() - 1;
      s = u * u + v * v;
    } while (s >= 1 || s == 0);
    const double factor = std::sqrt(-2 * std::log(s) / s);
    spare_ = v * factor;
    has_spare_ = true;
    return u * factor;
  }

 private:
  void refill() {
    const auto words = r123::Philox4x32()(counter_, key_);
    block_[1] = words[0] | static_cast<std::uint64_t>(words[1]) << 32;
    block_[0] = words[2] | static_cast<std::uint64_t>(words[3]) << 32;
    left_ = 2;
    if (++counter_[0] == 0) ++counter_[1];
  }

  r123::Philox4x32::key_type key_;
  r123::Philox4x32::ctr_type counter_;
  std::uint64_t block_[2] = {};
  int left_ = 0;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace wearwell
