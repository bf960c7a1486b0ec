// SPDX-License-Identifier: Apache-2.0
// The engine's implementation of graph/node/setup.hpp: opens and owns the resources that nodes request.
#pragma once

#include "engine/io/device_slot.hpp"
#include "engine/io/driver_gate.hpp"
#include "engine/io/sound_card.hpp"
#include "engine/io/sound_heard.hpp"
#include "engine/io/streams.hpp"
#include "graph/compile/schedule.hpp"
#include "graph/patch/patch.hpp"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

namespace tactus::io {

/// A device of a finished run, as recorded in a take.
struct RecordedDevice {
    std::string name;
    DeviceInfo info;
    DeviceSample first;  ///< sample that nodes received when they were prepared
};

/// The resources that a node requested.
struct HostUses {
    std::vector<std::pair<DeviceSlot*, DeviceUse>> devices;
    std::vector<SoundChannel*> sounds;
    std::vector<SoundHeard*> heard;
    std::vector<const RecordStream*> streams;
};

/// Destination of sound in a live run.
struct AudioChoice {
    std::string
        device;  ///< "": the default card, a file when there is none; "file"; "none"; "default" or part of a name
    double margin_s = 0.01;  ///< buffered sound in case a thread is late, s

    bool is_required() const { return !device.empty() && device != "file" && device != "none"; }
};

class EngineHost : public Host, public SoundInputs {
public:
    /// Without a folder nothing is recorded. `live` allows real devices and sound cards.
    EngineHost(std::optional<std::filesystem::path> folder, bool live, AudioChoice audio = {});

    DevicePort& device(const std::string& name, DeviceUse use, const SourceLocation& where) override;
    RecordStream& record(const StreamFormat& format, const SourceLocation& where) override;
    RecordStream& audio(const StreamFormat& format, const SoundPlace& place) override;
    RecordStream& send(const StreamFormat& format, const SourceLocation& where) override;
    const SoundInPort& listen(const SoundPlace& place, Flicks period,
                              std::optional<std::vector<float>> instead) override;

    /// Starts a plan: requests of nodes prepared from now on belong to it. Their resources are opened separately while
    /// the run goes on.
    void begin(const patch::Patch& patch);
    /// Announces the channels that nodes of the plan will request, so that a card is opened with all of its channels.
    void expect_sounds(const compile::Schedule& plan);
    /// Reserves the channels of surviving nodes; the others are available to newly prepared nodes.
    void keep_sounds(std::vector<SoundChannel*> in_use) { sounds_in_use_ = std::move(in_use); }
    /// Sets the context of the node that is prepared next: its group, its location in the patch, and the record of its
    /// requests.
    void prepare_for(int group, Flicks period, const SourceLocation& where, HostUses& uses) {
        group_ = group;
        period_ = period;
        node_where_ = where;
        uses_ = &uses;
    }
    /// Activates the resources opened since `begin`; control thread.
    void keep();
    /// Closes the resources opened since `begin`.
    void discard();
    /// Adds a message for the user to what was opened since `begin`.
    void notify(std::string notice);
    /// Devices opened since `begin`.
    const std::vector<std::unique_ptr<DeviceSlot>>& opened_devices() const { return opened_.devices; }
    /// Any thread: abandons the thread that is opening a driver, if any. That thread gets an error when it returns.
    bool forsake_driver() noexcept { return driver_.forsake(); }
    /// Services devices that have their own process. Returns true if one is lost: then no force reaches its hand, and
    /// the run may end. Control thread of a live run, many times a second.
    bool service_devices();

    /// Replaces devices by stand-ins for those of a finished run, whose samples are in its log.
    void imitate(std::vector<RecordedDevice> recorded) { recorded_ = std::move(recorded); }
    /// Sound input comes from the log that is replayed.
    void hear_from_log() { hears_from_log_ = true; }
    /// Replaces hardware by stand-ins with the properties that the patch declares, and adds a notice of it.
    void describe_hardware() { describes_hardware_ = true; }

    // State of the run; control thread.
    std::vector<std::unique_ptr<DeviceSlot>> devices;
    std::vector<std::unique_ptr<Stream>> streams;
    std::vector<std::unique_ptr<SoundCard>> cards;
    std::vector<std::unique_ptr<SoundHeard>> heard;
    std::vector<std::string> notices;  ///< messages for the user, each reported once: "no sound card: …"

private:
    std::string device_name(const std::string& wanted, const SourceLocation& where) const;
    DeviceSlot* find_device(const std::string& name) const;
    DevicePort& use_device(DeviceSlot& slot, DeviceUse use, const SourceLocation& where);
    bool is_in_use(const SoundCard& card, int channel) const;
    std::unique_ptr<SoundCard> make_card(Flicks period, const SoundPlace& place) const;
    SoundCard& open_card(std::unique_ptr<SoundCard> card, const std::vector<std::string>& names);
    SoundChannel& own_channel(const StreamFormat& format, const SoundPlace& place);
    /// Returns the card whose channels nodes have in common; opens it on first use.
    SoundCard& shared_card(Flicks period, const SoundPlace& place);
    SoundChannel& shared_channel(const StreamFormat& format, const SoundPlace& place);
    void choose_source(SoundHeard& made, const SoundPlace& place, Flicks period,
                       std::optional<std::vector<float>> instead);

    struct Opened {
        std::vector<std::unique_ptr<DeviceSlot>> devices;
        std::vector<std::unique_ptr<Stream>> streams;
        std::vector<std::unique_ptr<SoundCard>> cards;
        std::vector<std::unique_ptr<SoundHeard>> heard;
        std::vector<std::string> notices;
    };

    patch::Patch patch_;
    DriverGate driver_;
    std::optional<std::vector<RecordedDevice>> recorded_;
    bool describes_hardware_ = false, hears_from_log_ = false;
    Opened opened_;
    std::unordered_set<std::string> files_opened_, files_before_;  ///< opened since `begin`, and before
    HostUses* uses_ = nullptr;
    std::vector<SoundChannel*> sounds_in_use_;
    struct CardNames {
        std::vector<std::string> outputs, inputs;
    };
    std::map<std::string, CardNames> channel_names_;  ///< by the text that selects a card
    std::vector<std::pair<std::string, std::vector<OptionText>>> device_settings_;
    std::optional<std::filesystem::path> folder_;
    bool live_;
    AudioChoice audio_;
    int group_ = -1;
    Flicks period_ = 0;
    SourceLocation node_where_;
};

}  // namespace tactus::io
