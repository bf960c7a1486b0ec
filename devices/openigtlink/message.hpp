// SPDX-License-Identifier: Apache-2.0
// Messages of OpenIGTLink, the protocol of trackers and 3D Slicer (openigtlink.org, protocol versions 1 to 3). On the
// line: big-endian, mm. Here: SI.
#pragma once

#include "dsp/core/types.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::openigtlink {

/// CRC-64 of ECMA-182, which the protocol uses for the body.
std::uint64_t crc64(std::span<const std::uint8_t> bytes, std::uint64_t crc = 0) noexcept;

struct Message {
    std::string type;  ///< "TRANSFORM"
    std::string device;  ///< name of the transform: "StylusToTracker"
    std::vector<std::uint8_t> content;  ///< the body without extended header and metadata
    std::string status;  ///< of the transform, from the metadata of version 2 and later; "" if not given
};

/// Assembles messages from any pieces. The input is not trusted.
class MessageReader {
public:
    static constexpr std::size_t longest_body = std::size_t{1} << 20;

    void take(std::span<const std::uint8_t> bytes);
    /// Returns the next complete message with a correct checksum.
    std::optional<Message> next();

    /// True if the stream is corrupt (bad header, or a body longer than `longest_body`); parsing cannot resume.
    bool is_broken() const { return is_broken_; }
    std::uint64_t bad_checksums() const { return bad_checksums_; }

private:
    std::vector<std::uint8_t> bytes_;
    std::size_t read_ = 0;
    bool is_broken_ = false;
    std::uint64_t bad_checksums_ = 0;
};

/// Returns the pose in a TRANSFORM, POSITION or TDATA message, in m. `wanted`: name of the transform; "": the first.
/// Empty if the message has no such pose, if its status reports that the tool is not visible, or if its matrix is not a
/// rotation.
std::optional<Pose> pose_in(const Message& message, std::string_view wanted);

/// Builds a TRANSFORM message of version 1. `device` is cut to 19 characters. `seconds`: time since 1970.
std::vector<std::uint8_t> transform_message(std::string_view device, const Pose& pose, double seconds);

}  // namespace tactus::openigtlink
