// SPDX-License-Identifier: Apache-2.0
#include "devices/haply/inverse_messages.hpp"

#include "assets/file/json.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>

namespace tactus::haply {

namespace {

using file::Json;

/// The member at the end of a path, or null.
const Json* at(const Json& from, std::initializer_list<std::string_view> path) {
    const Json* here = &from;
    for (const std::string_view name : path) {
        here = here->find(name);
        if (!here) return nullptr;
    }
    return here;
}

std::string text_at(const Json& from, std::initializer_list<std::string_view> path) {
    const Json* const found = at(from, path);
    return found && found->is_string() ? found->as_text() : std::string();
}

template <std::size_t N>
bool read_numbers(const Json* from, const std::array<const char*, N>& names, std::array<double, N>& into) {
    if (!from) return false;
    for (std::size_t i = 0; i < N; ++i) {
        const Json* const number = from->find(names[i]);
        if (!number || !number->is_number()) return false;
        into[i] = number->get<double>();
    }
    return true;
}

constexpr std::array<const char*, 3> xyz{"x", "y", "z"};
constexpr std::array<const char*, 4> wxyz{"w", "x", "y", "z"};

const Json* first_of(const Json& message, std::string_view list) {
    const Json* const all = message.find(list);
    return all && all->is_array() && all->size() > 0 ? all->begin() : nullptr;
}

/// A basis or a mount other than the maker's own changes the axes without a word.
std::string changed_axes(const Json& device) {
    if (const std::string basis = text_at(device, {"config", "basis", "permutation"}); !basis.empty() && basis != "XYZ")
        return fmt::format("basis {}", basis);
    std::array<double, 4> turn{1.0, 0.0, 0.0, 0.0};
    if (read_numbers(at(device, {"config", "mount", "rotation"}), wxyz, turn) && std::abs(turn[0]) < 0.99999)
        return "a mount that is turned";
    std::array<double, 3> place{};
    if (read_numbers(at(device, {"config", "mount", "position"}), xyz, place) &&
        std::abs(place[0]) + std::abs(place[1]) + std::abs(place[2]) > 1e-6)
        return "a mount that is moved";
    return {};
}

void read_grip(const Json& message, driver::Reading& reading) {
    for (const std::string_view list : {"wireless_verse_grip", "verse_grip"}) {
        const Json* const grip = first_of(message, list);
        if (!grip) continue;
        if (std::array<double, 4> q{}; read_numbers(at(*grip, {"state", "orientation"}), wxyz, q))
            reading.pose.orientation = Quat(q[0], q[1], q[2], q[3]);
        constexpr std::array<const char*, 3> names{"a", "b", "c"};
        constexpr std::array<std::uint32_t, 3> bits{button_trigger, 4u, 8u};
        for (std::size_t i = 0; i < names.size(); ++i)
            if (const Json* const button = at(*grip, {"state", "buttons", names[i]});
                button && button->is_boolean() && button->get<bool>())
                reading.buttons |= bits[i];
        return;
    }
}

}  // namespace

std::optional<InverseState> read_inverse(std::string_view text) {
    try {
        const Json message = Json::parse_or_null(text);
        const Json* const device = first_of(message, "inverse3");
        if (!device) return std::nullopt;
        InverseState state;
        state.device = text_at(*device, {"device_id"});
        state.type = text_at(*device, {"config", "type"});
        state.version = text_at(message, {"version"});
        if (state.version.empty()) state.version = text_at(message, {"session", "version"});
        state.changed_axes = changed_axes(*device);
        std::array<double, 3> position{};
        state.has_pose = read_numbers(at(*device, {"state", "cursor_position"}), xyz, position);
        // The service's axes without basis and mount: x to the right, y away, z up.
        state.reading.pose.position = {position[0], position[1], position[2]};
        read_grip(message, state.reading);
        return state;
    } catch (const Error&) {
        return std::nullopt;  // a number beyond a double
    }
}

ForceKey force_key_of(std::string_view version) {
    int major = 0, minor = 0;
    const char* const end = version.data() + version.size();
    const auto after = std::from_chars(version.data(), end, major);
    if (after.ec != std::errc{}) return ForceKey::vector;
    if (after.ptr != end && *after.ptr == '.') std::from_chars(after.ptr + 1, end, minor);
    return major < 3 || (major == 3 && minor < 5) ? ForceKey::values : ForceKey::vector;
}

std::string force_text(std::string_view device, const Vec3& newton, ForceKey key, bool first) {
    std::string id;
    for (const char c : device) {
        if (c == '"' || c == '\\') id += '\\';
        if (static_cast<unsigned char>(c) >= 0x20) id += c;
    }
    return fmt::format(
        R"({{{}"inverse3":[{{"device_id":"{}","commands":{{"set_cursor_force":{{"{}":{{"x":{},"y":{},"z":{}}}}}}}}}]}})",
        first ? R"("session":{"configure":{"profile":{"name":"tactus"}}},)" : "", id,
        key == ForceKey::vector ? "vector" : "values", newton.x, newton.y, newton.z);
}

}  // namespace tactus::haply
