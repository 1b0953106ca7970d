# Readers of calibration files: hand-eye, its samples, tools, teaching.
edgepose_fuzzer(calibration_fuzz edgepose_calibration)
