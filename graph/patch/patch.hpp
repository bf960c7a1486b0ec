// SPDX-License-Identifier: Apache-2.0
// A patch as its text says it: names and texts with their places, nothing resolved yet.
#pragma once

#include "dsp/core/error.hpp"
#include "dsp/core/time.hpp"
#include "graph/node/options.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tactus::patch {

enum class WireMode : std::uint8_t { hold, linear, batch, delay };

/// "blade.load -> saw.load as linear". An asset on the left side has no port: from_node is its name, from_port empty.
struct PatchWire {
    std::string from_node, from_port, to_node, to_port;
    WireMode mode = WireMode::hold;
    bool mode_given = false;
    int delay = 0;  ///< activations of the producer, for WireMode::delay
    SourceLocation where;
};

struct PatchNode {
    std::string name, type;
    std::string rate;   ///< "1 kHz", empty when `group` is given; "outer" within a patch that is a node
    std::string group;  ///< name of an entry of [groups], empty when `rate` is given
    SourceLocation where, type_where, rate_where;
    std::vector<OptionText> settings;  ///< every other key
};

struct PatchGroup {
    std::string name, rate;
    std::string latency;  ///< "250 ms", empty: the default
    int backlog = -1;     ///< activations that may run late, −1: the default
    SourceLocation where;
};

struct PatchAsset {
    std::string name;
    std::filesystem::path path;  ///< resolved against the folder of the patch
    SourceLocation where;
};

struct PatchDevice {
    std::string name, driver;
    SourceLocation where;
    std::vector<OptionText> settings;
};

/// What a patch offers when it is a node of another: the name outside, and a port or parameter within. An input or a
/// parameter may stand for several.
struct PatchEnd {
    std::string name, node, port;
    SourceLocation where;
};

/// The text of a patch that is a node of this one, or of one within it.
struct PatchPart {
    std::string path;  ///< relative to the folder of the outermost patch, with '/', or absolute
    std::string text;

    bool operator==(const PatchPart&) const = default;
};

struct Patch {
    std::filesystem::path file;
    std::string title;
    Flicks quantum = flicks_per_second / 1000;  ///< latency of audio towards other groups
    std::uint64_t seed = 1;
    std::vector<PatchWire> wires;
    std::vector<PatchAsset> assets;
    std::vector<PatchGroup> groups;
    std::vector<PatchDevice> devices;
    std::vector<PatchNode> nodes;  ///< in the order of the file
    std::vector<PatchEnd> inputs, outputs, parameters;
    std::vector<PatchPart> parts;
    std::vector<PatchEnd> offered;  ///< by patches within, once flattened: "voice.level" and what it stands for
    std::string text;               ///< the file as read, without [[parts]]
};

/// What a command line changes: `node.param=value` and `asset=path`.
struct PatchOverrides {
    std::vector<std::string> settings;  ///< "blade.stiffness=0.8 N/mm", "devices.hand.mass=0.2 kg"
    std::vector<std::string> assets;    ///< "bone=mine.vdb"
};

/// Every problem found, in order of appearance; reading and compiling go on past the first where they can.
struct Problems {
    std::vector<Error> list;

    void add(const SourceLocation& where, const std::string& message) { list.emplace_back(where, message); }
    bool empty() const { return list.empty(); }
    /// The next problem is still worth comparing with all names there are: nobody reads the hints of hundreds.
    bool wants_hint() const { return list.size() < 100; }
};

/// Reads patch text. `file` names it in messages and anchors relative paths. Problems found are added; what could be
/// read is returned.
Patch read_patch(std::string_view text, const std::filesystem::path& file, Problems& problems);

/// Reads a patch file. Throws Error when the file cannot be read at all.
Patch load_patch(const std::filesystem::path& file, Problems& problems);

/// Applies what the command line changes; names that do not exist are problems with the location "--set" or "--asset".
void apply_overrides(Patch& patch, const PatchOverrides& overrides, Problems& problems);

/// Period of "1 kHz" in flicks. Throws Error naming the nearest exact rates when it is not a whole number of flicks.
Flicks parse_rate(std::string_view text);

}  // namespace tactus::patch
