// SPDX-License-Identifier: Apache-2.0
#include "graph/plugin/plugins.hpp"

#include "assets/file/part.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "graph/node/plugin.hpp"
#include "graph/plugin/declaration.hpp"

#include <fmt/format.h>

#include <cxxabi.h>
#include <dlfcn.h>
#include <elf.h>
#include <link.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <memory>
#include <string_view>
#include <system_error>

namespace tactus::plugin {

namespace fs = std::filesystem;

namespace {

constexpr const char* variable = "TACTUS_NODES";

/// "built by GCC 13 with -ffast-math from the headers 0.1.0-…"
std::string described(const Abi& abi) {
    return fmt::format("{}{}{}, headers {}", abi.compiler, *abi.options ? " with" : "", abi.options, abi.headers);
}

void check_abi(const fs::path& file, const PluginEntry& entry) {
    const Abi own = this_abi(), &its = entry.abi;
    const auto same = [](const char* a, const char* b) { return std::string_view(a) == b; };
    if (same(own.headers, its.headers) && same(own.compiler, its.compiler) && same(own.options, its.options) &&
        own.layout == its.layout)
        return;
    const bool by_layout_only =
        same(own.headers, its.headers) && same(own.compiler, its.compiler) && same(own.options, its.options);
    throw Error(
        fmt::format("{}: the plug-in was built for another Tactus: {}; this one has: {}{}. Rebuild the plug-in with "
                    "the headers and the compiler of this one",
                    file.string(), described(its), described(own),
                    by_layout_only ? " (an option of the compiler changes the layout of its structs)" : ""));
}

/// Of dlopen, without the name of the file.
std::string reason_of(const fs::path& file) {
    const char* const text = ::dlerror();
    std::string reason = text ? text : "unknown reason";
    if (reason.starts_with(file.string() + ": ")) reason.erase(0, file.string().size() + 2);
    constexpr std::string_view symbol = "undefined symbol: ";
    if (reason.starts_with(symbol)) {
        const std::string name =
            reason.substr(symbol.size(), reason.find_first_of(" ,", symbol.size()) - symbol.size());
        int failure = 0;
        const std::unique_ptr<char, void (*)(void*)> readable(
            abi::__cxa_demangle(name.c_str(), nullptr, nullptr, &failure), std::free);
        if (readable) reason = fmt::format("{}{}", symbol, readable.get());
    }
    return reason;
}

/// Of a file that was cut short, as by a copy that was ended, the loader maps what is not there: the first access would end the
/// program.
void check_whole(const fs::path& file, std::uintmax_t size) {
    std::ifstream bytes(file, std::ios::binary);
    ElfW(Ehdr) head{};
    if (!bytes.read(reinterpret_cast<char*>(&head), sizeof(head)) || std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0 ||
        head.e_ident[EI_CLASS] != (sizeof(void*) == 8 ? ELFCLASS64 : ELFCLASS32))
        return;  // the loader says what it is instead
    for (unsigned i = 0; i < head.e_phnum; ++i) {
        ElfW(Phdr) part{};
        bytes.seekg(static_cast<std::streamoff>(head.e_phoff + i * std::uint64_t{head.e_phentsize}));
        const bool is_read = static_cast<bool>(bytes.read(reinterpret_cast<char*>(&part), sizeof(part)));
        if (!is_read || (part.p_type == PT_LOAD && (part.p_offset > size || part.p_filesz > size - part.p_offset)))
            throw Error(fmt::format("{}: not a plug-in with nodes: the file is cut short; build or copy it again",
                                    file.string()));
    }
}

/// Inside a program that loaded libtactus for itself alone, as Python does, plug-ins would not find its functions.
void share_own_symbols() {
    static_cast<void>(::dlopen(file::this_object().c_str(), RTLD_NOW | RTLD_NOLOAD | RTLD_GLOBAL));
    static_cast<void>(::dlerror());
}

/// Expands a path given by the user to plug-in files, sorted.
std::vector<fs::path> files_of(const fs::path& path) {
    std::error_code failure;
    if (!fs::is_directory(path, failure)) return {fs::weakly_canonical(path)};
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(path, failure))
        if (entry.path().extension() == ".so") files.push_back(fs::weakly_canonical(entry.path()));
    if (failure) throw Error(fmt::format("{}: cannot read the folder: {}", path.string(), failure.message()));
    std::ranges::sort(files);
    return files;
}

std::vector<fs::path> wanted_files() {
    std::vector<fs::path> files;
    const auto add = [&](const fs::path& path) {
        for (const fs::path& file : files_of(path))
            if (std::ranges::find(files, file) == files.end()) files.push_back(file);
    };
    const char* const given = std::getenv(variable);
    for (std::string_view rest = given ? given : ""; !rest.empty();) {
        const std::size_t end = std::min(rest.find(':'), rest.size());
        if (end > 0) add(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    std::error_code failure;
    for (const fs::path& place : file::places_of_part("nodes", TACTUS_INSTALLED_NODES))
        if (fs::is_directory(place, failure)) add(place);
    return files;
}

}  // namespace

Plugin load(const fs::path& given) {
    const fs::path file = fs::weakly_canonical(given);
    check_whole(file, file::require_file(file));
    share_own_symbols();
    void* const object = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (!object) {
        const std::string reason = reason_of(file);
        const bool lacks_symbol = reason.find("undefined symbol") != std::string::npos;
        throw Error(fmt::format("{}: {}: {}", file.string(),
                                lacks_symbol ? "the plug-in needs what this Tactus does not have; rebuild it with the "
                                               "headers of this one, and link what else it needs"
                                             : "not a plug-in with nodes",
                                reason));
    }
    const auto* const entry = static_cast<const PluginEntry*>(::dlsym(object, "tactus_plugin"));
    if (!entry || entry->magic != PluginEntry::mark)
        throw Error(fmt::format(
            "{}: not a plug-in with nodes: it exports no 'tactus_plugin' of this kind; its source ends in a "
            "line TACTUS_PLUGIN(\"name\", \"version\", Type, ...)",
            file.string()));
    check_abi(file, *entry);

    Plugin plugin{entry->name, entry->version, file, 0, {}};
    entry->each([](void* to, const NodeType& type) { static_cast<Plugin*>(to)->types.push_back(&type); }, &plugin);
    for (const NodeType* type : plugin.types) try {
            check_declaration(*type);
        } catch (const std::exception& error) {
            throw Error(fmt::format("{}: node type '{}': {}", file.string(), type->name, error.what()));
        } catch (...) {
            throw Error(fmt::format("{}: node type '{}': its constructor throws", file.string(), type->name));
        }
    Hash hash;
    file::add_file(hash, file);
    plugin.hash = hash.value();
    return plugin;
}

void use(const std::string& path) {
    std::error_code failure;
    const fs::path absolute = fs::absolute(path);
    if (!fs::exists(absolute, failure)) throw Error(fmt::format("{}: no such file or folder with nodes", path));
    if (absolute.string().find(':') != std::string::npos)
        throw Error(
            fmt::format("{}: a path to nodes may hold no ':', which separates the paths of {}", path, variable));
    const char* const before = std::getenv(variable);
    const std::string all = before && *before ? absolute.string() + ":" + before : absolute.string();
    ::setenv(variable, all.c_str(), 1);
}

bool are_given() {
    const char* const given = std::getenv(variable);
    return given && *given;
}

const std::vector<Plugin>& all() {
    static const std::vector<Plugin> loaded = [] {
        std::vector<Plugin> plugins;
        for (const fs::path& file : wanted_files()) plugins.push_back(load(file));
        return plugins;
    }();
    return loaded;
}

const Plugin* plugin_of(const NodeType& type) {
    for (const Plugin& plugin : all())
        if (std::ranges::find(plugin.types, &type) != plugin.types.end()) return &plugin;
    return nullptr;
}

}  // namespace tactus::plugin
