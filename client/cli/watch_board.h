#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "edgepose_lcm/drill_targets_t.hpp"
#include "edgepose_lcm/pose_estimates_t.hpp"
#include "edgepose_lcm/service_status_t.hpp"

namespace edgepose {

/// The newest of everything, as a table that is redrawn in place. Bounded, whatever comes.
class WatchBoard {
 public:
  void show(const edgepose_lcm::pose_estimates_t& answer, int64_t receive_utime);
  void show(const edgepose_lcm::drill_targets_t& targets);
  void show(const edgepose_lcm::service_status_t& status);

  /// The table, and below it `footer`, as text that draws over what stood on the terminal before; nothing is
  /// longer or wider than the terminal.
  std::string drawing(const std::vector<std::string>& footer) const;

 private:
  struct Camera {
    edgepose_lcm::pose_estimates_t answer;
    int64_t receive_utime = 0;
    uint64_t answers = 0;
    std::map<std::string, int64_t> dropped;
    edgepose_lcm::drill_targets_t targets;
  };
  Camera* camera(const std::string& name);
  std::vector<std::string> lines() const;

  std::map<std::string, Camera> cameras_;
  edgepose_lcm::service_status_t status_{};
};

}  // namespace edgepose
