// SPDX-License-Identifier: Apache-2.0
// The engine's side of graph/setup.hpp: opens what the nodes ask for and owns it.
#pragma once

#include "engine/group_runtime.hpp"
#include "engine/streams.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus {

class EngineOutside : public Outside {
public:
    /// Without a folder nothing is written: streams end nowhere. `live` allows real devices and sound cards.
    EngineOutside(const Patch& patch, std::optional<std::filesystem::path> folder, bool live);

    DevicePort& device(const std::string& name, const SourceLocation& where) override;
    RecordStream& record(const StreamFormat& format, const SourceLocation& where) override;
    RecordStream& audio(const StreamFormat& format, const SourceLocation& where) override;

    /// The group whose nodes are being prepared: a device belongs to one.
    void prepare_for(int group, Flicks period) {
        group_ = group;
        period_ = period;
    }

    std::vector<std::unique_ptr<DeviceSlot>> devices;
    std::vector<std::unique_ptr<Stream>> streams;
    std::vector<std::string> notices;  ///< what the user should know once: "no sound card: …"

private:
    std::string device_name(const std::string& wanted, const SourceLocation& where) const;

    const Patch& patch_;
    std::optional<std::filesystem::path> folder_;
    bool live_;
    int group_ = -1;
    Flicks period_ = 0;
    std::vector<std::unique_ptr<AudioSink>> sinks_;
};

}  // namespace tactus
