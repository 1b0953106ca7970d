#pragma once
#include <poll.h>

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "bus/arbitration.h"
#include "bus/frame_record.h"

namespace edgepose {

struct UnixBusHubOptions {
  size_t max_members = 16;
  /// Frames that wait for one member; one that lets more pile up (a second of a busy bus) is cut off.
  size_t max_waiting = 4096;
  /// [frames/s] of the wire, the most urgent first; 8000 are a bus of 1 Mbit/s. 0: no limit, in the order
  /// that they come.
  double rate = 0;
};

struct UnixBusHubCounters {
  uint64_t passed_on = 0;      ///< frames that came in
  uint64_t lost = 0;           ///< frames that the wire had no time for
  uint64_t slow_cut_off = 0;   ///< members that did not take their frames
  uint64_t wrong_cut_off = 0;  ///< members that sent what is no frame
  uint64_t turned_away = 0;    ///< connections beyond max_members
};

/// The wire of a UnixBus: every frame of a member goes to all other members. One thread
/// calls serve(); none of it throws.
class UnixBusHub {
 public:
  /// Listens at `path` (mode 0660), which is removed at the end. Throws InputError if it cannot, or another
  /// hub listens there; the socket of one that was killed is replaced.
  explicit UnixBusHub(const std::filesystem::path& path, const UnixBusHubOptions& options = {});
  UnixBusHub(const UnixBusHub&) = delete;
  UnixBusHub& operator=(const UnixBusHub&) = delete;
  ~UnixBusHub();

  /// Waits for frames until `deadline_ns` (steady) and passes on what has come; returns after the first
  /// batch.
  void serve(int64_t deadline_ns);

  size_t members() const { return members_.size(); }
  const UnixBusHubCounters& counters() const { return counters_; }

 private:
  struct Member {
    int socket;
    std::deque<FrameRecord> waiting;
    bool gone = false;
  };
  void accept_members();
  void read_from(Member& member);
  void take(int from, const FrameRecord& record);
  void release(int64_t now_ns);
  void pass_on(int from, const FrameRecord& record);
  void write_to(Member& member);
  void remove_gone();

  const UnixBusHubOptions options_;
  std::filesystem::path path_;
  int listener_ = -1;
  std::vector<std::unique_ptr<Member>> members_;
  std::vector<pollfd> watched_;
  std::optional<Arbitration<int>> wire_;  ///< by the sender's socket
  UnixBusHubCounters counters_;
};

}  // namespace edgepose
