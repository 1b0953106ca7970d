# What comes from a CAN bus or a recording of one: captures, SDO messages, frames to the master and to a drive.
foreach(reader pcap sdo master drive)
  edgepose_fuzzer(${reader}_fuzz edgepose_canopen)
endforeach()
