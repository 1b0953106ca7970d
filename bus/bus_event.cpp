#include "bus/bus_event.h"

#include <linux/can/error.h>

namespace edgepose {
namespace {

/// CAN_ERR_CRTL: the second byte says what became of the controller.
BusEvent controller_event(uint8_t status) {
  if (status & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) return BusEvent::kErrorPassive;
  if (status & (CAN_ERR_CRTL_RX_OVERFLOW | CAN_ERR_CRTL_TX_OVERFLOW)) return BusEvent::kControllerOverrun;
  if (status & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) return BusEvent::kErrorWarning;
  if (status & CAN_ERR_CRTL_ACTIVE) return BusEvent::kErrorActive;
  return BusEvent::kBusError;
}

}  // namespace

const char* name_of(BusEvent event) {
  switch (event) {
    case BusEvent::kNone:
      return "nothing";
    case BusEvent::kBusOff:
      return "bus-off";
    case BusEvent::kErrorPassive:
      return "error passive";
    case BusEvent::kErrorWarning:
      return "error warning";
    case BusEvent::kErrorActive:
      return "error active";
    case BusEvent::kControllerOverrun:
      return "controller overrun";
    case BusEvent::kTransmitTimeout:
      return "transmit timeout";
    case BusEvent::kLostArbitration:
      return "lost arbitration";
    case BusEvent::kProtocolViolation:
      return "protocol violation";
    case BusEvent::kTransceiver:
      return "transceiver fault";
    case BusEvent::kNoAcknowledge:
      return "no acknowledge";
    case BusEvent::kBusError:
      return "bus error";
    case BusEvent::kRestarted:
      return "restarted";
    case BusEvent::kDown:
      return "down";
    case BusEvent::kEnd:
      return "end of the recording";
  }
  return "unknown";
}

BusEvent bus_event_of(uint32_t error_class, const std::array<uint8_t, 8>& data) {
  if (error_class & CAN_ERR_BUSOFF) return BusEvent::kBusOff;
  if (error_class & CAN_ERR_RESTARTED) return BusEvent::kRestarted;
  if (error_class & CAN_ERR_CRTL) return controller_event(data[1]);
  if (error_class & CAN_ERR_TRX) return BusEvent::kTransceiver;
  if (error_class & CAN_ERR_TX_TIMEOUT) return BusEvent::kTransmitTimeout;
  if (error_class & CAN_ERR_ACK) return BusEvent::kNoAcknowledge;
  if (error_class & CAN_ERR_PROT) return BusEvent::kProtocolViolation;
  if (error_class & CAN_ERR_LOSTARB) return BusEvent::kLostArbitration;
  return BusEvent::kBusError;
}

}  // namespace edgepose
