# Language, warnings and sanitizers, for every target alike.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # False alarms of GCC 12: inside Eigen at -O3, and of overlaps in std::string's own copying (its bug 105651).
  add_compile_options(-Wno-maybe-uninitialized -Wno-array-bounds -Wno-restrict)
endif()
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64")
  # SSE4.2 keeps Eigen's 16-byte alignment, so that objects may be shared with Debian's PCL;
  # anything wider (AVX) would not.
  add_compile_options(-march=x86-64-v2)
endif()
# The same bits on every build: no contraction into fused multiply-adds. The other two change no result; without
# them errno and floating-point traps, which nothing here asks for, keep loops with a root or a choice scalar.
add_compile_options(-ffp-contract=off -fno-math-errno -fno-trapping-math)

if(EDGEPOSE_SANITIZE)
  add_compile_options(-fsanitize=${EDGEPOSE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  # Instrumented code sets off more false alarms of the optimiser; the release build judges warnings.
  add_compile_options(-Wno-error)
  add_link_options(-fsanitize=${EDGEPOSE_SANITIZE})
  if(EDGEPOSE_SANITIZE MATCHES "undefined" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # A check at each access that a page fault or the address sanitizer makes as well; it takes Eigen's code half as
    # long again to compile. The fuzzers, built by clang, keep it.
    add_compile_options(-fno-sanitize=null,alignment,object-size)
  endif()
endif()
if(EDGEPOSE_COVERAGE)
  add_compile_options(--coverage)
  add_link_options(--coverage)
endif()

if(EDGEPOSE_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

# edgepose_joinable(TARGET): clang-tidy may see its sources joined (tools/check_tidy.sh), which includes them.
function(edgepose_joinable target)
  set_target_properties(${target} PROPERTIES
    UNITY_BUILD_CODE_BEFORE_INCLUDE "// NOLINTNEXTLINE(bugprone-suspicious-include)")
endfunction()

# edgepose_library(NAME SOURCES... ): one static library a folder, headers included as "folder/file.h".
function(edgepose_library name)
  add_library(${name} STATIC ${ARGN})
  edgepose_joinable(${name})
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR})
endfunction()
