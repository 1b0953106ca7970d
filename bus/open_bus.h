#pragma once
#include <memory>
#include <string>
#include <vector>

#include "bus/can_bus.h"

namespace edgepose {

/// Opens the bus that `name` means: "can0" (any CAN interface), "unix:/path" (a UnixBusHub's socket) or
/// "pcap:/file" (a recording). `ids`: where the system can filter, only these are received; empty: all.
/// `confirm`: where the system can, own frames of these are counted when they have been on the wire
/// (BusCounters::unconfirmed). Throws InputError, one line, if there is no such bus.
std::unique_ptr<CanBus> open_bus(const std::string& name, const std::vector<uint16_t>& ids = {},
                                 const std::vector<uint16_t>& confirm = {});

}  // namespace edgepose
