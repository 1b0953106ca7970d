/// What the thread sanitizer must not look at: Debian's Embree and TBB, which render the tests' images, are
/// not instrumented, so that what orders their threads is not seen. Part of every test program of the preset
/// `tsan`.

extern "C" const char*
__tsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier): the sanitizer's name
extern "C" const char* __tsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
  return "called_from_lib:libtbb.so.12\n"
         "called_from_lib:libembree3.so.3\n"
         "race:libtbb.so.12\n"
         "race:libembree3.so.3\n";
}
