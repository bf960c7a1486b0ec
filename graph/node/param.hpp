// SPDX-License-Identifier: Apache-2.0
// Parameters: the members of a node that a patch sets by name.
#pragma once

#include "dsp/core/error.hpp"
#include "dsp/core/types.hpp"

#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tactus {

/// Marks what a patch may leave out: an input without a wire, an asset without a file.
struct Optional {};
inline constexpr Optional optional{};

/// A structural parameter shapes memory or wiring and cannot change while the patch runs.
struct Structural {};
inline constexpr Structural structural{};

/// Marks a stiffness that a hand does not feel as such, because a coupling stands between.
struct Internal {};
inline constexpr Internal internal{};

/// Marks a count, a choice by number or a press: it changes at once, never through values in between.
struct Discrete {};
inline constexpr Discrete discrete{};

/// A quantity with unit and range. Its unit is that of the default; a number wire may drive it unless structural.
struct Param {
    Param(std::string_view default_text, std::string_view min_text, std::string_view max_text, const char* about_ = "");
    Param(Structural, std::string_view default_text, std::string_view min_text, std::string_view max_text,
          const char* about_ = "")
        : Param(default_text, min_text, max_text, about_) {
        is_structural = true;
    }
    Param(Internal, std::string_view default_text, std::string_view min_text, std::string_view max_text,
          const char* about_ = "")
        : Param(default_text, min_text, max_text, about_) {
        is_internal = true;
    }
    Param(Discrete, std::string_view default_text, std::string_view min_text, std::string_view max_text,
          const char* about_ = "")
        : Param(default_text, min_text, max_text, about_) {
        is_discrete = true;
    }
    Param(const Param&) = delete;
    Param& operator=(const Param&) = delete;

    operator double() const { return value; }
    /// SI value of "0.8 N/mm". Throws Error without a location when it is no such quantity or out of range.
    double parse(std::string_view text) const;
    void set(std::string_view text) { value = parse(text); }
    /// Driven by a wire: outside its range it is clamped, NaN keeps the last value.
    void drive(double v) noexcept {
        if (v == v) value = v < min ? min : v > max ? max : v;
    }

    double value, min, max;  ///< SI
    std::string unit;        ///< as in the default, "N/mm"
    const char* about;
    bool is_structural = false;
    bool is_internal = false;
    bool is_discrete = false;
};

/// One of several words.
struct Choice {
    // Not string_view: two words in braces would be read as the begin and end of one.
    Choice(std::initializer_list<const char*> words, std::string_view about_ = {})
        : options(words.begin(), words.end()), about(about_) {}  ///< the first word is the default

    bool is(std::string_view word) const { return options[static_cast<std::size_t>(index)] == word; }
    void set(std::string_view word);

    std::vector<std::string> options;
    int index = 0;
    std::string_view about;
};

/// Free text, always structural.
struct Text {
    Text(std::string_view default_text, std::string_view about_ = {}) : value(default_text), about(about_) {}

    std::string value;
    std::string_view about;
    SourceLocation where;
};

/// true or false.
struct Flag {
    Flag(bool default_value, std::string_view about_ = {}) : value(default_value), about(about_) {}
    operator bool() const { return value; }
    void set(std::string_view text);

    bool value;
    std::string_view about;
};

/// Position or direction as three quantities, "[10 mm, 0 mm, 5 mm]" in a patch. Always structural.
struct Vector {
    Vector(std::string_view default_text, std::string_view about_ = {});
    operator const Vec3&() const { return value; }
    /// From "10 mm, 0 mm, 5 mm".
    void set(std::string_view text);

    Vec3 value{0.0, 0.0, 0.0};  ///< SI
    std::string unit;
    std::string_view about;
};

/// The name of an entry of the patch's [assets]; loaded before `prepare`.
struct AssetParam {
    std::string name;                    ///< as the patch gives it, empty when not set
    SourceLocation where;
    std::string_view about, type_name;
    bool is_optional = false;
    std::shared_ptr<const void> loaded;
    std::shared_ptr<const void> (*load)(const std::string& path) = nullptr;
};

/// Loads a `T` from a file; specialised next to each asset type's declaration in graph/node/assets.hpp.
template <class T>
struct AssetLoader;

template <class T>
struct Asset : AssetParam {
    Asset(std::string_view about_ = {}) {
        about = about_;
        type_name = AssetLoader<T>::name;
        load = [](const std::string& path) -> std::shared_ptr<const void> {
            return std::make_shared<const T>(AssetLoader<T>::load(path));
        };
    }
    Asset(Optional, std::string_view about_ = {}) : Asset(about_) { is_optional = true; }
    explicit operator bool() const { return loaded != nullptr; }
    const T& operator*() const { return *static_cast<const T*>(loaded.get()); }
    const T* operator->() const { return static_cast<const T*>(loaded.get()); }
    std::shared_ptr<const T> shared() const { return std::static_pointer_cast<const T>(loaded); }
};

}  // namespace tactus
