#pragma once
#include <cstdint>

namespace edgepose {

/// [ns] on CLOCK_MONOTONIC, as std::chrono::steady_clock: setting the wall clock does not touch it.
int64_t steady_ns();
/// [ns] from the steady clock to the wall clock (since 1970, UTC), now.
int64_t wall_minus_steady_ns();
/// Sleeps until then; a signal does not end it.
void sleep_until(int64_t deadline_ns);
/// Waits until `descriptor` has input (or was hung up), at most until `deadline_ns`; 0: does not wait. -1 as
/// descriptor: waits until the deadline. True if there is input.
bool wait_for_input(int descriptor, int64_t deadline_ns);

}  // namespace edgepose
