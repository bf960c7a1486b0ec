// SPDX-License-Identifier: Apache-2.0
#include "dsp/spectrum/fft.hpp"

#include <algorithm>
#include <bit>
#include <numbers>

namespace tactus {

namespace {

/// exp(−2πi·k/n), rounded once.
template <class T>
std::complex<T> root_of_unity(std::size_t k, std::size_t n) {
    const long double angle =
        2.0L * std::numbers::pi_v<long double> * static_cast<long double>(k) / static_cast<long double>(n);
    return {static_cast<T>(std::cos(angle)), static_cast<T>(-std::sin(angle))};
}

constexpr std::size_t largest_radix = 31;

bool is_smooth(std::size_t n) {
    for (std::size_t p = 2; p <= largest_radix; ++p)
        while (n % p == 0) n /= p;
    return n == 1;
}

}  // namespace

namespace detail {

/// exp(−πik²/n), and the transform of its conjugate on the inner plan's length.
template <class T, class V>
struct FftPlan<T, V>::Chirp {
    std::size_t length;
    std::vector<T> turn, kernel;
};

template <class T, class V>
FftPlan<T, V>::FftPlan(std::size_t n) : n_(n) {
    if (is_smooth(n)) {
        std::size_t rest = n;
        for (; rest % 4 == 0; rest /= 4) add_stage(4, rest / 4);
        if (rest % 2 == 0) add_stage(2, rest / 2), rest /= 2;
        for (std::size_t p = 3; rest > 1; p += 2)
            for (; rest % p == 0; rest /= p) add_stage(p, rest / p);
        return;
    }
    const std::size_t length = std::bit_ceil(2 * n - 1);
    auto chirp = std::make_shared<Chirp>();
    chirp->length = length;
    FftPlan<T, T> plan(length);
    std::vector<T> a(2 * length), b(2 * length);
    for (std::size_t k = 0; k < n; ++k) {
        const std::complex<T> turn = root_of_unity<T>(k * k % (2 * n), 2 * n);
        chirp->turn.push_back(turn.real());
        chirp->turn.push_back(turn.imag());
        for (const std::size_t at : {k, (length - k) % length}) a[2 * at] = turn.real(), a[2 * at + 1] = -turn.imag();
    }
    const T* spectrum = plan(a.data(), b.data());
    // The inner transform back is scaled here.
    for (std::size_t i = 0; i < 2 * length; ++i) chirp->kernel.push_back(spectrum[i] / static_cast<T>(length));
    chirp_ = std::move(chirp);
    inner_ = std::make_shared<FftPlan>(length);
    work_.resize(4 * length);
}

template <class T, class V>
void FftPlan<T, V>::add_stage(std::size_t radix, std::size_t rest) {
    stages_.push_back({radix, rest, twiddles_.size(), roots_.size()});
    for (std::size_t k = 0; k < rest; ++k)
        for (std::size_t j = 1; j < radix; ++j) {
            const std::complex<T> w = root_of_unity<T>(j * k, radix * rest);
            twiddles_.push_back(w.real());
            twiddles_.push_back(w.imag());
        }
    if (radix % 2 == 0) return;
    for (std::size_t j = 0; j < radix; ++j) {
        const std::complex<T> w = root_of_unity<T>(j, radix);
        roots_.push_back(w.real());
        roots_.push_back(w.imag());
    }
}

template <class T, class V>
V* FftPlan<T, V>::operator()(V* a, V* b) noexcept {
    if (chirp_) return through_chirp(a);
    std::size_t stride = 1;
    for (const Stage& stage : stages_) {
        if (stage.radix == 4) radix4(a, b, stage, stride);
        else if (stage.radix == 2) radix2(a, b, stage, stride);
        else radix_odd(a, b, stage, stride);
        stride *= stage.radix;
        std::swap(a, b);
    }
    return a;
}

template <class T, class V>
void FftPlan<T, V>::radix2(const V* x, V* y, const Stage& stage, std::size_t stride) const noexcept {
    const T* w = twiddles_.data() + stage.first_factor;
    const std::size_t apart = 2 * stride * stage.rest;
    for (std::size_t k = 0; k < stage.rest; ++k, w += 2, y += 4 * stride)
        for (std::size_t q = 0; q < 2 * stride; q += 2, x += 2) {
            const V re = x[0] - x[apart], im = x[1] - x[apart + 1];
            y[q] = x[0] + x[apart];
            y[q + 1] = x[1] + x[apart + 1];
            y[q + 2 * stride] = re * w[0] - im * w[1];
            y[q + 2 * stride + 1] = re * w[1] + im * w[0];
        }
}

template <class T, class V>
void FftPlan<T, V>::radix4(const V* x, V* y, const Stage& stage, std::size_t stride) const noexcept {
    const T* w = twiddles_.data() + stage.first_factor;
    const std::size_t m = 2 * stride * stage.rest, s = 2 * stride;
    for (std::size_t k = 0; k < stage.rest; ++k, w += 6, y += 4 * s)
        for (std::size_t q = 0; q < s; q += 2, x += 2) {
            const V sum_re = x[0] + x[2 * m], sum_im = x[1] + x[2 * m + 1];
            const V diff_re = x[0] - x[2 * m], diff_im = x[1] - x[2 * m + 1];
            const V odd_re = x[m] + x[3 * m], odd_im = x[m + 1] + x[3 * m + 1];
            const V turn_re = x[m + 1] - x[3 * m + 1], turn_im = x[3 * m] - x[m];  // −i (x1 − x3)
            const V a_re = diff_re + turn_re, a_im = diff_im + turn_im;
            const V b_re = sum_re - odd_re, b_im = sum_im - odd_im;
            const V c_re = diff_re - turn_re, c_im = diff_im - turn_im;
            y[q] = sum_re + odd_re;
            y[q + 1] = sum_im + odd_im;
            y[q + s] = a_re * w[0] - a_im * w[1];
            y[q + s + 1] = a_re * w[1] + a_im * w[0];
            y[q + 2 * s] = b_re * w[2] - b_im * w[3];
            y[q + 2 * s + 1] = b_re * w[3] + b_im * w[2];
            y[q + 3 * s] = c_re * w[4] - c_im * w[5];
            y[q + 3 * s + 1] = c_re * w[5] + c_im * w[4];
        }
}

template <class T, class V>
void FftPlan<T, V>::radix_odd(const V* x, V* y, const Stage& stage, std::size_t stride) const noexcept {
    const std::size_t p = stage.radix, m = 2 * stride * stage.rest, s = 2 * stride;
    const T* w = twiddles_.data() + stage.first_factor;
    const T* root = roots_.data() + stage.first_root;
    V plus[largest_radix + 1], minus[largest_radix + 1];  // x_j ± x_{p−j}, both parts
    for (std::size_t k = 0; k < stage.rest; ++k, w += 2 * (p - 1), y += p * s)
        for (std::size_t q = 0; q < s; q += 2, x += 2) {
            V total_re = x[0], total_im = x[1];
            for (std::size_t j = 1; j <= p / 2; ++j) {
                const V *a = x + j * m, *b = x + (p - j) * m;
                total_re += plus[2 * j] = a[0] + b[0];
                total_im += plus[2 * j + 1] = a[1] + b[1];
                minus[2 * j] = a[0] - b[0];
                minus[2 * j + 1] = a[1] - b[1];
            }
            y[q] = total_re;
            y[q + 1] = total_im;
            for (std::size_t r = 1; r <= p / 2; ++r) {
                V even_re = x[0], even_im = x[1], odd_re = x[0] - x[0], odd_im = odd_re;
                for (std::size_t j = 1; j <= p / 2; ++j) {
                    const T* turn = root + 2 * (r * j % p);
                    even_re += plus[2 * j] * turn[0];
                    even_im += plus[2 * j + 1] * turn[0];
                    odd_re += minus[2 * j + 1] * turn[1];
                    odd_im += minus[2 * j] * turn[1];
                }
                const V first_re = even_re - odd_re, first_im = even_im + odd_im;
                const V last_re = even_re + odd_re, last_im = even_im - odd_im;
                const T *u = w + 2 * (r - 1), *v = w + 2 * (p - r - 1);
                y[q + r * s] = first_re * u[0] - first_im * u[1];
                y[q + r * s + 1] = first_re * u[1] + first_im * u[0];
                y[q + (p - r) * s] = last_re * v[0] - last_im * v[1];
                y[q + (p - r) * s + 1] = last_re * v[1] + last_im * v[0];
            }
        }
}

template <class T, class V>
V* FftPlan<T, V>::through_chirp(V* a) noexcept {
    const std::size_t length = chirp_->length;
    const T *turn = chirp_->turn.data(), *kernel = chirp_->kernel.data();
    V *u = work_.data(), *v = u + 2 * length;
    for (std::size_t i = 0; i < 2 * n_; i += 2) {
        u[i] = a[i] * turn[i] - a[i + 1] * turn[i + 1];
        u[i + 1] = a[i] * turn[i + 1] + a[i + 1] * turn[i];
    }
    std::fill(u + 2 * n_, u + 2 * length, V{});
    V* spectrum = (*inner_)(u, v);
    V* other = spectrum == u ? v : u;
    // Real and imaginary part change places: the transform that follows is then the inverse, in the same places.
    for (std::size_t i = 0; i < 2 * length; i += 2) {
        const V re = spectrum[i] * kernel[i] - spectrum[i + 1] * kernel[i + 1];
        const V im = spectrum[i] * kernel[i + 1] + spectrum[i + 1] * kernel[i];
        spectrum[i] = im;
        spectrum[i + 1] = re;
    }
    const V* back = (*inner_)(spectrum, other);
    for (std::size_t i = 0; i < 2 * n_; i += 2) {
        const V re = back[i + 1], im = back[i];
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
    // Even and odd samples were one complex series of half the length: take its transform apart.
    V* z = plan_(a, b_.data());
    const T half = T{0.5};
    const std::size_t last = n_ / 2;
    const V first_re = z[0], first_im = z[1];
    z[0] = first_re + first_im;
    z[1] = V{};
    z[2 * last] = first_re - first_im;
    z[2 * last + 1] = V{};
    for (std::size_t k = 1; 2 * k <= last; ++k) {
        V *low = z + 2 * k, *high = z + 2 * (last - k);
        const V even_re = (low[0] + high[0]) * half, even_im = (low[1] - high[1]) * half;
        const V odd_re = (low[1] + high[1]) * half, odd_im = (high[0] - low[0]) * half;
        const T c = turns_[2 * k], s = turns_[2 * k + 1];
        const V turned_re = odd_re * c - odd_im * s, turned_im = odd_re * s + odd_im * c;
        high[0] = even_re - turned_re;
        high[1] = turned_im - even_im;
        low[0] = even_re + turned_re;
        low[1] = even_im + turned_im;
    }
    return z;
}

template <class T, class V>
const V* RealFftPlan<T, V>::inverse(const V* spectrum) noexcept {
    // The forward plan with re and im exchanged is the inverse.
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

}  // namespace tactus
