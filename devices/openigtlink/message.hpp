// SPDX-License-Identifier: Apache-2.0
// Messages of OpenIGTLink, which trackers and 3D Slicer speak (openigtlink.org, protocol versions 1 to 3). On the line:
// big-endian, mm. Here: SI.
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

/// CRC-64 of ECMA-182, as the protocol uses it for the body.
std::uint64_t crc64(std::span<const std::uint8_t> bytes, std::uint64_t crc = 0) noexcept;

struct Message {
    std::string type;  ///< "TRANSFORM"
    std::string device;  ///< whose values it has: "StylusToTracker"
    std::vector<std::uint8_t> content;  ///< the body without extended header and metadata
    std::string status;  ///< of the transform, by the metadata of version 2 and later; "" when it is not told
};

/// Puts messages together from any pieces. What a peer sends is not trusted.
class MessageReader {
public:
    static constexpr std::size_t longest_body = std::size_t{1} << 20;

    void take(std::span<const std::uint8_t> bytes);
    /// The next whole message whose checksum is right.
    std::optional<Message> next();

    /// A header that is none, or a body longer than `longest_body`: nothing after it can be read.
    bool is_broken() const { return is_broken_; }
    std::uint64_t bad_checksums() const { return bad_checksums_; }

private:
    std::vector<std::uint8_t> bytes_;
    std::size_t read_ = 0;
    bool is_broken_ = false;
    std::uint64_t bad_checksums_ = 0;
};

/// The pose in a TRANSFORM, POSITION or TDATA message, in m. `wanted`: name of the transform; "": the first. None when the
/// message has no such pose, when its status says that the tool is not seen, or when its matrix is no rotation.
std::optional<Pose> pose_in(const Message& message, std::string_view wanted);

/// A TRANSFORM message of version 1. `device`: at most 19 characters are sent. `seconds`: time since 1970.
std::vector<std::uint8_t> transform_message(std::string_view device, const Pose& pose, double seconds);

}  // namespace tactus::openigtlink
