#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "canopen/objects.h"
#include "canopen/sdo_abort.h"

/// The eight bytes of SDO messages, expedited and segmented (CiA 301, 7.2.4.3). The upper three bits of the
/// first are the command; it means different things in the two directions.
namespace edgepose::sdo {

using Bytes = std::array<uint8_t, 8>;

/// From the client.
inline constexpr uint8_t kDownloadSegment = 0x00, kDownload = 0x20, kUpload = 0x40, kUploadSegment = 0x60;
/// From the server.
inline constexpr uint8_t kSegmentOfUpload = 0x00, kSegmentTaken = 0x20, kUploadAnswer = 0x40,
                         kDownloadTaken = 0x60;
/// From either.
inline constexpr uint8_t kAbort = 0x80;

inline constexpr uint8_t kExpedited = 0x02, kSizeGiven = 0x01, kToggle = 0x10, kLast = 0x01;
inline constexpr size_t kMaxExpedited = 4, kMaxSegment = 7;
/// Longer transfers are aborted (out of memory), by the client and by the server.
inline constexpr size_t kMaxTransfer = 256;

inline constexpr uint8_t command_of(const Bytes& bytes) { return bytes[0] & 0xe0; }

/// A message that names an object and bears no data: requests for an upload, confirmations of a download.
Bytes plain(uint8_t command, ObjectId id);
/// Of at most four bytes: all data in the first message. `command`: kDownload or kUploadAnswer.
Bytes expedited(uint8_t command, ObjectId id, std::span<const uint8_t> data);
/// Segments follow, `size` bytes in all.
Bytes segmented(uint8_t command, ObjectId id, uint32_t size);
/// At most seven bytes of data. `command`: kDownloadSegment or kSegmentOfUpload.
Bytes segment(uint8_t command, bool toggle, bool last, std::span<const uint8_t> data);
Bytes abort(ObjectId id, SdoAbort reason);

ObjectId object_of(const Bytes& bytes);
SdoAbort reason_of(const Bytes& bytes);
/// The data of a first message, if it is expedited; all four bytes if their number is not given.
std::span<const uint8_t> expedited_data(const Bytes& bytes);
/// The data of a segment.
std::span<const uint8_t> segment_data(const Bytes& bytes);
/// What a first message that is not expedited says will follow; 0 if it does not.
uint32_t announced_size(const Bytes& bytes);

}  // namespace edgepose::sdo
