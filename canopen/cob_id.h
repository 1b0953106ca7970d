#pragma once
#include <cstdint>

/// The predefined connection set (CiA 301, 7.3.5): an identifier is a function and a node, 1 to 127.
namespace edgepose::cob_id {

inline constexpr uint16_t kNmt = 0x000, kSync = 0x080;
inline constexpr uint16_t kEmergency = 0x080;  ///< + node, as all that follow
inline constexpr uint16_t kTpdo1 = 0x180, kRpdo1 = 0x200, kTpdo2 = 0x280;
inline constexpr uint16_t kSdoAnswer = 0x580;   ///< server to client
inline constexpr uint16_t kSdoRequest = 0x600;  ///< client to server
inline constexpr uint16_t kHeartbeat = 0x700;
inline constexpr int kMaxNode = 127;
/// In a COB-ID entry (1400:01, 1800:01, 1014): set if the object is switched off.
inline constexpr uint32_t kNotValid = 0x8000'0000;

inline constexpr uint16_t function_of(uint16_t id) { return id & 0x780; }
inline constexpr int node_of(uint16_t id) { return id & 0x7f; }

}  // namespace edgepose::cob_id
