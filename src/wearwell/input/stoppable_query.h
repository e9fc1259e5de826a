#pragma once

#include <duckdb.h>

#include <memory>
#include <stop_token>

#include "wearwell/base/stop_scope.h"

namespace wearwell {

/// Interrupts the query of a connection once the work of this thread is asked to stop.
class StoppableQuery {
 public:
  explicit StoppableQuery(duckdb_connection connection)
      : signal_(current_stop_signal()),
        on_stop_(signal_ ? signal_->requested : std::stop_token(), Interrupt{connection}) {}

 private:
  struct Interrupt {
    duckdb_connection connection;
    void operator()() const { duckdb_interrupt(connection); }
  };
  std::shared_ptr<const StopSignal> signal_;
  std::stop_callback<Interrupt> on_stop_;
};

}  // namespace wearwell
