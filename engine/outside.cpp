// SPDX-License-Identifier: Apache-2.0
#include "engine/outside.hpp"

#include "devices/audio/portaudio.hpp"
#include "devices/haptic/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus {

namespace {

class NowhereEnd : public StreamEnd {
public:
    void take(std::int64_t, const std::byte*, std::size_t) override {}
    void finish() override {}
};

}  // namespace

EngineOutside::EngineOutside(const Patch& patch, std::optional<std::filesystem::path> folder, bool live)
    : patch_(patch), folder_(std::move(folder)), live_(live) {}

std::string EngineOutside::device_name(const std::string& wanted, const SourceLocation& where) const {
    if (!wanted.empty()) return wanted;
    if (devices.size() == 1) return devices.front()->name;
    if (devices.empty() && patch_.devices.size() == 1) return patch_.devices.front().name;
    throw Error(where, "which device is meant? Name it, as in device = \"simulated\"");
}

DevicePort& EngineOutside::device(const std::string& wanted, const SourceLocation& where) {
    const std::string name = device_name(wanted, where);
    for (const auto& slot : devices) {
        if (slot->name != name) continue;
        if (slot->group != group_)
            throw Error(where, fmt::format("device '{}' is used in two groups; its nodes must share one rate", name));
        return slot->port;
    }
    const auto declared = std::ranges::find(patch_.devices, name, &PatchDevice::name);
    const bool is_declared = declared != patch_.devices.end();
    Options options(fmt::format("device '{}'", name), is_declared ? declared->settings : std::vector<OptionText>{},
                    is_declared ? declared->where : where);
    const PathResolver resolve = [this, &where](const std::string& asset) {
        const auto found = std::ranges::find(patch_.assets, asset, &PatchAsset::name);
        if (found != patch_.assets.end()) return found->path;
        std::vector<std::string> names;
        for (const PatchAsset& known : patch_.assets) names.push_back(known.name);
        throw Error(where, fmt::format("no asset '{}' in [assets]{}", asset, did_you_mean(asset, names)));
    };
    auto slot = std::make_unique<DeviceSlot>();
    slot->name = name;
    slot->device = open_haptic_device(is_declared ? declared->driver : name, is_declared ? declared->where : where,
                                      options, resolve);
    options.finish();
    slot->device->prepare(seconds(period_));
    slot->port.info = slot->device->info();
    slot->port.sample = slot->device->acquire(0.0);
    slot->group = group_;
    for (const auto& other : devices) slot->id += other->group == group_;
    devices.push_back(std::move(slot));
    return devices.back()->port;
}

RecordStream& EngineOutside::record(const StreamFormat& format, const SourceLocation& where) {
    if (format.file.empty() || format.file.find('/') != std::string::npos || format.file.starts_with('.'))
        throw Error(where, fmt::format("'{}' is not a file name; recordings go to the folder of the run", format.file));
    for (const auto& stream : streams)
        if (stream->format().file == format.file)
            throw Error(where, fmt::format("two recordings would be written to '{}'", format.file));
    const bool is_sound = format.type == &value::signal;
    if (!is_sound && format.type->columns.empty())
        throw Error(where, fmt::format("a {} cannot be recorded as numbers", format.type->name));
    std::unique_ptr<StreamEnd> end = std::make_unique<NowhereEnd>();
    if (folder_)
        end = is_sound ? make_sound_end(*folder_ / format.file, format) : make_csv_end(*folder_ / format.file, format);
    streams.push_back(std::make_unique<Stream>(format, std::move(end)));
    return *streams.back();
}

RecordStream& EngineOutside::audio(const StreamFormat& format, const SourceLocation& where) {
    if (live_) {
        try {
            std::unique_ptr<AudioSink> sink = make_portaudio_sink();
            sink->prepare(rate_of(format.period), 1);
            notices.push_back(fmt::format("playing on {}", sink->name()));
            sinks_.push_back(std::move(sink));
            StreamFormat played = format;
            played.file.clear();
            streams.push_back(std::make_unique<Stream>(played, make_audio_end(*sinks_.back())));
            return *streams.back();
        } catch (const Error& error) {
            notices.push_back(fmt::format("no sound card ({}); the sound goes to {}", error.message(), format.file));
        }
    }
    return record(format, where);
}

}  // namespace tactus
