# What the daemon takes: requests, its configuration, its registry, what its training child says; and a whole
# received message on its way to the matcher.
find_package(nlohmann_json REQUIRED)
foreach(reader request manifest service_options training_report intake connection)
  edgepose_fuzzer(${reader}_fuzz edgepose_server nlohmann_json::nlohmann_json)
endforeach()
