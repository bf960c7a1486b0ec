// SPDX-License-Identifier: Apache-2.0
#include "tests/support/bone_files.hpp"

#include "dsp/core/hash.hpp"

#include <dlfcn.h>

#include <stdexcept>

namespace tactus::test {

std::string sealed(std::string bytes) {
    Hash hash;
    hash.add_bytes(bytes.data(), bytes.size());
    const std::uint64_t value = hash.value();
    return bytes.append("TACTUSBONE000001").append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string repacked(const std::string& bytes, std::uint32_t packing) {
    using Repack = void(const std::string&, std::uint32_t, std::string&);
    void* const module = ::dlopen(TACTUS_REPACKED_BONE, RTLD_NOW | RTLD_LOCAL);
    auto* const repack = module ? reinterpret_cast<Repack*>(::dlsym(module, "tactus_test_repack")) : nullptr;
    if (!repack) throw std::runtime_error(::dlerror());
    std::string into;
    repack(bytes, packing, into);
    return into;
}

}  // namespace tactus::test
