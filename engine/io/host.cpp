// SPDX-License-Identifier: Apache-2.0
#include "engine/io/host.hpp"

#include "devices/audio/portaudio.hpp"
#include "devices/haptic/catalogue.hpp"
#include "devices/haptic/window_hand.hpp"
#include "devices/hosted/hosted_device.hpp"
#include "engine/io/async_sink.hpp"
#include "engine/io/lost_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace tactus::io {

namespace {

/// What a device reported is in the log that is replayed; there is no hand to feel the forces.
class StandIn : public HapticDevice {
public:
    explicit StandIn(RecordedDevice recorded) : recorded_(std::move(recorded)) {}
    const DeviceInfo& info() const override { return recorded_.info; }
    void prepare(double) override {}
    DeviceSample acquire(double) noexcept override { return recorded_.first; }
    void commit(const Wrench&) noexcept override {}

private:
    RecordedDevice recorded_;
};

/// Files that the run or its take writes by itself: a recording of that name would be written over, or write over them.
bool is_of_run(const std::string& file) {
    constexpr std::array<std::string_view, 5> names{"summary.json", "take.json", "events.jsonl", "timing.log",
                                                    "result.json"};
    constexpr std::array<std::string_view, 3> endings{".vdb", ".png", ".part"};
    return std::ranges::find(names, file) != names.end() || file == "streams" || file.starts_with("journal-") ||
           (file.starts_with("patch-") && file.ends_with(".toml")) ||
           std::ranges::any_of(endings, [&file](std::string_view ending) { return file.ends_with(ending); });
}

bool same_settings(const std::vector<OptionText>& a, const std::vector<OptionText>& b) {
    return std::ranges::equal(
        a, b, [](const OptionText& x, const OptionText& y) { return x.name == y.name && x.text == y.text; });
}

}  // namespace

EngineHost::EngineHost(std::optional<std::filesystem::path> folder, bool live, AudioChoice audio)
    : folder_(std::move(folder)), live_(live), audio_(std::move(audio)) {}

void EngineHost::begin(const patch::Patch& patch) {
    patch_ = patch;
    files_opened_.clear();
    files_before_.clear();
    for (const auto& stream : streams) files_before_.insert(stream->format().file);
    for (const auto& [name, settings] : device_settings_)
        for (const patch::PatchDevice& declared : patch.devices)
            if (declared.name == name && !same_settings(declared.settings, settings))
                throw Error(declared.where,
                            fmt::format("device '{}' is open; its settings take effect at the next start", name));
}

void EngineHost::keep() {
    for (auto& slot : opened_.devices) {
        const auto declared = std::ranges::find(patch_.devices, slot->name, &patch::PatchDevice::name);
        if (declared != patch_.devices.end()) device_settings_.emplace_back(slot->name, declared->settings);
        devices.push_back(std::move(slot));
    }
    for (auto& stream : opened_.streams) streams.push_back(std::move(stream));
    for (auto& card : opened_.cards) cards.push_back(std::move(card));
    for (auto& one : opened_.heard) heard.push_back(std::move(one));
    for (auto& notice : opened_.notices)
        if (std::ranges::find(notices, notice) == notices.end()) notices.push_back(std::move(notice));
    opened_ = {};
}

void EngineHost::discard() { opened_ = {}; }

void EngineHost::notify(std::string notice) {
    if (std::ranges::find(opened_.notices, notice) == opened_.notices.end())
        opened_.notices.push_back(std::move(notice));
}

std::string EngineHost::device_name(const std::string& wanted, const SourceLocation& where) const {
    if (!wanted.empty()) return wanted;
    // What another node has opened comes first: `--set hand.device=mouse` names one that the patch does not declare.
    if (devices.size() + opened_.devices.size() == 1)
        return (devices.empty() ? opened_.devices : devices).front()->name;
    if (patch_.devices.size() == 1) return patch_.devices.front().name;
    throw Error(where, "which device is meant? Name it, as in device = \"simulated\"");
}

DeviceSlot* EngineHost::find_device(const std::string& name) const {
    for (const auto* list : {&devices, &opened_.devices})
        for (const auto& slot : *list)
            if (slot->name == name) return slot.get();
    return nullptr;
}

DevicePort& EngineHost::use_device(DeviceSlot& slot, DeviceUse use, const SourceLocation& where) {
    if (slot.group != group_)
        throw Error(where, fmt::format("device '{}' is used in two groups; its nodes must share one rate, and keep it "
                                       "while the patch runs",
                                       slot.name));
    uses_->devices.emplace_back(&slot, use);
    if (use == DeviceUse::drive && !slot.port.info.actuates_torque && slot.port.info.fingers == 0) {
        notify(fmt::format("device '{}' gives forces only: torques that the patch computes for it are dropped",
                           slot.name));
    }
    return slot.port;
}

