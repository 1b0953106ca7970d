# Readers of depth images, cameras, test sets, result files, drill plans and model files.
find_package(ZLIB REQUIRED)
edgepose_fuzzer(depth_png_fuzz edgepose_files ZLIB::ZLIB)
foreach(reader camera bop_set bop_results drill_plan model_file)
  edgepose_fuzzer(${reader}_fuzz edgepose_files)
endforeach()

edgepose_fuzzer(shard_fuzz edgepose_evaluation)

# The program's own, from its sources: without what else the program links.
set(CLI ${PROJECT_SOURCE_DIR}/client/cli)
find_package(nlohmann_json REQUIRED)
edgepose_fuzzer(settings_fuzz edgepose_settings)
edgepose_fuzzer(scene_file_fuzz edgepose_files nlohmann_json::nlohmann_json)
target_sources(scene_file_fuzz PRIVATE ${CLI}/render_scene.cpp)
