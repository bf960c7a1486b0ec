// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/fft.hpp"

#include "dsp/signal/spectrum/fft_kernel.hpp"
#include "dsp/signal/spectrum/lane_scalar.hpp"

#include <kissfft/kissfft.hh>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <type_traits>

namespace tactus::signal {

namespace {

/// exp(−2πi·k/n), rounded once.
template <class T>
std::complex<T> root_of_unity(std::size_t k, std::size_t n) {
    const long double angle =
        2.0L * std::numbers::pi_v<long double> * static_cast<long double>(k) / static_cast<long double>(n);
    return {static_cast<T>(std::cos(angle)), static_cast<T>(-std::sin(angle))};
}

// Above this, KissFFT's general radix, with p² products for p values, costs more than the chirp transform.
constexpr std::size_t largest_radix = 31;

bool is_smooth(std::size_t n) {
    for (std::size_t p = 2; p <= largest_radix; ++p)
        while (n % p == 0) n /= p;
    return n == 1;
}

struct AnyMachine;

}  // namespace

namespace detail {

template <class T>
const LaneKernels<T>& lane_kernels() noexcept {
    static constexpr LaneKernels<T> anywhere = LaneKernels<T>::template of<AnyMachine>();
#if defined(__x86_64__)
    static const LaneKernels<T>& chosen = __builtin_cpu_supports("avx2") ? lane_kernels_of_avx2<T>() : anywhere;
    return chosen;
#else
    return anywhere;
#endif
}

namespace {

/// The loops over numbers, with the interface of those over lanes.
template <class T, class V>
struct Kernels : FftKernel<AnyMachine, T, V> {};
template <class T>
struct Kernels<T, Lanes<T>> {
    static void transform(const Lanes<T>* in, Lanes<T>* out, std::size_t n, const T* turns) noexcept {
        lane_kernels<T>().transform(in, out, n, turns);
    }
    static void separate(Lanes<T>* z, std::size_t last, const T* turns) noexcept {
        lane_kernels<T>().separate(z, last, turns);
    }
};

template <class T>
std::vector<T> fft_turns(std::size_t n) {
    // Rounded as in KissFFT.
    const T step = -2 * std::acos(static_cast<T>(-1)) / static_cast<T>(n);
    std::vector<T> turns;
    const std::size_t first = FftKernel<AnyMachine, T, T>::first_length(n);
    for (std::size_t m = first == 8 ? 2 : 4; m < n; m *= 4)
        for (std::size_t k = 0; k < m; ++k)
            for (std::size_t j = 1; j <= 3; ++j) {
                const T angle = static_cast<T>(j * k * (n / (4 * m))) * step;
                turns.push_back(std::cos(angle));
                turns.push_back(std::sin(angle));
            }
    return turns;
}

}  // namespace

/// The number type of KissFFT. Interleaved values are std::complex of it.
template <class V>
struct KissNumber {
    using type = V;
};
template <>
struct KissNumber<Lanes<double>> {
    using type = LaneScalar<double>;
};
template <>
struct KissNumber<Lanes<float>> {
    using type = LaneScalar<float>;
};

template <class T, class V>
struct FftPlan<T, V>::Kiss {
    using Complex = std::complex<typename KissNumber<V>::type>;
    static_assert(sizeof(Complex) == 2 * sizeof(V));

    explicit Kiss(std::size_t n) : fft(n, false) {
        // KissFFT's general radix allocates a buffer at first use: trigger that here.
        const std::vector<Complex> silence(n);
        std::vector<Complex> out(n);
        fft.transform(silence.data(), out.data());
    }

    void operator()(const V* in, V* out) const noexcept {
        fft.transform(reinterpret_cast<const Complex*>(in), reinterpret_cast<Complex*>(out));
    }

    kissfft<typename KissNumber<V>::type> fft;
};

/// exp(−πik²/n), the transform of its conjugate, and two work arrays for the convolution.
template <class T, class V>
struct FftPlan<T, V>::Chirp {
    explicit Chirp(std::size_t convolved) : length(convolved), plan(convolved), work(4 * convolved) {}

