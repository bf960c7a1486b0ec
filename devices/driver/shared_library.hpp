// SPDX-License-Identifier: Apache-2.0
// A vendor's library, loaded when a device is opened: building Tactus requires no part of it.
#pragma once

#include "dsp/core/error.hpp"

#include <string>
#include <vector>

namespace tactus::driver {

class SharedLibrary {
public:
    /// Loads the first of `candidates` that can be loaded: paths, or names that the system searches for. The library is
    /// never unloaded, because a vendor's threads may still run in it. Throws Error that names `product`, each
    /// candidate, and the reason of the last failure.
    SharedLibrary(const std::string& product, const std::vector<std::string>& candidates);

    /// Sets `function` to the symbol of that name. Throws Error that names library and function.
    template <class F>
    void require(F*& function, const char* name) const {
        function = reinterpret_cast<F*>(find(name));
        if (!function) fail(name);
    }
    /// Sets it to null if the library does not have the symbol.
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

/// Search locations of a vendor's library.
struct LibraryPlaces {
    const char* sdk_variable;  ///< environment variable with the folder of the vendor's SDK
    std::vector<std::string> folders;  ///< within the SDK; may contain one "*" as a whole component of the path
    std::vector<std::string> stems;  ///< "libHD.so": prefixes of its file names
    std::vector<std::string> names;  ///< tried last, by the system's search path
};

/// Returns the candidates in the order of trial. `given`: a file that the user named, which is then the only one; or
/// "".
std::vector<std::string> library_candidates(const std::string& given, const LibraryPlaces& places);

/// Returns the files below `folder` (which may contain one "*" as a whole component of the path) whose names begin with
/// `stem`, in descending order of their names.
std::vector<std::string> libraries_in(const std::string& folder, const std::string& stem);

}  // namespace tactus::driver
