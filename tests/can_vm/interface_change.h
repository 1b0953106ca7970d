#pragma once
#include <gtest/gtest.h>
#include <linux/pkt_sched.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstring>

namespace edgepose {

/// Changes of vcan0 in the middle of a session, by system calls: to run `tc` or `ip` takes a guest 50 ms and
/// more, in which nothing else keeps its time.
class InterfaceChange {
 public:
  InterfaceChange() : socket_(socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE)) {}
  InterfaceChange(const InterfaceChange&) = delete;
  InterfaceChange& operator=(const InterfaceChange&) = delete;
  ~InterfaceChange() { close(socket_); }

  /// As `tc qdisc add dev vcan0 root tbf rate R burst B limit L`: bytes/s, bytes, bytes; a frame is 16 bytes.
  void slow_down(uint32_t rate, uint32_t burst, uint32_t limit) {
    begin(RTM_NEWQDISC, NLM_F_CREATE | NLM_F_EXCL);
    attribute(TCA_KIND, "tbf", 4);
    rtattr* options = attribute(TCA_OPTIONS, nullptr, 0);
    tc_tbf_qopt token_bucket{};
    token_bucket.rate.rate = rate;
    token_bucket.rate.linklayer = 1;  // ethernet: no table of rates is needed
    token_bucket.limit = limit;
    attribute(TCA_TBF_PARMS, &token_bucket, sizeof(token_bucket));
    attribute(TCA_TBF_BURST, &burst, sizeof(burst));
    options->rta_len = static_cast<uint16_t>(end() - reinterpret_cast<char*>(options));
    ask();
  }
  void full_speed() {
    begin(RTM_DELQDISC, 0);
    ask();
  }
  void down() {
    ifreq request{};
    std::strcpy(request.ifr_name, "vcan0");
    const int any = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    EXPECT_EQ(ioctl(any, SIOCSIFFLAGS, &request), 0) << std::strerror(errno);
    close(any);
  }
  void remove() {
    buffer_ = {};
    header()->nlmsg_type = RTM_DELLINK;
    header()->nlmsg_flags = NLM_F_REQUEST | NLM_F_ACK;
    header()->nlmsg_len = NLMSG_LENGTH(sizeof(ifinfomsg));
    static_cast<ifinfomsg*>(NLMSG_DATA(header()))->ifi_index = static_cast<int>(if_nametoindex("vcan0"));
    ask();
  }

 private:
  nlmsghdr* header() { return reinterpret_cast<nlmsghdr*>(buffer_.data()); }
  char* end() { return buffer_.data() + NLMSG_ALIGN(header()->nlmsg_len); }
  void begin(uint16_t type, int flags) {
    buffer_ = {};
    header()->nlmsg_type = type;
    header()->nlmsg_flags = static_cast<uint16_t>(NLM_F_REQUEST | NLM_F_ACK | flags);
    header()->nlmsg_len = NLMSG_LENGTH(sizeof(tcmsg));
    auto* message = static_cast<tcmsg*>(NLMSG_DATA(header()));
    message->tcm_ifindex = static_cast<int>(if_nametoindex("vcan0"));
    message->tcm_parent = TC_H_ROOT;
  }
  rtattr* attribute(uint16_t type, const void* data, size_t size) {
    auto* made = reinterpret_cast<rtattr*>(end());
    made->rta_type = type;
    made->rta_len = static_cast<uint16_t>(RTA_LENGTH(size));
    if (size > 0) std::memcpy(RTA_DATA(made), data, size);
    header()->nlmsg_len = NLMSG_ALIGN(header()->nlmsg_len) + static_cast<uint32_t>(RTA_ALIGN(made->rta_len));
    return made;
  }
  void ask() {
    ASSERT_EQ(send(socket_, buffer_.data(), header()->nlmsg_len, 0),
              static_cast<ssize_t>(header()->nlmsg_len));
    ASSERT_GT(recv(socket_, buffer_.data(), buffer_.size(), 0), 0);
    ASSERT_EQ(header()->nlmsg_type, NLMSG_ERROR);
    const int error = static_cast<const nlmsgerr*>(NLMSG_DATA(header()))->error;
    EXPECT_EQ(error, 0) << std::strerror(-error);
  }

  const int socket_;
  alignas(nlmsghdr) std::array<char, 1024> buffer_{};
};

}  // namespace edgepose
