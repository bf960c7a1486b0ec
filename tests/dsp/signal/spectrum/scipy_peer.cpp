// SPDX-License-Identifier: Apache-2.0
// Spectra beside scipy's on the same record, when this machine has scipy.
#include "dsp/core/random.hpp"
#include "dsp/signal/spectrum/cross.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

using namespace tactus;
namespace fs = std::filesystem;

namespace {

constexpr const char* script = R"(
import sys, numpy as np, scipy.signal as s
folder = sys.argv[1]
for case in sys.argv[2:]:
    n, detrend, kind = case.split('-')
    n = int(n)
    x, y = (np.fromfile(folder + '/' + c).astype(kind) for c in 'xy')
    o = dict(fs=8000., window='hann', nperseg=n, noverlap=n // 3, detrend=False if detrend == 'none' else detrend)
    pxx, pyy = (s.welch(v, **o)[1] for v in (x, y))
    pxy = s.csd(x, y, **o)[1]
    med = s.welch(x, average='median', scaling='spectrum', **o)[1]
    out = [pxx, pyy, pxy.real, pxy.imag, s.coherence(x, y, **o)[1], (pxy / pxx).real, (pxy / pxx).imag, med]
    np.concatenate([v.astype('float64') for v in out]).tofile(folder + '/' + case)
)";

struct SpectrumCase {
    std::size_t length;
    const char* detrend;
    bool is_single;
    std::string name() const { return fmt::format("{}-{}-{}", length, detrend, is_single ? "float32" : "float64"); }
};

struct Folder {
    fs::path path = fs::temp_directory_path() / fmt::format("tactus_scipy_{}", ::getpid());
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
    void write(const char* name, const std::vector<double>& values) const {
        std::ofstream(path / name, std::ios::binary)
            .write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(8 * values.size()));
    }
    std::vector<double> read(const std::string& name) const {
        std::vector<double> values(fs::file_size(path / name) / 8);
        std::ifstream(path / name, std::ios::binary)
            .read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(8 * values.size()));
        return values;
    }
};

double farthest(std::span<const double> got, std::span<const double> wanted) {
    double scale = 0.0, apart = 0.0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        scale = std::max(scale, std::abs(wanted[i]));
        apart = std::max(apart, std::abs(got[i] - wanted[i]));
    }
    return apart / scale;
}

template <class T>
void compare_all(const Folder& folder, const std::vector<double>& x, const std::vector<double>& y,
                 const SpectrumCase& one) {
    const bool single = one.is_single;
    const std::size_t n = one.length;
    const std::string_view name = one.detrend;
    const signal::Detrend detrend = name == "none"       ? signal::Detrend::none
                                    : name == "constant" ? signal::Detrend::constant
                                                         : signal::Detrend::linear;
    CAPTURE(one.name());
    const std::vector<double> wanted = folder.read(one.name());
    const std::vector<T> a(x.begin(), x.end()), b(y.begin(), y.end());
    signal::WelchSettings settings{
        8000.0, n, n / 3, signal::WindowKind::hann, detrend, signal::Averaging::mean, signal::Scaling::density};
    const signal::CrossSpectra cross = signal::cross_spectra<T>(a, b, settings);
    const std::size_t bins = n / 2 + 1;
    REQUIRE(wanted.size() == 8 * bins);
    const auto part = [&](std::size_t i) { return std::span(wanted).subspan(i * bins, bins); };
    const double tolerance = single ? 2e-5 : detrend == signal::Detrend::linear ? 1e-11 : 1e-12;
    CHECK(farthest(cross.xx, part(0)) <= tolerance);
    CHECK(farthest(signal::welch<T>(a, settings).power, part(0)) <= tolerance);
    CHECK(farthest(cross.yy, part(1)) <= tolerance);
    std::vector<double> re, im, h_re, h_im;
    for (const auto& value : cross.xy) re.push_back(value.real()), im.push_back(value.imag());
    for (const auto& value : cross.h1()) h_re.push_back(value.real()), h_im.push_back(value.imag());
    CHECK(farthest(re, part(2)) <= tolerance);
    CHECK(farthest(im, part(3)) <= tolerance);
    // Ratios of small powers: as exact as the record's own rounding lets them be.
    const double ratio = single ? 1e-3 : 1e-10;
    const std::vector<double> gamma = cross.coherence();
    CHECK(farthest(std::span(gamma).subspan(2), part(4).subspan(2)) <= ratio);
    CHECK(farthest(std::span(h_re).subspan(2), part(5).subspan(2)) <= ratio);
    CHECK(farthest(std::span(h_im).subspan(2), part(6).subspan(2)) <= ratio);
    settings.averaging = signal::Averaging::median;
    settings.scaling = signal::Scaling::spectrum;
    CHECK(farthest(signal::welch<T>(a, settings).power, part(7)) <= tolerance);
}

}  // namespace

TEST_CASE("spectra, cross-spectra, coherence and H1 equal scipy's at any length", "[slow]") {
    if (std::system("/usr/bin/python3 -c 'import scipy.signal' 2>/dev/null") != 0) {
        tactus::test::skip("no python3 with scipy here");
        return;
    }
    const Folder folder;
    std::ofstream(folder.path / "peer.py") << script;
    const Random random{11};
    std::vector<double> x(20'011), y(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double t = static_cast<double>(i) / 8000.0;
        x[i] = 0.7 + std::sin(2.0 * 3.14159265358979 * 233.0 * t) + 0.3 * random.normal(i) + 0.1 * t;
        y[i] = 0.5 * x[i] + (i > 2 ? 0.4 * x[i - 3] : 0.0) + 0.2 * random.normal(i + 100'000);
    }
    folder.write("x", x);
    folder.write("y", y);
    std::vector<SpectrumCase> cases{{256, "constant", true}, {255, "linear", true}};
    for (const std::size_t n : {256u, 255u, 509u, 1000u})
        for (const char* const detrend : {"none", "constant", "linear"}) cases.push_back({n, detrend, false});
    // All by one program: reading scipy takes longer than the spectra.
    std::string command = fmt::format("/usr/bin/python3 {0}/peer.py {0}", folder.path.string());
    for (const SpectrumCase& one : cases) command += " " + one.name();
    REQUIRE(std::system(command.c_str()) == 0);
    for (const SpectrumCase& one : cases) {
        if (one.is_single) compare_all<float>(folder, x, y, one);
        else compare_all<double>(folder, x, y, one);
    }
}
