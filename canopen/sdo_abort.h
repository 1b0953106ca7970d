#pragma once
#include <cstdint>

namespace edgepose {

/// Abort codes of SDO transfers (CiA 301, table 22); any other number may come as well.
enum class SdoAbort : uint32_t {
  kNone = 0,
  kToggle = 0x0503'0000,
  kTimeout = 0x0504'0000,
  kUnknownCommand = 0x0504'0001,
  kOutOfMemory = 0x0504'0005,
  kUnsupportedAccess = 0x0601'0000,
  kWriteOnly = 0x0601'0001,
  kReadOnly = 0x0601'0002,
  kNoObject = 0x0602'0000,
  kNotMappable = 0x0604'0041,
  kPdoTooLong = 0x0604'0042,
  kWrongLength = 0x0607'0010,
  kTooLong = 0x0607'0012,
  kTooShort = 0x0607'0013,
  kNoSubIndex = 0x0609'0011,
  kInvalidValue = 0x0609'0030,
  kTooHigh = 0x0609'0031,
  kTooLow = 0x0609'0032,
  kGeneral = 0x0800'0000,
  kDeviceState = 0x0800'0022,
};

/// The standard's words, in short; "unknown abort code" for what is not in its table.
const char* text_of(SdoAbort abort);

}  // namespace edgepose
