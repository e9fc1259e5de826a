#pragma once

#include <memory>

namespace wearwell::embed {

/// While it lives, a process that was forked after the library had started its threads uses one
/// thread: the others do not exist there.
class ForkGuard {
 public:
  ForkGuard();
  ~ForkGuard();
  ForkGuard(const ForkGuard&) = delete;
  ForkGuard& operator=(const ForkGuard&) = delete;

  /// `threads`, or 1 in such a process.
  int most(int threads) const { return limit_ ? 1 : threads; }

 private:
  struct Limit;
  std::unique_ptr<Limit> limit_;
};

}  // namespace wearwell::embed
