// SPDX-License-Identifier: Apache-2.0
#include "devices/driver/shared_library.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <dlfcn.h>
#include <glob.h>
#include <link.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <utility>

namespace tactus::driver {

SharedLibrary::SharedLibrary(const std::string& product, const std::vector<std::string>& candidates)
    : product_(product) {
    std::string why;
    for (const std::string& candidate : candidates) {
        handle_ = ::dlopen(candidate.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
        if (handle_) {
            path_ = candidate;
            if (link_map* map = nullptr; ::dlinfo(handle_, RTLD_DI_LINKMAP, &map) == 0 && map && *map->l_name)
                path_ = map->l_name;
            return;
        }
        const char* const said = ::dlerror();
        why = said ? said : "unknown error";
    }
    throw Error(
        fmt::format("{} is not installed: none of {} can be loaded; the last one: {}. Install it, or name the "
                    "file with the option 'library'",
                    product_, fmt::join(candidates, ", "), why));
}

void* SharedLibrary::find(const char* name) const noexcept { return ::dlsym(handle_, name); }

void SharedLibrary::fail(const char* name) const {
    throw Error(fmt::format("{} has no function {}: {} is too old, or another library", path_, name, product_));
}

std::vector<std::string> library_candidates(const std::string& given, const LibraryPlaces& places) {
    if (!given.empty()) return {given};
    std::vector<std::string> all;
    const auto add = [&](const std::string& folder) {
        for (const std::string& stem : places.stems)
            for (std::string& file : libraries_in(folder, stem)) all.push_back(std::move(file));
    };
    if (const char* const sdk = std::getenv(places.sdk_variable))
        for (const std::string& folder : places.folders) add(fmt::format("{}/{}", sdk, folder));
    add("/usr/local/lib");
    if (const char* const home = std::getenv("HOME")) add(fmt::format("{}/.local/lib", home));
    all.insert(all.end(), places.names.begin(), places.names.end());
    return all;
}

std::vector<std::string> libraries_in(const std::string& folder, const std::string& stem) {
    std::vector<std::string> found;
    glob_t all{};
    if (::glob((folder + "/" + stem + "*").c_str(), 0, nullptr, &all) == 0)
        found.assign(all.gl_pathv, all.gl_pathv + all.gl_pathc);
    ::globfree(&all);
    std::ranges::sort(found, std::greater<>());
    return found;
}

}  // namespace tactus::driver
