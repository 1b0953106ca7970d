#pragma once
#include <cstddef>
#include <cstdint>

/// Numbers that are computed side by side (vector extensions of GCC and clang). In functions marked
/// EDGEPOSE_WIDE_SIMD eight floats are one AVX2 register, elsewhere two of SSE: the same operations lane by
/// lane, so the bits are the same. Never passed by value between functions that are not inlined: how that is
/// done depends on the processor.
namespace edgepose {

inline constexpr size_t kLanes = 8;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float)), aligned(4), may_alias));
using LaneInts = int32_t __attribute__((vector_size(kLanes * sizeof(int32_t)), aligned(4), may_alias));

/// How many numbers there must be room for, so that the last ones fill all lanes.
inline constexpr size_t whole_lanes(size_t count) { return (count + kLanes - 1) / kLanes * kLanes; }

/// The lanes that start at an element of a plain array. A macro, as a function would have to return them.
#define EDGEPOSE_LANES_AT(array, index) (*reinterpret_cast<const Lanes*>((array) + (index)))

}  // namespace edgepose
