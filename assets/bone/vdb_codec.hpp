// SPDX-License-Identifier: Apache-2.0
// Interface of the module that contains OpenVDB. It is loaded when the first bone is read or written, because loading
// OpenVDB (57 MB, 60,000 relocations) takes 80 ms of processor time, longer than most commands run.
#pragma once

#include "assets/bone/bone.hpp"
#include "assets/bone/sparse_bone.hpp"
#include "dsp/core/stop.hpp"

#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

namespace tactus::bone {

/// Converts bones to and from the bytes before the seal of a bone file. All functions may run on several threads at the
/// same time.
class VdbCodec {
public:
    /// Settings of the program. They are passed because the module has its own copies of the functions that read them.
    struct Call {
        IsStopped is_stopped;
        std::uint64_t memory_limit;  ///< bytes
    };

    virtual ~VdbCodec() = default;
    /// The bones must pass the checks of save_bones.
    virtual void write(std::span<const Bone> bones, std::ostream& out, const Call& call) const = 0;
    /// Frees the blocks of `bone`. Name, colour, provenance and points come from `about`.
    virtual void write(SparseBone& bone, const Bone& about, std::ostream& out, const Call& call) const = 0;
    /// `bytes` must pass check_vdb; `file` names them in messages. Throws Error and NoRoom as load_bones does.
    virtual std::vector<Bone> read(std::string bytes, const std::string& file, const Call& call) const = 0;
};

/// File name and symbol of the module. The symbol is a function that returns a `const VdbCodec*`.
inline constexpr const char *vdb_module = "tactus-openvdb.so", *vdb_codec_symbol = "tactus_vdb_codec";

}  // namespace tactus::bone
