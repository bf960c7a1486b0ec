// SPDX-License-Identifier: Apache-2.0
// The errors of a patch, each with the node, setting or wire that it concerns, and what of the patch is sound without
// these. A patch with errors is shown and repaired like any other; it does not run. No user interface.
#pragma once

#include "dsp/core/error.hpp"
#include "graph/compile/schedule.hpp"
#include "tools/window/document/unfinished.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::window {

struct Fault {
    std::string text;     ///< "patch.toml:20:13: message", as the command line reports it
    std::string message;  ///< without the location
    int line = 0;         ///< in the text of the patch; 0: it lies in no line of it
    std::filesystem::path file;  ///< of a sub-patch: where the error lies; empty: in the patch itself
    std::string node;   ///< that cannot be made; empty: the error is not one of a node
    std::string param;  ///< the setting of that node
    std::optional<patch::PatchWire> wire;
    std::string wrong, suggestion;  ///< a misspelled word and the name that was probably meant
};

/// What error recovery makes of a patch text: the errors, and the sound rest.
struct RecoveredPatch {
    patch::Patch written;   ///< all that could be read
    std::vector<Fault> faults;  ///< in the order of the lines; each is reported once
    Unfinished unfinished;  ///< nodes that do not run, with their wires; with `faults` also the nodes at fault
    std::unique_ptr<compile::Schedule> plan;  ///< of the rest; null: nothing is left
};

/// Compiles a patch; errors are added to the problems.
using CompilePatch = std::function<std::optional<compile::Schedule>(patch::Patch, patch::Problems&)>;

/// The compiler stops at the first stage that reports errors. Therefore nodes and wires at fault are left out and the
/// rest is compiled again, until no error is left or none can be assigned to a node or a wire. Lines that are no TOML
/// are left out in the same way.
RecoveredPatch recover_patch(std::string_view text, const std::filesystem::path& file, const CompilePatch& compile);

/// Why an edit that leads from the errors `before` to those `after` is refused; nothing: it is not. A patch with errors is
/// repaired one by one, and a repair may bring to light what the compiler could not see before: an edit is refused when it
/// adds errors and repairs none.
std::optional<std::string> refusal_of(const std::vector<Fault>& before, const std::vector<Fault>& after);

/// The name that a message proposes: "…'sin'…; did you mean 'sine'?" gives "sin" and "sine".
struct Correction {
    std::string wrong, suggestion;
};
std::optional<Correction> correction_in(std::string_view message);

}  // namespace tactus::window
