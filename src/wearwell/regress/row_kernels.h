#pragma once

// The innermost loops of the subset search: sums over the rows of a regression. A column is a
// contiguous array whose length is a multiple of `row_block`, padded with zeros (leverage
// complements with ones). The sums run in a fixed order, in lanes that fit every x86-64 and ARM64
// (measured as 3 times faster than the plain loop, which the compiler must not reorder).

namespace wearwell::row_kernels {

inline constexpr int row_block = 4;

/// Two doubles at any address.
typedef double Pair __attribute__((vector_size(16), aligned(8), may_alias));

inline Pair load(const double* a) {
  return *reinterpret_cast<const Pair*>(a);
}
inline void store(double* a, Pair value) {
  *reinterpret_cast<Pair*>(a) = value;
}
inline double sum(Pair a, Pair b) {
  const Pair both = a + b;
  return both[0] + both[1];
}

inline double dot(const double* a, const double* b, int rows) {
  Pair s0 = {}, s1 = {};
  for (int i = 0; i < rows; i += row_block) {
    s0 += load(a + i) * load(b + i);
    s1 += load(a + i + 2) * load(b + i + 2);
  }
  return sum(s0, s1);
}

/// to = from - factor q; returns the squared length of `to`.
inline double subtract(const double* from, double factor, const double* q, double* to, int rows) {
  Pair s0 = {}, s1 = {};
  for (int i = 0; i < rows; i += row_block) {
    const Pair a = load(from + i) - factor * load(q + i);
    const Pair b = load(from + i + 2) - factor * load(q + i + 2);
    store(to + i, a);
    store(to + i + 2, b);
    s0 += a * a;
    s1 += b * b;
  }
  return sum(s0, s1);
}

/// to = a b, row by row.
inline void multiply(const double* a, const double* b, double* to, int rows) {
  for (int i = 0; i < rows; i += 2) store(to + i, load(a + i) * load(b + i));
}

/// Leverage complements after the column z of squared length 1 / inverse joins:
/// to = g - z^2 inverse. Returns the least of them.
inline double shrink_complement(const double* g, const double* z, double inverse, double* to,
                                int rows) {
  Pair least = {1, 1};
  for (int i = 0; i < rows; i += 2) {
    const Pair column = load(z + i);
    const Pair after = load(g + i) - inverse * (column * column);
    store(to + i, after);
    least = after < least ? after : least;
  }
  return least[0] < least[1] ? least[0] : least[1];
}

/// Sum of (e / g)^2: PRESS of a model with residuals e and leverage complements g = 1 - h.
inline double press(const double* e, const double* g, int rows) {
  Pair s0 = {}, s1 = {};
  for (int i = 0; i < rows; i += row_block) {
    const Pair a = load(e + i) / load(g + i), b = load(e + i + 2) / load(g + i + 2);
    s0 += a * a;
    s1 += b * b;
  }
  return sum(s0, s1);
}

struct PressWith {
  double press;
  double least_complement;
};

/// PRESS after column z joins: sum of ((e - factor z) / (g - z^2 inverse))^2. One division for two
/// rows: a^2/b^2 + c^2/d^2 = (a^2 d^2 + c^2 b^2) / (b d)^2.
inline PressWith press_with(const double* e, const double* g, const double* z, double factor,
                            double inverse, int rows) {
  Pair total = {}, least = {1, 1};
  for (int i = 0; i < rows; i += row_block) {
    const Pair z0 = load(z + i), z1 = load(z + i + 2);
    const Pair e0 = load(e + i) - factor * z0, e1 = load(e + i + 2) - factor * z1;
    const Pair g0 = load(g + i) - inverse * (z0 * z0), g1 = load(g + i + 2) - inverse * (z1 * z1);
    const Pair a = e0 * g1, b = e1 * g0, c = g0 * g1;
    total += (a * a + b * b) / (c * c);
    least = g0 < least ? g0 : least;
    least = g1 < least ? g1 : least;
  }
  return {total[0] + total[1], least[0] < least[1] ? least[0] : least[1]};
}

/// Sum of (v (g - z^2 inverse))^2.
inline double weighted_complement(const double* v, const double* g, const double* z, double inverse,
                                  int rows) {
  Pair s0 = {}, s1 = {};
  for (int i = 0; i < rows; i += row_block) {
    const Pair z0 = load(z + i), z1 = load(z + i + 2);
    const Pair a = load(v + i) * (load(g + i) - inverse * (z0 * z0));
    const Pair b = load(v + i + 2) * (load(g + i + 2) - inverse * (z1 * z1));
    s0 += a * a;
    s1 += b * b;
  }
  return sum(s0, s1);
}

}  // namespace wearwell::row_kernels
