// SPDX-License-Identifier: Apache-2.0
// The module of h5_file.hpp: the only file of the product that includes the HDF5 library.
#include "assets/transform/h5_file.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <hdf5.h>

#include <array>

namespace tactus::transform {

namespace {

constexpr hsize_t max_numbers = 1000;  // of a transform; a displacement field has millions, and its type is refused
constexpr hsize_t max_transforms = 100;
constexpr std::size_t max_name = 200;
constexpr std::array<const char*, 2> parameter_names{"TransformParameters", "TranformParameters"},
    fixed_names{"TransformFixedParameters", "TranformFixedParameters"};

/// An identifier of the library, closed at the end.
class Handle {
public:
    using Close = herr_t (*)(hid_t);
    Handle(hid_t id, Close close) : id_(id), close_(close) {}
    ~Handle() {
        if (id_ >= 0) close_(id_);
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    hid_t get() const { return id_; }
    bool is_open() const { return id_ >= 0; }

private:
    hid_t id_;
    Close close_;
};

Handle data_set(hid_t group, const char* name) { return {H5Dopen2(group, name, H5P_DEFAULT), H5Dclose}; }

/// Number of elements of a list, or of a single value.
hsize_t count_of(hid_t set) {
    const Handle space(H5Dget_space(set), H5Sclose);
    const hssize_t count = space.is_open() ? H5Sget_simple_extent_npoints(space.get()) : -1;
    return count < 0 ? 0 : static_cast<hsize_t>(count);
}

std::string text_in(hid_t group, const char* name) {
    const Handle set = data_set(group, name);
    if (!set.is_open() || count_of(set.get()) != 1) throw Error(fmt::format("a transform has no {}", name));
    const Handle type(H5Dget_type(set.get()), H5Tclose);
    if (!type.is_open() || H5Tget_class(type.get()) != H5T_STRING) throw Error(fmt::format("{} is no text", name));
    std::string text;
    if (H5Tis_variable_str(type.get()) > 0) {
        char* value = nullptr;
        const Handle memory(H5Tcopy(H5T_C_S1), H5Tclose);
        H5Tset_size(memory.get(), H5T_VARIABLE);
        H5Tset_cset(memory.get(), H5Tget_cset(type.get()));
        if (H5Dread(set.get(), memory.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, &value) >= 0 && value) text = value;
        if (value) H5free_memory(value);
    } else if (const std::size_t size = H5Tget_size(type.get()); size <= max_name) {
        text.resize(size);
        if (H5Dread(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) text.clear();
        text.resize(text.find('\0') == std::string::npos ? text.size() : text.find('\0'));
    }
    if (text.empty() || text.size() > max_name || text.find('\n') != std::string::npos)
        throw Error(fmt::format("{} is no name", name));
    return text;
}

/// Empty if none of the names is there, and if there are more numbers than a linear transform has.
std::vector<double> numbers_in(hid_t group, const std::array<const char*, 2>& names) {
    for (const char* name : names) {
        if (H5Lexists(group, name, H5P_DEFAULT) <= 0) continue;
        const Handle set = data_set(group, name);
        if (!set.is_open()) throw Error(fmt::format("{} cannot be read", name));
        const hsize_t count = count_of(set.get());
        if (count > max_numbers) return {};
        std::vector<double> numbers(static_cast<std::size_t>(count));
        if (count > 0 && H5Dread(set.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()) < 0)
            throw Error(fmt::format("{} cannot be read", name));
        return numbers;
    }
    return {};
}

void require(bool is_done) {
    if (!is_done) throw Error("the HDF5 library cannot make the file");
}

Handle list_of(hsize_t count) { return {H5Screate_simple(1, &count, nullptr), H5Sclose}; }

void write_text(hid_t group, const char* name, const std::string& text) {
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space = list_of(1);
    H5Tset_size(type.get(), H5T_VARIABLE);
    const Handle set(H5Dcreate2(group, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    const char* value = text.c_str();
    require(set.is_open() && H5Dwrite(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, &value) >= 0);
}

void write_numbers(hid_t group, const std::array<const char*, 2>& names, const std::vector<double>& numbers) {
    const Handle space = list_of(numbers.size());
    const Handle set(H5Dcreate2(group, names[0], H5T_IEEE_F64LE, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                     H5Dclose);
    require(set.is_open() &&
            H5Dwrite(set.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()) >= 0 &&
            H5Lcreate_hard(group, names[0], group, names[1], H5P_DEFAULT, H5P_DEFAULT) >= 0);
}

class Codec final : public H5Codec {
public:
    Codec() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }  // errors are reported by the caller

    std::vector<ItkTransform> read(const std::filesystem::path& path) const override {
        const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
        if (!file.is_open()) throw Error("is no HDF5 file, or is damaged");
        const Handle all(H5Gopen2(file.get(), "/TransformGroup", H5P_DEFAULT), H5Gclose);
        H5G_info_t info{};
        if (!all.is_open() || H5Gget_info(all.get(), &info) < 0)
            throw Error("is no file of transforms: it has no '/TransformGroup'");
        if (info.nlinks > max_transforms)
            throw Error(fmt::format("contains {} transforms: harden them to one before saving", info.nlinks));
        std::vector<ItkTransform> found;
        for (hsize_t n = 0; n < info.nlinks; ++n) {
            const Handle group(H5Gopen2(all.get(), std::to_string(n).c_str(), H5P_DEFAULT), H5Gclose);
            if (!group.is_open()) throw Error(fmt::format("transform {} cannot be read", n));
            found.push_back({text_in(group.get(), "TransformType"), numbers_in(group.get(), parameter_names),
                             numbers_in(group.get(), fixed_names)});
        }
        return found;
    }

    std::string bytes_of(const ItkTransform& transform) const override {
        const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
        constexpr std::size_t step = 1 << 16;
        H5Pset_fapl_core(access.get(), step, 0);  // in memory alone
        const Handle file(H5Fcreate("transform.h5", H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose);
        require(file.is_open());
        write_text(file.get(), "ITKVersion", "5.2");
        write_text(file.get(), "HDFVersion", H5_VERS_INFO);
        const Handle all(H5Gcreate2(file.get(), "/TransformGroup", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
        const Handle group(H5Gcreate2(all.get(), "0", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
        write_text(group.get(), "TransformType", transform.type);
        write_numbers(group.get(), fixed_names, transform.fixed);
        write_numbers(group.get(), parameter_names, transform.parameters);
        require(H5Fflush(file.get(), H5F_SCOPE_LOCAL) >= 0);
        const ssize_t size = H5Fget_file_image(file.get(), nullptr, 0);
        require(size > 0);
        std::string bytes(static_cast<std::size_t>(size), '\0');
        require(H5Fget_file_image(file.get(), bytes.data(), bytes.size()) == size);
        return bytes;
    }
};

}  // namespace

}  // namespace tactus::transform

extern "C" const tactus::transform::H5Codec* tactus_h5_codec() {
    static const tactus::transform::Codec codec;
    return &codec;
}
