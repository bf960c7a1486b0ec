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

/// Marks an input that needs no wire, or an asset that needs no file.
struct Optional {};
inline constexpr Optional optional{};

/// Marks an input that describes the world: a bone, a target, a frame. A force computed from an old world value stays
/// passive, like a force from a static bone. All other inputs are force inputs: from an old value they would hold the
/// force while the hand moves on. Snapshots are world inputs by their type.
struct OfWorld {};
inline constexpr OfWorld of_world{};

/// Marks a parameter that determines memory or wiring. It cannot change while the patch runs.
struct Structural {};
inline constexpr Structural structural{};

/// Marks a stiffness that reaches the hand only through a coupling, so the device's stability limit does not apply to
/// it.
struct Internal {};
inline constexpr Internal internal{};

/// Marks a count or an index. It changes in one step, while forces that depend on it are suspended; other parameters
/// ramp.
struct Discrete {};
inline constexpr Discrete discrete{};

/// Marks a discrete parameter that is a request of the user, such as a button press. It is passed on immediately, like
/// a button of a device, and forces are not suspended.
struct AsTrigger {};
inline constexpr AsTrigger as_trigger{};

/// A quantity with unit and range. The unit of the default is the unit of the parameter. A number wire may drive it
/// unless it is structural. The constructors throw Error for text that is not a quantity.
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
    Param(AsTrigger, std::string_view default_text, std::string_view min_text, std::string_view max_text,
          const char* about_ = "")
        : Param(discrete, default_text, min_text, max_text, about_) {
        is_trigger = true;
    }
    Param(const Param&) = delete;
    Param& operator=(const Param&) = delete;

    operator double() const { return value; }
    /// Returns the SI value of text such as "0.8 N/mm". Throws Error, without a location, for another dimension or a
    /// value out of range.
    double parse(std::string_view text) const;
    /// Throws Error like `parse`; the value then stays unchanged.
    void set(std::string_view text) { value = parse(text); }
    /// Sets the value from a wire, in SI. A value out of range is clamped; NaN keeps the last value.
    void drive(double v) noexcept {
        if (v == v) value = v < min ? min : v > max ? max : v;
    }

    double value, min, max;  ///< SI
    std::string unit;  ///< that of the default: "N/mm"
    const char* about;
    bool is_structural = false;
    bool is_internal = false;
    bool is_discrete = false;
    bool is_trigger = false;  ///< see AsTrigger
};

/// A choice of one word from a list. The first is the default.
struct Choice {
    // Not string_view: two words in braces would be taken as begin and end of one string_view.
    Choice(std::initializer_list<const char*> words, std::string_view about_ = {})
        : options(words.begin(), words.end()), about(about_) {}

    bool is(std::string_view word) const { return options[static_cast<std::size_t>(index)] == word; }
    /// Throws Error if `word` is not in the list.
    void set(std::string_view word);

    std::vector<std::string> options;
    int index = 0;  ///< of the chosen option
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
    /// Throws Error unless the text is "true" or "false".
    void set(std::string_view text);

    bool value;
    std::string_view about;
};

/// Position or direction as three quantities, "[10 mm, 0 mm, 5 mm]" in a patch. Always structural.
struct Vector {
    Vector(std::string_view default_text, std::string_view about_ = {});
    operator const Vec3&() const { return value; }
    /// Sets it from text such as "10 mm, 0 mm, 5 mm". Throws Error.
    void set(std::string_view text);

    Vec3 value{0.0, 0.0, 0.0};  ///< SI
    std::string unit;  ///< that of the default: "mm"
    std::string_view about;
};

/// The name of an entry of the patch's [assets]. The engine loads it before `prepare`.
struct AssetParam {
    std::string name;  ///< as given in the patch; empty if not set
    SourceLocation where;
    std::string_view about, type_name;
    bool is_optional = false;
    std::shared_ptr<const void> loaded;  ///< null when the patch names none
    std::shared_ptr<const void> (*load)(const std::string& path) = nullptr;  ///< throws Error
};

/// Loads a `T` from a file. graph/node/assets.hpp specialises it for each type of asset.
template <class T>
struct AssetLoader;

/// An asset of type `T`. Nodes that name the same file share it. Check an optional one by `if (asset)` before use.
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
