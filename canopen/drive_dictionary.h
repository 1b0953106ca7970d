#pragma once
#include "canopen/drive_options.h"
#include "canopen/object_dictionary.h"

namespace edgepose {

/// The objects of a simulated drive with their defaults: the communication profile (CiA 301) and those of CiA
/// 402 that mode 8 needs.
ObjectDictionary make_drive_dictionary(const DriveOptions& options);

/// Whether a write to the PDO objects keeps CiA 301's rules (7.5.2.35 to 38): the mapping is changed only
/// while the PDO is off and its count 0, names objects that are there and can be mapped, and fits into eight
/// bytes.
SdoAbort check_pdo_write(const ObjectDictionary& objects, ObjectId id, int64_t value);

}  // namespace edgepose
