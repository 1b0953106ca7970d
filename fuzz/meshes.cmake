# Readers of mesh and cloud files, each followed by check_mesh() and mend_mesh().
foreach(format ply stl obj pcd)
  edgepose_fuzzer(${format}_fuzz edgepose_files)
endforeach()
