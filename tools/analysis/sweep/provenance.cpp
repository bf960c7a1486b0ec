// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/sweep/provenance.hpp"

#include "dsp/contact/pointshell_kernel.hpp"
#include "dsp/core/hash.hpp"
#include "engine/take/take_writer.hpp"
#include "tools/analysis/sweep/sweep_folder.hpp"

#include <fmt/format.h>

#include <gnu/libc-version.h>

#include <chrono>
#include <fstream>

namespace tactus::analysis {

using file::Json;

namespace {

/// Hash of the features that the kernel lists: a library may choose its code by any of them.
std::string processor_features() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("flags") || line.starts_with("Features")) {
            Hash hash;
            hash.add_text(line);
            return fmt::format("{:016x}", hash.value());
        }
    return "unknown";
}

}  // namespace

Json worker_description(const std::string& version, const std::string& runner, int jobs) {
    return {{"version", version},
            {"build", take::build_identity()},
            {"libc", ::gnu_get_libc_version()},
            {"vector", std::string(contact::kernel::variant_in_use())},
            {"features", processor_features()},
            {"cpu", take::cpu_family()},
            {"machine", host_name()},
            {"runner", runner},
            {"jobs", jobs},
            {"started", std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count()}};
}

std::string bits_of(const Json& worker) {
    std::string all;
    for (const char* key : {"build", "libc", "vector", "features"}) {
        const Json* value = worker.find(key);
        all += (value && value->is_string() ? value->as_text() : std::string("unknown")) + ' ';
    }
    return all;
}

}  // namespace tactus::analysis
