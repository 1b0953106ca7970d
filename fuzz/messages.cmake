# Everything that takes bytes from the network, and logs.
find_package(ZLIB REQUIRED)
foreach(reader udpm decode depth_message lcm_log signed_command)
  edgepose_fuzzer(${reader}_fuzz edgepose_messaging ZLIB::ZLIB)
endforeach()
