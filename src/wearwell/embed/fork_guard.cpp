#include "wearwell/embed/fork_guard.h"

#include <tbb/global_control.h>
#include <unistd.h>

#include <atomic>

namespace wearwell::embed {
namespace {
std::atomic<pid_t> threads_of = 0;  // the process that started them
}

struct ForkGuard::Limit {
  tbb::global_control one{tbb::global_control::max_allowed_parallelism, 1};
};

ForkGuard::ForkGuard() {
  pid_t none = 0;
  const pid_t here = getpid();
  if (!threads_of.compare_exchange_strong(none, here) && none != here)
    limit_ = std::make_unique<Limit>();
}

ForkGuard::~ForkGuard() = default;

}  // namespace wearwell::embed
