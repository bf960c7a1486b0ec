// SPDX-License-Identifier: Apache-2.0
#include "devices/openigtlink/message.hpp"

#include "dsp/core/rotation.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace tactus::openigtlink {

namespace {

constexpr std::size_t header_size = 58, name_size = 20, type_size = 12, transform_size = 48;
constexpr double loosest_rotation = 1e-2;  // of rows whose lengths should be 1

constexpr std::array<std::uint64_t, 256> crc_table() {
    std::array<std::uint64_t, 256> table{};
    for (std::uint64_t i = 0; i < 256; ++i) {
        std::uint64_t crc = i << 56;
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 63 ? crc << 1 ^ 0x42F0E1EBA9EA3693u : crc << 1;
        table[i] = crc;
    }
    return table;
}

/// Reads big-endian values one after the other; zeros behind the end.
class Big {
public:
    explicit Big(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    std::uint64_t number(std::size_t size) {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < size; ++i, ++at_) value = value << 8 | (at_ < bytes_.size() ? bytes_[at_] : 0u);
        return value;
    }
    double real() { return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(number(4)))); }
    /// Text that ends at its size or at a zero.
    std::string text(std::size_t size) {
        std::string text;
        for (std::size_t i = 0; i < size && at_ + i < bytes_.size() && bytes_[at_ + i] != 0; ++i)
            text += static_cast<char>(bytes_[at_ + i]);
        at_ += size;
        return text;
    }
    void skip(std::size_t size) { at_ += size; }

private:
    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

void append(std::vector<std::uint8_t>& bytes, std::uint64_t value, std::size_t size) {
    for (std::size_t i = size; i-- > 0;) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}
void append(std::vector<std::uint8_t>& bytes, std::string_view text, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i)
        bytes.push_back(i + 1 < size && i < text.size() ? static_cast<std::uint8_t>(text[i]) : std::uint8_t{0});
}
void append_real(std::vector<std::uint8_t>& bytes, double value) {
    append(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4);
}

std::optional<Pose> checked(const glm::dmat3& turn, const Vec3& millimetres) {
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const double product = glm::dot(turn[i], turn[j]);
            if (!(std::abs(product - (i == j ? 1.0 : 0.0)) < loosest_rotation)) return std::nullopt;
        }
    if (!(glm::determinant(turn) > 0.0)) return std::nullopt;
    const Pose pose{millimetres * 1e-3, glm::normalize(glm::quat_cast(turn))};
    return is_valid(pose) ? std::optional(pose) : std::nullopt;
}

/// Three columns of the rotation, then the translation.
std::optional<Pose> matrix(Big& in) {
    glm::dmat3 turn;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) turn[column][row] = in.real();
    Vec3 at;
    for (int row = 0; row < 3; ++row) at[row] = in.real();
    return checked(turn, at);
}

std::optional<Pose> position(const Message& message) {
    Big in(message.content);
    Vec3 at;
    for (int i = 0; i < 3; ++i) at[i] = in.real();
    Quat turn(1.0, 0.0, 0.0, 0.0);
    if (message.content.size() == 24) {  // x, y, z; w follows from their length
        for (const int i : {0, 1, 2}) (&turn.x)[i] = in.real();
        const double rest = 1.0 - turn.x * turn.x - turn.y * turn.y - turn.z * turn.z;
        turn.w = std::sqrt(std::max(rest, 0.0));
    } else if (message.content.size() == 28) {
        turn.x = in.real();
        turn.y = in.real();
        turn.z = in.real();
        turn.w = in.real();
    } else if (message.content.size() != 12) return std::nullopt;
    if (!(std::abs(glm::length(turn) - 1.0) < loosest_rotation)) return std::nullopt;
    const Pose pose{at * 1e-3, glm::normalize(turn)};
    return is_valid(pose) ? std::optional(pose) : std::nullopt;
}

/// The value of a key of the metadata: how many, then for each the sizes and the encoding, then all texts.
std::string metadata_value(std::span<const std::uint8_t> header, std::span<const std::uint8_t> texts,
                           std::string_view key_end) {
    Big in(header);
    std::size_t at = 0;
    for (std::uint64_t left = in.number(2); left > 0 && at <= texts.size(); --left) {
        const std::uint64_t key_size = in.number(2);
        in.skip(2);
        const std::uint64_t value_size = in.number(4);
        if (key_size + value_size > texts.size() - at) return {};
        const std::string key(texts.begin() + static_cast<std::ptrdiff_t>(at),
                              texts.begin() + static_cast<std::ptrdiff_t>(at + key_size));
        if (key.ends_with(key_end))
            return {texts.begin() + static_cast<std::ptrdiff_t>(at + key_size),
                    texts.begin() + static_cast<std::ptrdiff_t>(at + key_size + value_size)};
        at += key_size + value_size;
    }
    return {};
}

