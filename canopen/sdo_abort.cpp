#include "canopen/sdo_abort.h"

namespace edgepose {
namespace {

struct AbortText {
  uint32_t code;
  const char* text;
};

constexpr AbortText kAbortTexts[] = {
    {0x0000'0000, "no abort"},
    {0x0503'0000, "toggle bit not alternated"},
    {0x0504'0000, "SDO protocol timed out"},
    {0x0504'0001, "command specifier not valid or unknown"},
    {0x0504'0002, "invalid block size"},
    {0x0504'0003, "invalid sequence number"},
    {0x0504'0004, "CRC error"},
    {0x0504'0005, "out of memory"},
    {0x0601'0000, "unsupported access to an object"},
    {0x0601'0001, "attempt to read a write-only object"},
    {0x0601'0002, "attempt to write a read-only object"},
    {0x0602'0000, "object does not exist"},
    {0x0604'0041, "object cannot be mapped to the PDO"},
    {0x0604'0042, "mapped objects would exceed the PDO's length"},
    {0x0604'0043, "general parameter incompatibility"},
    {0x0604'0047, "general internal incompatibility in the device"},
    {0x0606'0000, "access failed due to a hardware error"},
    {0x0607'0010, "length of the parameter does not match"},
    {0x0607'0012, "length of the parameter too high"},
    {0x0607'0013, "length of the parameter too low"},
    {0x0609'0011, "sub-index does not exist"},
    {0x0609'0030, "invalid value for the parameter"},
    {0x0609'0031, "value of the parameter too high"},
    {0x0609'0032, "value of the parameter too low"},
    {0x0609'0036, "maximum is less than minimum"},
    {0x060a'0023, "resource not available"},
    {0x0800'0000, "general error"},
    {0x0800'0020, "data cannot be transferred or stored"},
    {0x0800'0021, "data cannot be stored: local control"},
    {0x0800'0022, "data cannot be stored in the present device state"},
    {0x0800'0023, "no object dictionary present"},
    {0x0800'0024, "no data available"},
};

}  // namespace

const char* text_of(SdoAbort abort) {
  for (const AbortText& known : kAbortTexts)
    if (known.code == static_cast<uint32_t>(abort)) return known.text;
  return "unknown abort code";
}

}  // namespace edgepose