    std::size_t length;
    FftPlan plan;
    std::vector<T> turn, kernel;
    LineVector<V> work;
};

template <class T, class V>
FftPlan<T, V>::FftPlan(std::size_t n) : n_(n) {
    if constexpr (!std::is_same_v<T, V>)
        if (n >= 4 && std::has_single_bit(n)) {
            turns_ = fft_turns<T>(n);
            return;
        }
    if (is_smooth(n)) {
        kiss_ = std::make_unique<Kiss>(n);
        return;
    }
    const std::size_t length = std::bit_ceil(2 * n - 1);
    chirp_ = std::make_unique<Chirp>(length);
    FftPlan<T, T> plan(length);
    std::vector<T> a(2 * length), b(2 * length);
    for (std::size_t k = 0; k < n; ++k) {
        const std::complex<T> turn = root_of_unity<T>(k * k % (2 * n), 2 * n);
        chirp_->turn.push_back(turn.real());
        chirp_->turn.push_back(turn.imag());
        for (const std::size_t at : {k, (length - k) % length}) a[2 * at] = turn.real(), a[2 * at + 1] = -turn.imag();
    }
    const T* spectrum = plan(a.data(), b.data());
    // Includes the scale of the inner inverse transform.
    for (std::size_t i = 0; i < 2 * length; ++i) chirp_->kernel.push_back(spectrum[i] / static_cast<T>(length));
}

template <class T, class V>
FftPlan<T, V>::~FftPlan() = default;
template <class T, class V>
FftPlan<T, V>::FftPlan(const FftPlan& other)
    : n_(other.n_),
      turns_(other.turns_),
      kiss_(other.kiss_ ? std::make_unique<Kiss>(*other.kiss_) : nullptr),
      chirp_(other.chirp_ ? std::make_unique<Chirp>(*other.chirp_) : nullptr) {}
template <class T, class V>
FftPlan<T, V>::FftPlan(FftPlan&&) noexcept = default;
template <class T, class V>
FftPlan<T, V>& FftPlan<T, V>::operator=(const FftPlan& other) {
    return *this = FftPlan(other);
}
template <class T, class V>
FftPlan<T, V>& FftPlan<T, V>::operator=(FftPlan&&) noexcept = default;

template <class T, class V>
V* FftPlan<T, V>::operator()(V* a, V* b) noexcept {
    if (chirp_) return through_chirp(a);
    if constexpr (!std::is_same_v<T, V>)
        if (!kiss_) return Kernels<T, V>::transform(a, b, n_, turns_.data()), b;
    (*kiss_)(a, b);
    return b;
}

template <class T, class V>
V* FftPlan<T, V>::through_chirp(V* a) noexcept {
    const std::size_t length = chirp_->length;
    const T *turn = chirp_->turn.data(), *kernel = chirp_->kernel.data();
    V *u = chirp_->work.data(), *v = u + 2 * length;
    for (std::size_t i = 0; i < 2 * n_; i += 2) {
        u[i] = a[i] * turn[i] - a[i + 1] * turn[i + 1];
        u[i + 1] = a[i] * turn[i + 1] + a[i + 1] * turn[i];
    }
    std::fill(u + 2 * n_, u + 2 * length, V{});
    chirp_->plan(u, v);
    // Swaps real and imaginary parts: the following forward transform is then the inverse, in place.
    for (std::size_t i = 0; i < 2 * length; i += 2) {
        const V re = v[i] * kernel[i] - v[i + 1] * kernel[i + 1];
        const V im = v[i] * kernel[i + 1] + v[i + 1] * kernel[i];
        v[i] = im;
        v[i + 1] = re;
    }
    chirp_->plan(v, u);
    for (std::size_t i = 0; i < 2 * n_; i += 2) {
        const V re = u[i + 1], im = u[i];
        a[i] = re * turn[i] - im * turn[i + 1];
        a[i + 1] = re * turn[i + 1] + im * turn[i];
    }
    return a;
}

template <class T, class V>
RealFftPlan<T, V>::RealFftPlan(std::size_t n)
    : n_(n), plan_(n % 2 == 0 ? n / 2 : n), a_(n % 2 == 0 ? n + 2 : 2 * n), b_(a_.size()) {
    if (n % 2 != 0) return;
    for (std::size_t k = 0; k <= n / 4; ++k) {
        const std::complex<T> w = root_of_unity<T>(k, n);
        turns_.push_back(w.real());
        turns_.push_back(w.imag());
    }
}

template <class T, class V>
const V* RealFftPlan<T, V>::forward() noexcept {
    V* a = a_.data();
    if (n_ % 2 != 0) {
        for (std::size_t i = n_; i-- > 0;) {
            a[2 * i] = a[i];
            a[2 * i + 1] = V{};
        }
        return plan_(a, b_.data());
    }
    V* z = plan_(a, b_.data());
    Kernels<T, V>::separate(z, n_ / 2, turns_.data());
    return z;
}

template <class T, class V>
const V* RealFftPlan<T, V>::inverse(const V* spectrum) noexcept {
    // The forward plan with re and im swapped is the inverse.
    V *a = a_.data(), *b = b_.data();
    if (n_ % 2 != 0) {
        a[1] = spectrum[0];
        a[0] = V{};
        for (std::size_t k = 1; k <= n_ / 2; ++k) {
            a[2 * k + 1] = a[2 * (n_ - k) + 1] = spectrum[2 * k];
            a[2 * k] = spectrum[2 * k + 1];
            a[2 * (n_ - k)] = -spectrum[2 * k + 1];
        }
        V* x = plan_(a, b);
        for (std::size_t i = 0; i < n_; ++i) x[i] = x[2 * i + 1];
        return x;
    }
    const std::size_t last = n_ / 2;
    const T half = T{0.5};
    a[1] = (spectrum[0] + spectrum[2 * last]) * half;
    a[0] = (spectrum[0] - spectrum[2 * last]) * half;
    for (std::size_t k = 1; 2 * k <= last; ++k) {
        const V *low = spectrum + 2 * k, *high = spectrum + 2 * (last - k);
        const V even_re = (low[0] + high[0]) * half, even_im = (low[1] - high[1]) * half;
        const V turned_re = (low[0] - high[0]) * half, turned_im = (low[1] + high[1]) * half;
        const T c = turns_[2 * k], s = turns_[2 * k + 1];
        const V odd_re = turned_re * c + turned_im * s, odd_im = turned_im * c - turned_re * s;
        a[2 * (last - k) + 1] = even_re + odd_im;
        a[2 * (last - k)] = odd_re - even_im;
        a[2 * k + 1] = even_re - odd_im;
        a[2 * k] = even_im + odd_re;
    }
    V* z = plan_(a, b);
    for (std::size_t i = 0; i < n_; i += 2) std::swap(z[i], z[i + 1]);
    return z;
}

template const LaneKernels<double>& lane_kernels() noexcept;
template const LaneKernels<float>& lane_kernels() noexcept;
template class FftPlan<double, double>;
template class FftPlan<float, float>;
template class FftPlan<double, Lanes<double>>;
template class FftPlan<float, Lanes<float>>;
template class RealFftPlan<double, double>;
template class RealFftPlan<float, float>;
template class RealFftPlan<double, Lanes<double>>;
template class RealFftPlan<float, Lanes<float>>;

}  // namespace detail

template <class T>
void Fft<T>::forward(std::span<const std::complex<T>> x, std::span<std::complex<T>> spectrum) noexcept {
    for (std::size_t i = 0; i < n_; ++i) a_[2 * i] = x[i].real(), a_[2 * i + 1] = x[i].imag();
    const T* out = plan_(a_.data(), b_.data());
    for (std::size_t i = 0; i < n_; ++i) spectrum[i] = {out[2 * i], out[2 * i + 1]};
}

template <class T>
void Fft<T>::inverse(std::span<const std::complex<T>> spectrum, std::span<std::complex<T>> x) noexcept {
    for (std::size_t i = 0; i < n_; ++i) a_[2 * i] = spectrum[i].imag(), a_[2 * i + 1] = spectrum[i].real();
    const T* out = plan_(a_.data(), b_.data());
    const T scale = T{1} / static_cast<T>(n_);
    for (std::size_t i = 0; i < n_; ++i) x[i] = {out[2 * i + 1] * scale, out[2 * i] * scale};
}

template <class T>
void RealFft<T>::forward(std::span<const T> x, std::span<std::complex<T>> spectrum) noexcept {
    std::copy_n(x.begin(), plan_.size(), plan_.input());
    const T* out = plan_.forward();
    for (std::size_t k = 0; k < bins(); ++k) spectrum[k] = {out[2 * k], out[2 * k + 1]};
}

template <class T>
void RealFft<T>::inverse(std::span<const std::complex<T>> spectrum, std::span<T> x) noexcept {
    const std::size_t n = plan_.size();
    const T* out = plan_.inverse(reinterpret_cast<const T*>(spectrum.data()));
    const T scale = T{1} / static_cast<T>(n % 2 == 0 ? n / 2 : n);
    for (std::size_t i = 0; i < n; ++i) x[i] = out[i] * scale;
}

template class Fft<double>;
template class Fft<float>;
template class RealFft<double>;
template class RealFft<float>;

}  // namespace tactus::signal
