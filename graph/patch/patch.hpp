// SPDX-License-Identifier: Apache-2.0
// A patch as written: names and texts with their locations in the file. Nothing is resolved or checked against node
// types.
#pragma once

#include "dsp/core/error.hpp"
#include "dsp/core/time.hpp"
#include "graph/node/options.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tactus::patch {

/// Delivery of values by a wire between two rates: the last one, interpolated, all since the last call, or delayed.
enum class WireMode : std::uint8_t { hold, linear, batch, delay };

/// A wire, such as "blade.load -> saw.load as linear". For an asset on the left side `from_node` is its name and
/// `from_port` is empty.
struct PatchWire {
    std::string from_node, from_port, to_node, to_port;
    WireMode mode = WireMode::hold;
    bool mode_given = false;  ///< the text has an "as"
    int delay = 0;  ///< activations of the producer, for WireMode::delay
    SourceLocation where;
};

/// An entry [nodes.NAME].
struct PatchNode {
    std::string name, type;
    /// "1 kHz"; empty if `group` is given; "outer" in a sub-patch: the rate of the sub-patch's node.
    std::string rate;
    std::string group;  ///< name of an entry of [groups], empty when `rate` is given
    SourceLocation where, type_where, rate_where;
    std::vector<OptionText> settings;  ///< every other key
};

/// An entry [groups.NAME].
struct PatchGroup {
    std::string name, rate;
    std::string latency;  ///< "250 ms"; empty: the default
    int backlog = -1;  ///< activations that may run late, −1: the default
    SourceLocation where;
};

/// A line of [assets].
struct PatchAsset {
    std::string name;
    std::filesystem::path path;  ///< resolved against the folder of the patch
    SourceLocation where;
};

/// An entry [devices.NAME].
struct PatchDevice {
    std::string name, driver;
    SourceLocation where;
    std::vector<OptionText> settings;
};

/// An entry [actuators.NAME]: common settings of the nodes that name it.
struct PatchActuator {
    std::string name;
    SourceLocation where;
    std::vector<OptionText> settings;
};

/// A port or parameter that a sub-patch exposes: its outer name, and the inner node and port. An input or a parameter
/// has one entry for each port that it sets.
struct PatchEnd {
    std::string name, node, port;
    SourceLocation where;
};

/// The text of a sub-patch, at any depth.
struct PatchPart {
    std::string path;  ///< relative to the folder of the outermost patch, with '/'; or absolute
    std::string text;

    bool operator==(const PatchPart&) const = default;
};

/// A patch file.
struct Patch {
    std::filesystem::path file;
    std::string title;
    Flicks quantum = flicks_per_second / 1000;  ///< latency of values from an audio group to other groups
    std::uint64_t seed = 1;
    std::vector<PatchWire> wires;
    std::vector<PatchAsset> assets;
    std::vector<PatchGroup> groups;
    std::vector<PatchDevice> devices;
    std::vector<PatchActuator> actuators;
    std::vector<PatchNode> nodes;  ///< in the order of the file
    std::vector<PatchEnd> inputs, outputs, parameters;
    std::vector<PatchPart> parts;
    /// After flatten(): the ports and parameters that the sub-patches exposed, by names such as "voice.level".
    std::vector<PatchEnd> offered;
    std::string text;  ///< the file as read, without [[parts]]
};

/// Changes of a patch given on the command line: `node.param=value` and `asset=path`.
struct PatchOverrides {
    std::vector<std::string> settings;  ///< "blade.stiffness=0.8 N/mm", "devices.hand.mass=0.2 kg"
    std::vector<std::string> assets;  ///< "bone=mine.vdb"
};

/// All errors of a patch, in the order of the file. Reading and compiling continue after an error where possible.
struct Problems {
    std::vector<Error> list;

    void add(const SourceLocation& where, const std::string& message) { list.emplace_back(where, message); }
    bool empty() const { return list.empty(); }
    /// False after 100 problems. A hint compares a name with all others, which is slow, and more than 100 would not be
    /// read.
    bool wants_hint() const { return list.size() < 100; }
};

/// Reads patch text. `file` is its name in messages, and relative paths start at its folder. Adds the errors to
/// `problems` and returns the parts that it could read.
Patch read_patch(std::string_view text, const std::filesystem::path& file, Problems& problems);

/// Reads a patch file in the same way. Throws Error when the file cannot be read.
Patch load_patch(const std::filesystem::path& file, Problems& problems);

/// Applies changes from the command line. A name that does not exist is a problem at the location "--set" or "--asset".
void apply_overrides(Patch& patch, const PatchOverrides& overrides, Problems& problems);

/// Returns the period in flicks of a rate such as "1 kHz". If it is not a whole number of flicks, throws Error with the
/// nearest exact rates.
Flicks parse_rate(std::string_view text);

}  // namespace tactus::patch
