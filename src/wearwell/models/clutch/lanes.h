#pragma once

// The inner loops of sums over billions of cycles: eight numbers at once, and exp and ln in a form
// that compilers vectorize in plain loops. Every number is computed by the same operations at any
// position, without fused multiply-add: the same bits on every machine, for any division of rows.
// `WEARWELL_LANES` before a function compiles it for several processors, of which the program uses
// the best available. (No comparisons of vectors: compilers split them into scalars.)

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define WEARWELL_SANITIZED
#endif
#endif
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && \
    !defined(WEARWELL_SANITIZED)
#define WEARWELL_LANES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define WEARWELL_LANES
#endif

namespace wearwell::clutch::lanes {

inline constexpr int count = 8;

typedef double Reals __attribute__((vector_size(64)));
typedef long long Wholes __attribute__((vector_size(64)));
/// In memory. (The alignment of a bare vector depends on the target processor of a function.)
struct Line {
  alignas(64) double x[count];
};
struct WholeLine {
  alignas(64) long long x[count] = {};
};
/// The same at any address.
typedef double LooseReals __attribute__((vector_size(64), aligned(8), may_alias));
typedef long long LooseWholes __attribute__((vector_size(64), aligned(8), may_alias));

#pragma GCC diagnostic push
// Everything here is inlined, so the calling convention does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"
#define WEARWELL_INLINE [[gnu::always_inline]] inline

WEARWELL_INLINE Reals load(const double* from) {
  return *reinterpret_cast<const LooseReals*>(from);
}
WEARWELL_INLINE void store(double* to, const Reals& x) {
  *reinterpret_cast<LooseReals*>(to) = x;
}
WEARWELL_INLINE Reals load(const Line& from) {
  return load(from.x);
}
WEARWELL_INLINE void store(Line& to, const Reals& x) {
  store(to.x, x);
}
WEARWELL_INLINE Wholes bits(const Reals& x) {
  return reinterpret_cast<Wholes>(x);
}
WEARWELL_INLINE Reals absolute(const Reals& x) {
  return reinterpret_cast<Reals>(bits(x) & 0x7fff'ffff'ffff'ffffLL);
}
WEARWELL_INLINE void add(long long* to, const Wholes& x) {
  *reinterpret_cast<LooseWholes*>(to) += x;
}

/// Added to a number of less than 2^51 it leaves the nearest integer (ties to even) in the lowest
/// bits: bits(x + to_whole) - to_whole_bits.
inline constexpr double to_whole = 0x1.8p52;
inline constexpr long long to_whole_bits = 0x4338'0000'0000'0000LL;
inline constexpr double largest_whole = 0x1p51;

/// The first n of eight are all ones, the others zero.
WEARWELL_INLINE Wholes first(long long how_many) {
  alignas(64) static constexpr long long table[2 * count] = {-1, -1, -1, -1, -1, -1, -1, -1};
  return *reinterpret_cast<const LooseWholes*>(table + count -
                                               (how_many < count ? how_many : count));
}

/// e^x within 1e-14 of it. Below -700 that of -700 (1e-304), beyond 709 that of 709 (8e307). NaN
/// stays.
WEARWELL_INLINE double exp(double given) {
  constexpr double log2e = 1.4426950408889634;
  constexpr double ln2_high = 0x1.62e42feep-1, ln2_low = 0x1.a39ef35793c76p-33;
  double x = given < -700 ? -700 : given;
  x = x > 709 ? 709 : x;
  const double t = x * log2e + to_whole;
  const double n = t - to_whole;
  const double r = (x - n * ln2_high) - n * ln2_low;
  double p = r * (1.0 / 39916800) + 1.0 / 3628800;
  p = p * r + 1.0 / 362880;
  p = p * r + 1.0 / 40320;
  p = p * r + 1.0 / 5040;
  p = p * r + 1.0 / 720;
  p = p * r + 1.0 / 120;
  p = p * r + 1.0 / 24;
  p = p * r + 1.0 / 6;
  p = p * r + 0.5;
  p = p * r + 1.0;
  p = p * r + 1.0;
  const auto scale = __builtin_bit_cast(unsigned long long, t) << 52;
  const double y = __builtin_bit_cast(double, __builtin_bit_cast(unsigned long long, p) + scale);
  return given == given ? y : given;
}

/// ln x of a normal positive number, within 1e-15: x = 2^e m, ln m = 2 atanh((m - 1)/(m + 1)).
WEARWELL_INLINE double log(double x) {
  constexpr double ln2_high = 0x1.62e42feep-1, ln2_low = 0x1.a39ef35793c76p-33;
  constexpr unsigned long long root_half = 0x3fe6'a09e'667f'3bcd, bias = 1024,
                               two52 = 0x4330'0000'0000'0000;
  const auto given = __builtin_bit_cast(unsigned long long, x);
  const unsigned long long e = (given - root_half + (bias << 52)) >> 52;
  const double m = __builtin_bit_cast(double, given - ((e - bias) << 52));
  const double n = __builtin_bit_cast(double, e | two52) - (0x1p52 + bias);
  const double s = (m - 1) / (m + 1), z = s * s;
  double p = z * (1.0 / 21) + 1.0 / 19;
  p = p * z + 1.0 / 17;
  p = p * z + 1.0 / 15;
  p = p * z + 1.0 / 13;
  p = p * z + 1.0 / 11;
  p = p * z + 1.0 / 9;
  p = p * z + 1.0 / 7;
  p = p * z + 1.0 / 5;
  p = p * z + 1.0 / 3;
  return n * ln2_high + (n * ln2_low + (s + s) * (p * z + 1));
}

#pragma GCC diagnostic pop

}  // namespace wearwell::clutch::lanes
