// The cycle takes no memory: a program of its own, since it replaces operator new.
#include <cstdlib>
#include <new>

#include "tests/canopen/arm_on_wire.h"

namespace {

bool counts = false;
size_t allocations = 0;

}  // namespace

// Not inlined, or GCC 12 takes malloc and delete for a mismatch.
[[gnu::noinline]] void* operator new(size_t size) {
  if (counts) ++allocations;
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, size_t) noexcept { std::free(memory); }

namespace edgepose {
namespace {

/// Cycles of the master, counted; the drives in between are not.
void count_cycles(ArmOnWire& arm, int cycles) {
  for (int i = 0; i < cycles; ++i) {
    for (double& point : arm.set_points) point += 0.001;
    counts = true;
    arm.master.cycle(arm.now, arm.set_points);
    counts = false;
    for (const auto& drive : arm.drives) drive->step(arm.now + 5 * kMs);
    arm.now += 5 * kMs;
  }
}

TEST(Allocation, TheCountCounts) {
  counts = true;
  ::operator delete(::operator new(4));
  counts = false;
  EXPECT_EQ(allocations, 1u);
}

TEST(Allocation, NoneInTheCycleInMotionAndInAFault) {
  ArmOnWire arm;
  arm.enable_and_move();
  allocations = 0;
  count_cycles(arm, 200);
  ASSERT_EQ(arm.master.state().phase, MasterPhase::kEnabled) << arm.master.fault_text();
  arm.drives[2]->provoke(Provocation::kEmergency);
  count_cycles(arm, 50);
  EXPECT_EQ(arm.master.state().phase, MasterPhase::kFault);
  EXPECT_EQ(allocations, 0u);
}

}  // namespace
}  // namespace edgepose