DevicePort& EngineHost::device(const std::string& wanted, DeviceUse use, const SourceLocation& given) {
    // A node that names no device means the only one.
    const SourceLocation& where = given.file.empty() ? node_where_ : given;
    const std::string name = device_name(wanted, where);
    if (DeviceSlot* slot = find_device(name)) return use_device(*slot, use, where);
    const auto declared = std::ranges::find(patch_.devices, name, &patch::PatchDevice::name);
    const bool is_declared = declared != patch_.devices.end();
    const hosted::DeviceRequest request{is_declared ? declared->driver : name, fmt::format("device '{}'", name),
                                        is_declared ? declared->settings : std::vector<OptionText>{},
                                        is_declared ? declared->where : where};
    const haptic::PathResolver resolve = [this, &where](const std::string& asset) {
        const auto found = std::ranges::find(patch_.assets, asset, &patch::PatchAsset::name);
        if (found != patch_.assets.end()) return found->path;
        std::vector<std::string> names;
        for (const patch::PatchAsset& known : patch_.assets) names.push_back(known.name);
        throw Error(where, fmt::format("no asset '{}' in [assets]{}", asset, did_you_mean(asset, names)));
    };
    // A driver may block when it is opened.
    struct Opening {
        explicit Opening(DriverGate& gate) : driver(gate) { driver.enter(); }
        ~Opening() { driver.leave(); }
        DriverGate& driver;
    };
    std::optional<Opening> opening(std::in_place, driver_);
    auto slot = std::make_unique<DeviceSlot>();
    slot->name = name;
    if (recorded_) {
        const auto recorded = std::ranges::find(*recorded_, name, &RecordedDevice::name);
        if (recorded == recorded_->end()) throw Error(where, fmt::format("the take has no device '{}'", name));
        slot->device = std::make_unique<StandIn>(*recorded);
    } else if (describes_hardware_ && haptic::is_real_driver(request.driver)) {
        const haptic::HardwareOutline outline = hosted::describe_here(request, resolve);
        opened_.notices.push_back(
            outline.absence.empty()
                ? fmt::format("device '{}' is hardware, which is not opened here: only its settings are known", name)
                : fmt::format("device '{}' is not here ({}): only its settings are known", name, outline.absence));
        slot->device = std::make_unique<StandIn>(RecordedDevice{name, outline.info, {}});
    } else {
        if (!live_ && haptic::is_real_driver(request.driver))
            throw Error(request.where,
                        fmt::format("device '{}' is hardware and keeps its own time; use 'tactus run'", name));
        if (!describes_hardware_ && haptic::needs_window(request.driver) &&
            (!live_ || haptic::window_hand().windows == 0))
            throw Error(where, fmt::format("device '{}' is a hand at a window; use 'tactus run PATCH --view'", name));
        slot->device = live_ ? hosted::open_placed(request, resolve) : hosted::open_here(request, resolve);
    }
    slot->device->prepare(seconds(period_));
    slot->port.info = slot->device->info();
    // In a run, the opened device reports its whole delay, including that of its process.
    if (describes_hardware_) slot->port.info.delay += hosted::added_latency_s(request, seconds(period_));
    slot->port.sample = slot->device->acquire(0.0);
    opening.reset();
    if (driver_.is_forsaken()) throw Error(where, "the run has ended");
    slot->group = group_;
    slot->period = period_;
    for (const auto* list : {&devices, &opened_.devices})
        for (const auto& other : *list) slot->id += other->group == group_;
    opened_.devices.push_back(std::move(slot));
    return use_device(*opened_.devices.back(), use, where);
}

RecordStream& EngineHost::record(const StreamFormat& wanted, const SourceLocation& where) {
    if (wanted.file.empty() || wanted.file.find('/') != std::string::npos || wanted.file.starts_with('.'))
        throw Error(where, fmt::format("'{}' is not a file name; recordings go to the folder of the run", wanted.file));
    if (folder_ && is_of_run(wanted.file))
        throw Error(where,
                    fmt::format("'{}' is the name of a file that the run itself may write; record to another one, "
                                "as 'force.csv'",
                                wanted.file));
    if (files_opened_.contains(wanted.file))
        throw Error(where, fmt::format("two recordings would be written to '{}'", wanted.file));
    StreamFormat format = wanted;
    // A recording restarted by an edit does not overwrite the earlier one.
    const std::filesystem::path name = wanted.file;
    for (int again = 2; files_before_.contains(format.file) || files_opened_.contains(format.file); ++again)
        format.file = fmt::format("{}-{}{}", name.stem().string(), again, name.extension().string());
    const bool is_sound = format.type == &value::signal;
    if (!is_sound && !format.keeper && format.type->columns.empty())
        throw Error(where, fmt::format("a {} cannot be recorded as numbers", format.type->name));
    std::unique_ptr<Sink> sink = make_null_sink();
    if (folder_ && format.keeper) {
        format.keeper->open((*folder_ / format.file).string());
        sink = std::make_unique<AsyncSink>(format.keeper, format.type->size);
    } else if (folder_)
        sink = is_sound ? make_sound_file_sink(*folder_ / format.file, format)
                        : make_csv_sink(*folder_ / format.file, format);
    files_opened_.insert(format.file);
    opened_.streams.push_back(std::make_unique<Stream>(format, std::move(sink)));
    uses_->streams.push_back(opened_.streams.back().get());
    return *opened_.streams.back();
}

RecordStream& EngineHost::send(const StreamFormat& format, const SourceLocation& where) {
    std::unique_ptr<Sink> sink = make_null_sink();
    if (live_) {
        try {
            format.keeper->open({});
        } catch (const Error& error) {
            throw Error(where, error.message());
        }
        sink = std::make_unique<AsyncSink>(format.keeper, format.type->size);
    }
    uses_->streams.push_back(opened_.streams.emplace_back(std::make_unique<Stream>(format, std::move(sink))).get());
    return *opened_.streams.back();
}

bool EngineHost::service_devices() {
    bool lost = false;
    for (const auto& slot : devices) {
        const bool was_lost = !loss_of(*slot).empty();
        const std::string loss = service_device(*slot);
        if (!was_lost && !loss.empty()) notices.push_back(fmt::format("device '{}' was lost: {}", slot->name, loss));
        lost = lost || !loss.empty();
    }
    return lost;
}

}  // namespace tactus::io
