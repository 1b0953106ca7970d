#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "simulator/work_cell.h"

namespace edgepose {

enum class SimPublish : uint8_t { kDepth, kPoses, kNothing };
enum class SimStart : uint8_t { kRandom, kStandoff };

/// What edgepose-sim is started with (docs/simulator.md).
struct SimulationOptions {
  WorkCellOptions cell;
  std::string bus = "unix:/tmp/edgepose-sim.sock";  ///< a Unix bus, which it then offers, or a CAN interface
  std::string lcm_url;                              ///< empty: messaging's default
  SimPublish publish = SimPublish::kDepth;          ///< what it says over LCM, besides the truth
  double rate = 0;                       ///< [Hz] of frames or poses; 0: 10 for depth, 30 for poses
  std::string camera = "flange";         ///< name of the camera
  std::string sensor = "kinect_narrow";  ///< or one of SensorModel::named()
  bool noise = true;  ///< the controller is told as much wrong as in the paper; false: the truth
  uint64_t seed = 1;  ///< of start, told, sensor
  SimStart start = SimStart::kRandom;
  std::filesystem::path told;     ///< folder for what the controller is told; empty: not written
  std::filesystem::path truth;    ///< CSV; empty: none
  std::filesystem::path key;      ///< signs poses; empty: not signed
  std::filesystem::path control;  ///< Unix socket for commands; empty: none
  int duplicate_node = 0;         ///< 1 to 6: there are two drives of this number; 0: none
  int absent_node = 0;            ///< 1 to 6: this drive is not there; 0: none
  int foreign_node = 0;           ///< 1 to 6: this drive says it is another make's (1018); 0: none
  bool keep_awake = false;        ///< the processors never sleep (daemon/keep_awake.h)
  bool ready = false;             ///< prints READY on stdout when everything listens

  std::string check() const;  ///< what is wrong, the option's name first, or nothing
};

}  // namespace edgepose