/// Takes extended header and metadata of version 2 and later away.
void strip(Message& message) {
    const std::span<const std::uint8_t> body(message.content);
    Big in(body);
    const std::uint64_t extended = in.number(2), header = in.number(2), texts = in.number(4);
    if (extended < 12 || extended + header + texts > body.size()) {
        message.content.clear();
        return;
    }
    const std::size_t end = body.size() - header - texts;
    message.status = metadata_value(body.subspan(end, header), body.subspan(end + header), "Status");
    message.content = {body.begin() + static_cast<std::ptrdiff_t>(extended),
                       body.begin() + static_cast<std::ptrdiff_t>(end)};
}

}  // namespace

std::uint64_t crc64(std::span<const std::uint8_t> bytes, std::uint64_t crc) noexcept {
    static constexpr std::array<std::uint64_t, 256> table = crc_table();
    for (const std::uint8_t byte : bytes) crc = table[(crc >> 56 ^ byte) & 0xFF] ^ crc << 8;
    return crc;
}

void MessageReader::take(std::span<const std::uint8_t> bytes) {
    if (is_broken_) return;
    if (read_ > 0) {
        bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(read_));
        read_ = 0;
    }
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

std::optional<Message> MessageReader::next() {
    while (!is_broken_ && bytes_.size() - read_ >= header_size) {
        const std::span<const std::uint8_t> rest = std::span(bytes_).subspan(read_);
        Big in(rest);
        const std::uint64_t version = in.number(2);
        Message message;
        message.type = in.text(type_size);
        message.device = in.text(name_size);
        in.skip(8);  // time
        const std::uint64_t size = in.number(8), sum = in.number(8);
        is_broken_ = version < 1 || version > 3 || message.type.empty() || size > longest_body;
        if (is_broken_ || rest.size() < header_size + size) return std::nullopt;
        const std::span<const std::uint8_t> body = rest.subspan(header_size, size);
        read_ += header_size + size;
        if (crc64(body) != sum) {
            ++bad_checksums_;
            continue;
        }
        message.content.assign(body.begin(), body.end());
        if (version > 1) strip(message);
        return message;
    }
    return std::nullopt;
}

std::optional<Pose> pose_in(const Message& message, std::string_view wanted) {
    if (!message.status.empty() && message.status != "OK") return std::nullopt;
    const bool is_wanted = wanted.empty() || message.device == wanted;
    if (message.type == "TRANSFORM" && is_wanted && message.content.size() == transform_size) {
        Big in(message.content);
        return matrix(in);
    }
    if ((message.type == "POSITION" || message.type == "QTRANS") && is_wanted) return position(message);
    if (message.type != "TDATA") return std::nullopt;
    constexpr std::size_t entry = name_size + 2 + transform_size;
    for (std::size_t at = 0; at + entry <= message.content.size(); at += entry) {
        Big in(std::span(message.content).subspan(at, entry));
        const std::string name = in.text(name_size);
        in.skip(2);
        if (wanted.empty() || name == wanted) return matrix(in);
    }
    return std::nullopt;
}

std::vector<std::uint8_t> transform_message(std::string_view device, const Pose& pose, double seconds) {
    std::vector<std::uint8_t> body;
    const glm::dmat3 turn = glm::mat3_cast(pose.orientation);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) append_real(body, turn[column][row]);
    for (int row = 0; row < 3; ++row) append_real(body, pose.position[row] * 1e3);
    std::vector<std::uint8_t> bytes;
    append(bytes, 1, 2);
    append(bytes, "TRANSFORM", type_size);
    append(bytes, device, name_size);
    const double whole = std::floor(std::max(seconds, 0.0));
    append(bytes,
           static_cast<std::uint64_t>(whole) << 32 | static_cast<std::uint64_t>((seconds - whole) * 4294967296.0), 8);
    append(bytes, body.size(), 8);
    append(bytes, crc64(body), 8);
    bytes.insert(bytes.end(), body.begin(), body.end());
    return bytes;
}

}  // namespace tactus::openigtlink
