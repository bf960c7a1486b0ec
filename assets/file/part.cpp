// SPDX-License-Identifier: Apache-2.0
#include "assets/file/part.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <dlfcn.h>
#include <link.h>

#include <string>
#include <system_error>

namespace tactus::file {

namespace fs = std::filesystem;

namespace {

fs::path find_this_object() {
    Dl_info where;
    link_map* object = nullptr;
    const auto* self = reinterpret_cast<const void*>(&find_this_object);
    // The dynamic loader lists the program itself under an empty name.
    if (::dladdr1(self, &where, reinterpret_cast<void**>(&object), RTLD_DL_LINKMAP) != 0 && object && object->l_name &&
        *object->l_name)
        return fs::weakly_canonical(object->l_name);
    std::error_code failure;
    return fs::read_symlink("/proc/self/exe", failure);
}

const fs::path& place_of_this() {
    static const fs::path place = find_this_object();
    return place;
}

/// Found when this is loaded: a library may have been loaded by a relative path, and the program changes its folder later.
[[maybe_unused]] const fs::path& place_at_load = place_of_this();

}  // namespace

fs::path this_object() { return place_of_this(); }

std::vector<fs::path> places_of_part(std::string_view name, std::string_view installed) {
    const fs::path folder = this_object().parent_path();
    std::vector<fs::path> places{folder / name};
    for (std::size_t begin = 0; begin <= installed.size();) {
        const std::size_t end = std::min(installed.find(':', begin), installed.size());
        places.push_back((folder / installed.substr(begin, end - begin) / name).lexically_normal());
        begin = end + 1;
    }
    return places;
}

fs::path find_part(std::string_view what, std::string_view name, std::string_view installed) {
    const std::vector<fs::path> places = places_of_part(name, installed);
    std::string list;
    std::error_code failure;
    for (const fs::path& place : places) {
        if (fs::exists(place, failure)) return place;
        list += (list.empty() ? "neither " : " nor ") + place.string();
    }
    throw Error(fmt::format("{} is {}; build or install {}", what, list, name));
}

}  // namespace tactus::file
