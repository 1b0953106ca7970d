#pragma once

/// Marks a function of plain float loops to be compiled twice, for AVX2 and for the baseline; the loader
/// picks. Only for functions that no Eigen type passes through: Eigen's alignment must not depend on the
/// processor (Debian's PCL is built without AVX). The bits are the same either way, as no multiply-adds are
/// fused
/// (-ffp-contract=off).
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)  // their start-up code runs after the loader has to pick
#define EDGEPOSE_WIDE_SIMD __attribute__((target_clones("avx2", "default")))
#else
#define EDGEPOSE_WIDE_SIMD
#endif

/// Before a loop whose arrays do not overlap, so that the compiler need not check that.
#if defined(__GNUC__) && !defined(__clang__)
#define EDGEPOSE_NO_OVERLAP _Pragma("GCC ivdep")
#else
#define EDGEPOSE_NO_OVERLAP
#endif
