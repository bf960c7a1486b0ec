// SPDX-License-Identifier: Apache-2.0
#include "devices/driver/confirmation.hpp"

#include "assets/file/json.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

namespace tactus::driver {

namespace {

namespace fs = std::filesystem;

constexpr const char* list = "confirmed";

/// Throws Error when there is a file that is no such list.
file::Json read(const fs::path& path) {
    std::error_code ignored;
    if (path.empty() || !fs::exists(path, ignored)) return file::Json{{list, file::Json::array()}};
    std::ifstream stream(path);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    file::Json all = file::Json::parse_or_null(text);
    const file::Json* const found = all.find(list);
    if (!stream || !found || !found->is_array())
        throw Error(fmt::format("{} is damaged; remove it and confirm your devices again", path.string()));
    return all;
}

std::string text_of(const file::Json& entry, std::string_view key) {
    const file::Json* const found = entry.find(key);
    return found && found->is_string() ? found->as_text() : std::string();
}

bool is_of(const file::Json& entry, std::string_view driver, const Opened& device) {
    return text_of(entry, "driver") == driver && text_of(entry, "serial") == device.serial &&
           text_of(entry, "setup") == device.setup;
}

void write(const fs::path& path, const file::Json& all) {
    std::error_code failure;
    fs::create_directories(path.parent_path(), failure);
    const fs::path next = path.string() + ".new";
    {
        std::ofstream stream(next);
        stream << all.dump(2) << "\n";
        stream.flush();
        if (!stream) throw Error(fmt::format("{} cannot be written", next.string()));
    }
    fs::rename(next, path, failure);
    if (failure) throw Error(fmt::format("{} cannot be written: {}", path.string(), failure.message()));
}

/// The list without the device, and where it is kept.
std::pair<fs::path, file::Json> without(std::string_view driver, const Opened& device) {
    if (device.serial.empty())
        throw Error(
            "the device states no serial number, so nothing can be kept of it; give one with the option 'serial'");
    const fs::path path = confirmations_file();
    if (path.empty()) throw Error("neither XDG_CONFIG_HOME nor HOME is set, so the confirmation cannot be stored");
    file::Json all = read(path), rest = file::Json::array();
    for (const file::Json& entry : all[list])
        if (!is_of(entry, driver, device)) rest.push_back(entry);
    all[list] = rest;
    return {path, all};
}

}  // namespace

fs::path confirmations_file() {
    const auto folder = [](const char* variable) {
        const char* const text = std::getenv(variable);
        return text && *text == '/' ? fs::path(text) : fs::path();
    };
    if (const fs::path config = folder("XDG_CONFIG_HOME"); !config.empty()) return config / "tactus/devices.json";
    const fs::path home = folder("HOME");
    return home.empty() ? home : home / ".config/tactus/devices.json";
}

bool is_confirmed(std::string_view driver, const Opened& device) {
    if (device.serial.empty()) return false;
    try {
        const file::Json all = read(confirmations_file());
        for (const file::Json& entry : all[list])
            if (is_of(entry, driver, device)) return true;
    } catch (const Error&) {
        // The list cannot be read: keep the cap.
    }
    return false;
}

void confirm(std::string_view driver, const Opened& device) {
    auto [path, all] = without(driver, device);
    all[list].push_back(
        {{"driver", driver}, {"serial", device.serial}, {"setup", device.setup}, {"name", device.info.name}});
    write(path, all);
}

void forget(std::string_view driver, const Opened& device) {
    const auto [path, all] = without(driver, device);
    write(path, all);
}

}  // namespace tactus::driver
