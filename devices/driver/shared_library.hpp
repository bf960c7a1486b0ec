// SPDX-License-Identifier: Apache-2.0
// A vendor's library, loaded when a device is opened: nothing of it is needed to build Tactus.
#pragma once

#include "dsp/core/error.hpp"

#include <string>
#include <vector>

namespace tactus::driver {

class SharedLibrary {
public:
    /// Loads the first of `candidates` that can be loaded: paths, or names that the system looks for. It stays loaded
    /// for ever: a vendor's threads may still run in it. Throws Error that names `product`, each candidate and why the
    /// last one failed.
    SharedLibrary(const std::string& product, const std::vector<std::string>& candidates);

    /// Sets `function` to the one of that name. Throws Error that names library and function.
    template <class F>
    void require(F*& function, const char* name) const {
        function = reinterpret_cast<F*>(find(name));
        if (!function) fail(name);
    }
    /// Null when the library has none.
    template <class F>
    void look_for(F*& function, const char* name) const {
        function = reinterpret_cast<F*>(find(name));
    }

    const std::string& path() const { return path_; }

private:
    void* find(const char* name) const noexcept;
    [[noreturn]] void fail(const char* name) const;

    std::string product_, path_;
    void* handle_ = nullptr;
};

/// Where a vendor's library may be.
struct LibraryPlaces {
    const char* sdk_variable;  ///< of the environment: the folder of the vendor's SDK
    std::vector<std::string> folders;  ///< within the SDK; may hold one "*" as a whole part of the path
    std::vector<std::string> stems;  ///< "libHD.so": how the names of its files begin
    std::vector<std::string> names;  ///< for which the system looks in the end
};

/// In the order in which they are to be tried. `given`: a file that the user named, which is then the only one; or "".
std::vector<std::string> library_candidates(const std::string& given, const LibraryPlaces& places);

/// Files below `folder` (which may hold one "*" as a whole part of the path) whose names begin with `stem`, sorted,
/// newest version last in the alphabet first.
std::vector<std::string> libraries_in(const std::string& folder, const std::string& stem);

}  // namespace tactus::driver
