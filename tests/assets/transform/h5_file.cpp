// SPDX-License-Identifier: Apache-2.0
#include "assets/transform/h5_file.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

Pose some_motion(std::uint64_t n) {
    const auto between = [&](std::uint64_t k) { return 2.0 * Random{n}.uniform(k) - 1.0; };
    return {0.3 * Vec3(between(0), between(1), between(2)),
            glm::normalize(Quat(between(3), between(4), between(5), between(6)))};
}

std::string refusal_of_h5(const std::filesystem::path& path) {
    try {
        transform::read_motion(path);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

bool has_h5py() {
    if (std::system("/usr/bin/python3 -c 'import h5py' >/dev/null 2>&1") == 0) return true;
    test::skip("there is no h5py for /usr/bin/python3");
    return false;
}

/// Runs a script of Python and returns its output.
std::istringstream output_of(const TemporaryFolder& folder, const std::string& script) {
    file::write_whole_file(folder / "script.py", script);
    REQUIRE(std::system(
                fmt::format("cd {} && /usr/bin/python3 script.py > output.txt", folder.path.string()).c_str()) == 0);
    return std::istringstream(file::read_whole_file(folder / "output.txt"));
}

}  // namespace

TEST_CASE("a transform in HDF5 that is written and read again is the same motion") {
    const TemporaryFolder folder;
    for (std::uint64_t n = 0; n < 10; ++n) {
        const Pose motion = some_motion(n);
        transform::write_motion(folder / "t.h5", motion);
        const Pose back = transform::read_motion(folder / "t.h5");
        CHECK(glm::length(back.position - motion.position) < 1e-12);
        CHECK(std::abs(std::abs(glm::dot(back.orientation, motion.orientation)) - 1.0) < 1e-12);
    }
}

TEST_CASE("h5py finds the numbers of a transform under the names of both versions of ITK") {
    if (!has_h5py()) return;
    const TemporaryFolder folder;
    const Pose motion = some_motion(3);
    transform::write_motion(folder / "t.h5", motion);
    std::istringstream output =
        output_of(folder,
                  "import h5py\n"
                  "g = h5py.File('t.h5', 'r')['TransformGroup']\n"
                  "print(len(g), g['0/TransformType'][0].decode())\n"
                  "for s in ('s', ''):\n"
                  "    p, f = g['0/Tran%sformParameters' % s], g['0/Tran%sformFixedParameters' % s]\n"
                  "    print(len(p), len(f), *['%.17g' % v for v in list(p) + list(f)])\n");
    std::size_t count = 0;
    std::string type;
    REQUIRE(output >> count >> type);
    CHECK(count == 1);
    CHECK(type == "AffineTransform_double_3_3");
    const transform::ItkTransform expected = transform::itk_transform_of(motion);
    for (int spelling = 0; spelling < 2; ++spelling) {
        std::size_t parameters = 0, fixed = 0;
        REQUIRE(output >> parameters >> fixed);
        REQUIRE(parameters == 12);
        REQUIRE(fixed == 3);
        for (const auto* list : {&expected.parameters, &expected.fixed})
            for (const double value : *list) {
                double found = 0.0;
                REQUIRE(output >> found);
                CHECK(found == value);
            }
    }
}

TEST_CASE("transforms in HDF5 of ITK 4, of single precision and in a composite of one are read") {
    if (!has_h5py()) return;
    const TemporaryFolder folder;
    output_of(folder,
              "import h5py, numpy as np\n"
              "def write(name, parts, wrong, kind):\n"
              "    with h5py.File(name, 'w') as f:\n"
              "        for n, (t, p, c) in enumerate(parts):\n"
              "            g = f.create_group('/TransformGroup/%d' % n)\n"
              "            g.create_dataset('TransformType', (1,), dtype=h5py.string_dtype('ascii'))[0] = t\n"
              "            if p is None: continue\n"
              "            s = '' if wrong else 's'\n"
              "            g['Tran%sformParameters' % s] = np.array(p, kind)\n"
              "            g['Tran%sformFixedParameters' % s] = np.array(c, kind)\n"
              "quarter = [0,-1,0, 1,0,0, 0,0,1, 10,0,0]\n"
              "affine = ('AffineTransform_double_3_3', quarter, [0,0,0])\n"
              "write('itk4.h5', [affine], True, 'f8')\n"
              "write('single.h5', [('AffineTransform_float_3_3', quarter, [0,0,0])], False, 'f4')\n"
              "write('one.h5', [('CompositeTransform_double_3_3', None, None), affine], False, 'f8')\n"
              "write('two.h5', [('CompositeTransform_double_3_3', None, None), affine, affine], False, 'f8')\n"
              "write('field.h5', [('DisplacementFieldTransform_double_3_3', [0]*3000, [1]*18)], False, 'f8')\n"
              "write('short.h5', [('AffineTransform_double_3_3', [1,2], [0,0,0])], False, 'f8')\n"
              "write('nan.h5', [('AffineTransform_double_3_3', [float('nan')]*12, [0,0,0])], False, 'f8')\n"
              "with h5py.File('other.h5', 'w') as f: f['x'] = [1]\n");
    for (const char* name : {"itk4.h5", "single.h5", "one.h5"}) {
        CAPTURE(name);
        CHECK(glm::length(transform::read_motion(folder / name).apply(Vec3(0.0)) / mm - Vec3(0, 10, 0)) < 1e-9);
    }
    CHECK_THAT(refusal_of_h5(folder / "two.h5"), ContainsSubstring("contains 3 transforms: harden them to one"));
    CHECK_THAT(refusal_of_h5(folder / "field.h5"), ContainsSubstring("a 'DisplacementFieldTransform' is not read"));
    CHECK_THAT(refusal_of_h5(folder / "short.h5"), ContainsSubstring("short.h5: AffineTransform needs 12 parameters"));
    CHECK_THAT(refusal_of_h5(folder / "nan.h5"), ContainsSubstring("is not a number of a transform in mm"));
    CHECK_THAT(refusal_of_h5(folder / "other.h5"), ContainsSubstring("has no '/TransformGroup'"));
}

TEST_CASE("a damaged file in HDF5 is refused with one error, whatever the library does with it", "[slow]") {
    const TemporaryFolder folder;
    transform::write_motion(folder / "whole.h5", some_motion(1));
    const std::string whole = file::read_whole_file(folder / "whole.h5");
    file::write_whole_file(folder / "text.h5", "no HDF5");
    CHECK_THAT(refusal_of_h5(folder / "text.h5"), ContainsSubstring("text.h5: is no HDF5 file, or is damaged"));
    CHECK_THAT(refusal_of_h5(folder / "missing.h5"), ContainsSubstring("missing.h5"));
    for (std::uint64_t n = 0; n < 60; ++n) {
        std::string damaged = whole;
        const Random random{n};
        if (n % 3 == 0) damaged.resize(static_cast<std::size_t>(random.uniform(0) * double(whole.size())));
        for (std::uint64_t k = 1; k < 20; ++k) {
            const auto at = static_cast<std::size_t>(random.uniform(2 * k) * 4000.0);
            if (at < damaged.size()) damaged[at] = static_cast<char>(random.uniform(2 * k + 1) * 256.0);
        }
        file::write_whole_file(folder / "damaged.h5", damaged);
        // A motion, if the damage changed nothing that is read, or one error that names the file.
        const std::string refusal = refusal_of_h5(folder / "damaged.h5");
        CAPTURE(n, refusal);
        CHECK((refusal.empty() || refusal.find("damaged.h5: ") != std::string::npos));
    }
}
