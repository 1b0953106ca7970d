#pragma once
#include "bus/can_frame.h"
#include "canopen/object_dictionary.h"

namespace edgepose {

/// Process data as a drive's own mapping objects (1600, 1A00, ...) have them.
/// Fills `frame` (its data and size) from the mapped objects.
void pack_pdo(const ObjectDictionary& objects, uint16_t mapping, CanFrame& frame);
/// Writes the mapped objects; false (nothing is written) if the frame is shorter than the mapping.
bool unpack_pdo(ObjectDictionary& objects, uint16_t mapping, const CanFrame& frame);

}  // namespace edgepose
