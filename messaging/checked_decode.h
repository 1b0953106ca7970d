#pragma once
#include <exception>
#include <span>
#include <string>

#include "edgepose_lcm/cloud_frame_t.hpp"
#include "edgepose_lcm/depth_frame_t.hpp"
#include "edgepose_lcm/drill_targets_t.hpp"
#include "edgepose_lcm/pose_estimates_t.hpp"
#include "edgepose_lcm/service_status_t.hpp"

namespace edgepose {

/// Empty if `bytes` can be decoded as the message of the second argument's type, else one line that says why
/// not. Every length is checked, nothing is allocated, and nothing may be left over. What the fields mean is
/// not looked at.
std::string check_lengths(std::span<const std::byte> bytes, const edgepose_lcm::depth_frame_t*);
std::string check_lengths(std::span<const std::byte> bytes, const edgepose_lcm::cloud_frame_t*);
std::string check_lengths(std::span<const std::byte> bytes, const edgepose_lcm::pose_estimates_t*);
std::string check_lengths(std::span<const std::byte> bytes, const edgepose_lcm::drill_targets_t*);
std::string check_lengths(std::span<const std::byte> bytes, const edgepose_lcm::service_status_t*);

/// Decodes what check_lengths() found sound. Returns why not, or an empty string; never throws, and never
/// allocates more than a small multiple of `bytes`.
template <class Message>
std::string decode_checked(std::span<const std::byte> bytes, Message& message) {
  if (std::string fault = check_lengths(bytes, &message); !fault.empty()) return fault;
  try {
    const int size = static_cast<int>(bytes.size());
    if (message.decode(bytes.data(), 0, size) == size) return "";
  } catch (const std::exception& failure) {
    return std::string("message: cannot be decoded: ") + failure.what();
  }
  return "message: cannot be decoded";
}

}  // namespace edgepose
