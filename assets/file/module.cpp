// SPDX-License-Identifier: Apache-2.0
#include "assets/file/module.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <dlfcn.h>
#include <link.h>

#include <filesystem>

namespace tactus::file {

namespace fs = std::filesystem;

namespace {

/// The program or shared library that contains this function.
fs::path this_object() {
    Dl_info where;
    link_map* object = nullptr;
    const auto* self = reinterpret_cast<const void*>(&this_object);
    // The loader knows the program itself by an empty name.
    if (::dladdr1(self, &where, reinterpret_cast<void**>(&object), RTLD_DL_LINKMAP) != 0 && object &&
        object->l_name && *object->l_name)
        return object->l_name;
    return fs::read_symlink("/proc/self/exe");
}

}  // namespace

void* load_module(const char* name, const char* symbol) {
    const fs::path folder = this_object().parent_path();
    const fs::path beside = folder / name;
    const fs::path installed = (folder / TACTUS_INSTALLED_MODULES / name).lexically_normal();
    std::error_code failure;
    for (const fs::path& file : {beside, installed}) {
        if (!fs::exists(file, failure)) continue;
        void* const module = ::dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE);
        void* const address = module ? ::dlsym(module, symbol) : nullptr;
        if (!address) throw Error(fmt::format("cannot load a part of this program: {}", ::dlerror()));
        return address;
    }
    throw Error(fmt::format("a part of this program is neither {} nor {}; build or install {}", beside.string(),
                            installed.string(), name));
}

}  // namespace tactus::file
