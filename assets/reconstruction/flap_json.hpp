// SPDX-License-Identifier: Apache-2.0
// Reads members of JSON objects with lengths in one unit.
#pragma once

#include "assets/file/json.hpp"
#include "dsp/core/types.hpp"
#include "dsp/reconstruction/flap.hpp"

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::reconstruction {

/// The unit of all lengths of a file; keys of lengths end with its name.
struct LengthUnit {
    const char* name;  ///< "m", "mm"
    double metres;
};
inline constexpr LengthUnit in_metres{"m", 1.0}, in_millimetres{"mm", 1e-3};

/// A JSON object; messages begin with its position.
class Members {
public:
    /// Throws Error if it is not an object.
    Members(const file::Json& json, std::string where, LengthUnit unit);

    [[noreturn]] void fail(const std::string& what) const;
    /// Throws Error at the first other member; `lengths` are without the unit.
    void know(std::initializer_list<const char*> names, std::initializer_list<const char*> lengths) const;
    bool has(std::string_view key) const { return json_.contains(key); }
    const file::Json& at(std::string_view key) const;
    std::string text(std::string_view key) const;  ///< must be one line
    std::string name() const;  ///< of the member "name", not empty
    bool truth(std::string_view key) const;
    double number(std::string_view key) const;
    /// m; `key` without the unit.
    double length(std::string_view key) const;
    double length(std::string_view key, double otherwise) const;
    double positive(std::string_view key, double otherwise) const;
    Vec3 place(std::string_view key) const;
    Vec3 direction(std::string_view key) const;  ///< any length except 0; unchanged if the length is already 1
    std::vector<Vec3> places(std::string_view key, std::size_t most) const;
    std::vector<Vec3> directions(std::string_view key, std::size_t most) const;
    std::vector<double> lengths(std::string_view key, std::size_t most) const;
    /// The objects of a list; empty if it is missing.
    std::vector<Members> list(std::string_view key, std::size_t most) const;
    std::optional<Members> object(std::string_view key) const;
    LengthUnit unit() const { return unit_; }

private:
    const file::Json& entries(std::string_view key, std::size_t most) const;
    std::string with_unit(std::string_view key) const;
    Vec3 vector(const file::Json& json, const std::string& key, bool is_direction) const;

    const file::Json& json_;
    std::string where_;
    LengthUnit unit_;
};

/// Reads the members of a flap, all of which are optional.
Flap flap_of(const Members& all);
/// Reads the vessels of a flap only.
std::vector<FlapVessel> vessels_in(const Members& all);
/// Reads the list "vessels" of an object, in m; `where` begins messages. Throws Error, also without the list.
std::vector<FlapVessel> vessels_of(const file::Json& json, const std::string& where);
file::Json json_of(const std::vector<FlapVessel>& vessels);
/// Adds the members of a flap, in m.
void add_members(file::Json& json, const Flap& flap);

}  // namespace tactus::reconstruction
