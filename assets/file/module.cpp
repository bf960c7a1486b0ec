// SPDX-License-Identifier: Apache-2.0
#include "assets/file/module.hpp"

#include "assets/file/part.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <dlfcn.h>

namespace tactus::file {

void* load_module(const char* name, const char* symbol) {
    const std::filesystem::path file = find_part("a part of this program", name, TACTUS_INSTALLED_MODULES);
    void* const module = ::dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE);
    void* const address = module ? ::dlsym(module, symbol) : nullptr;
    if (!address) throw Error(fmt::format("cannot load a part of this program: {}", ::dlerror()));
    return address;
}

}  // namespace tactus::file
