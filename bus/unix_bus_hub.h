#pragma once
#include <poll.h>

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <vector>

#include "bus/frame_record.h"

namespace edgepose {

struct UnixBusHubOptions {
  size_t max_members = 16;
  /// Frames that wait for one member; one that lets more pile up (a second of a busy bus) is cut off.
  size_t max_waiting = 4096;
  /// Instead of being cut off such a member loses what comes next, as a CAN controller does whose buffer is
  /// full: with a short queue a flooded bus starves its members, as a wire would, and delays nothing.
  bool loses_when_full = false;
};

struct UnixBusHubCounters {
  uint64_t passed_on = 0;      ///< frames that came in
  uint64_t lost = 0;           ///< frames that a member had no room for
  uint64_t slow_cut_off = 0;   ///< members that did not take their frames
  uint64_t wrong_cut_off = 0;  ///< members that sent what is no frame
  uint64_t turned_away = 0;    ///< connections beyond max_members
};

/// The wire of a UnixBus: every frame of a member goes to all other members, in the order it came. One thread
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
  void pass_on(const Member& from, const FrameRecord& record);
  void write_to(Member& member);
  void remove_gone();

  const UnixBusHubOptions options_;
  std::filesystem::path path_;
  int listener_ = -1;
  std::vector<std::unique_ptr<Member>> members_;
  std::vector<pollfd> watched_;
  UnixBusHubCounters counters_;
};

}  // namespace edgepose
