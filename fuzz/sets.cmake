# Readers of depth images, cameras, test sets, result files, drill plans and model files.
find_package(ZLIB REQUIRED)
edgepose_fuzzer(depth_png_fuzz edgepose_files ZLIB::ZLIB)
foreach(reader camera bop_set bop_results drill_plan model_file)
  edgepose_fuzzer(${reader}_fuzz edgepose_files)
endforeach()
